// Ref: Khronos, "EXT_mesh_gpu_instancing".
#include "load/gltf/instances.h"

#include <cmath>
#include <optional>
#include <string_view>

#include "base/text.h"
#include "load/gltf/accessor.h"
#include "load/gltf/pose.h"
#include "load/gltf/values.h"

namespace candela::gltf {
namespace {

// The numbers of one attribute, and the number of copies.
struct InstanceAttribute {
    std::vector<float> numbers;
    uint32_t count = 0;
};

std::optional<InstanceAttribute> read_attribute(File& file, const Node& attributes, std::string_view key,
                                                std::string_view type) {
    const auto reference = attributes.find(key);
    if (!reference) return std::nullopt;
    const Accessor accessor(file, *reference, {type});
    return InstanceAttribute{accessor.floats(), accessor.count()};
}

dvec3 three(const std::vector<float>& numbers, size_t i) {
    return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

glm::dquat four(const std::vector<float>& numbers, size_t i) {
    const float* q = &numbers[4 * i];
    return {q[3], q[0], q[1], q[2]};
}

// Notes the first rotation that is not a unit quaternion.
void check_rotations(File& file, const Node& attributes, const InstanceAttribute& rotations) {
    for (size_t i = 0; i < rotations.count; ++i) {
        const double size = length(four(rotations.numbers, i));
        if (std::abs(size - 1.0) <= ROTATION_TOLERANCE) continue;
        file.warn(attributes.require("ROTATION"), concat("the rotation of instance ", i,
                                                         " is a quaternion whose length is not 1; all are "
                                                         "normalised, and length 0 means no rotation"));
        return;
    }
}

}  // namespace

std::vector<glm::dmat4> read_instances(File& file, const Node& node) {
    const auto extension = extension_of(node, "EXT_mesh_gpu_instancing");
    if (!extension) return {glm::dmat4(1.0)};
    const Node attributes = extension->require("attributes");
    const auto translation = read_attribute(file, attributes, "TRANSLATION", "VEC3");
    const auto rotation = read_attribute(file, attributes, "ROTATION", "VEC4");
    const auto scale = read_attribute(file, attributes, "SCALE", "VEC3");
    std::optional<uint32_t> count;
    for (const auto* attribute : {&translation, &rotation, &scale}) {
        if (!*attribute) continue;
        if (count && *count != (*attribute)->count) {
            attributes.fail(concat("the accessors have ", *count, " and ", (*attribute)->count,
                                   " elements; each must have one for each instance"));
        }
        count = (*attribute)->count;
    }
    if (!count) {
        file.warn(attributes, "there is none of TRANSLATION, ROTATION and SCALE; the mesh is shown once");
        return {glm::dmat4(1.0)};
    }
    if (rotation) check_rotations(file, attributes, *rotation);
    std::vector<glm::dmat4> placements;
    placements.reserve(*count);
    for (size_t i = 0; i < *count; ++i) {
        Trs trs;
        if (translation) trs.translation = three(translation->numbers, i);
        if (rotation) {
            const glm::dquat q = four(rotation->numbers, i);
            const double size = length(q);
            if (size > 0.0) trs.rotation = q / size;
        }
        if (scale) trs.scale = three(scale->numbers, i);
        placements.push_back(matrix_of(trs));
    }
    return placements;
}

}  // namespace candela::gltf
