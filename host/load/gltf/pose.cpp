// Ref: Khronos, "glTF 2.0 Specification", section 3.5.
#include "load/gltf/pose.h"

#include <cmath>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "base/text.h"

namespace candela::gltf {

glm::dmat4 matrix_of(const Trs& trs) {
    glm::dmat4 m = glm::mat4_cast(trs.rotation);
    for (glm::length_t i = 0; i < 3; ++i)
        m[i] *= trs.scale[i];
    m[3] = glm::dvec4(trs.translation, 1.0);
    return m;
}

bool make_affine(glm::dmat4& matrix) {
    constexpr double ROUNDING = 1e-6;  // Rounding of numbers that were floats.
    bool was_affine = true;
    for (glm::length_t column = 0; column < 4; ++column) {
        const double right = column == 3 ? 1.0 : 0.0;
        was_affine = was_affine && std::abs(matrix[column].w - right) <= ROUNDING;
        matrix[column].w = right;
    }
    return was_affine;
}

namespace {

glm::dmat4 read_node_matrix(File& file, const Node& node) {
    const std::vector<double> numbers = node.numbers(16);  // Column by column.
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i)
        matrix[i / 4][i % 4] = numbers[size_t(i)];
    if (!make_affine(matrix)) file.warn(node, "the matrix is not affine; its last row is read as 0, 0, 0, 1");
    return matrix;
}

glm::dquat read_rotation_of(File& file, const Node& node) {
    const std::vector<double> q = node.numbers(4);
    const glm::dquat rotation(q[3], q[0], q[1], q[2]);
    const double size = length(rotation);
    if (!(size > 0.0)) {
        file.warn(node, "the rotation is a quaternion of length 0, and is ignored");
        return {1, 0, 0, 0};
    }
    if (std::abs(size - 1.0) > ROTATION_TOLERANCE) {
        file.warn(node, concat("the rotation is a quaternion of length ", number_text(size, 6),
                               ", not 1; it is normalised"));
    }
    return rotation / size;
}

void read_placement(File& file, const Node& node, PosedNode& posed) {
    const auto translation = node.find("translation");
    const auto rotation = node.find("rotation");
    const auto scale = node.find("scale");
    if (const auto matrix = node.find("matrix")) {
        posed.matrix = read_node_matrix(file, *matrix);
        if (translation || rotation || scale)
            file.warn(node, "the node has a matrix; its translation, rotation and scale are ignored");
        return;
    }
    if (translation) posed.trs.translation = translation->vector();
    if (rotation) posed.trs.rotation = read_rotation_of(file, *rotation);
    if (scale) posed.trs.scale = scale->vector();
}

}  // namespace

std::vector<PosedNode> read_nodes(File& file) {
    std::vector<PosedNode> nodes(file.count("nodes"));
    for (size_t i = 0; i < nodes.size(); ++i) {
        const Node node = file.element("nodes", i);
        read_placement(file, node, nodes[i]);
        if (const auto weights = node.find("weights")) nodes[i].weights = weights->numbers(weights->size());
        if (const auto extensions = node.find("extensions")) {
            const auto visibility = extensions->find("KHR_node_visibility");
            const auto visible = visibility ? visibility->find("visible") : std::nullopt;
            if (visible) nodes[i].is_visible = visible->boolean();
        }
        const auto children = node.find("children");
        if (!children) continue;
        for (const Node& reference : children->elements())
            nodes[i].children.push_back(file.index("nodes", reference));
    }
    return nodes;
}

}  // namespace candela::gltf
