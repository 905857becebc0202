// Ref: Khronos, "glTF 2.0 Specification", section 3.7.3.
#include "load/gltf/skin.h"

#include <optional>

#include "base/text.h"
#include "load/gltf/accessor.h"

namespace candela::gltf {

std::vector<glm::dmat4> joint_matrices(File& file, const Node& skin, const std::vector<PosedNode>& nodes) {
    const Node joints = skin.require("joints");
    if (joints.size() == 0) joints.fail("a skin needs at least one joint; export it again");
    std::vector<glm::dmat4> matrices;
    matrices.reserve(joints.size());
    for (const Node& joint : joints.elements())
        matrices.push_back(nodes[file.index("nodes", joint)].world);
    const auto reference = skin.find("inverseBindMatrices");
    if (!reference) return matrices;
    const Accessor accessor(file, *reference, {"MAT4"});
    if (accessor.component() != Component::float32) reference->fail("these matrices must be floats");
    if (accessor.count() < matrices.size()) {
        reference->fail(concat("there are ", accessor.count(), " matrices for ", matrices.size(), " joints"));
    }
    const std::vector<float> numbers = accessor.floats();
    std::optional<size_t> first_odd;
    for (size_t i = 0; i < matrices.size(); ++i) {
        glm::dmat4 inverse_bind;
        for (int k = 0; k < 16; ++k)
            inverse_bind[k / 4][k % 4] = double(numbers[16 * i + size_t(k)]);
        if (!make_affine(inverse_bind) && !first_odd) first_odd = i;
        matrices[i] = matrices[i] * inverse_bind;
    }
    if (first_odd) {
        file.warn(*reference, concat("matrix ", *first_odd,
                                     " is not affine; the last row of each is read as 0, 0, 0, 1"));
    }
    return matrices;
}

}  // namespace candela::gltf
