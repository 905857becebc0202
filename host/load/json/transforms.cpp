// The steps of transforms in a scene file.
#include "load/json/transforms.h"

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "load/json/arrays.h"

namespace candela {
namespace {

glm::dvec3 read_scale(const Node& node) {
    return node.is_number() ? glm::dvec3(node.number()) : node.vector();
}

glm::dmat4 read_rotation(const Node& degrees, const Node& axis) {
    const glm::dvec3 direction = axis.vector();
    if (direction == glm::dvec3(0.0)) axis.fail_expected("a direction, not zero");
    return glm::rotate(glm::dmat4(1.0), glm::radians(degrees.number()), normalize(direction));
}

glm::dmat4 read_matrix(const Node& node) {
    const std::vector<Node> elements = node.elements();
    if (elements.size() != 16) node.fail_expected("16 numbers, row by row");
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i)
        matrix[i % 4][i / 4] = elements[size_t(i)].number();
    if (glm::row(matrix, 3) != glm::dvec4(0, 0, 0, 1)) {
        elements[12].fail("the last row of a matrix must be 0, 0, 0, 1: the transform must be affine");
    }
    return matrix;
}

glm::dmat4 read_step(const Node& step) {
    step.allow_only({"scale", "rotate", "axis", "translate", "matrix"});
    const auto rotate = step.find("rotate");
    if (step.members().size() == (rotate ? 2 : 1)) {
        if (rotate) return read_rotation(*rotate, step.require("axis"));
        if (const auto scale = step.find("scale")) return glm::scale(glm::dmat4(1.0), read_scale(*scale));
        if (const auto offset = step.find("translate"))
            return glm::translate(glm::dmat4(1.0), offset->vector());
        if (const auto matrix = step.find("matrix")) return read_matrix(*matrix);
    }
    step.fail(
        "a step of a transform has exactly one of the keys scale, rotate (with axis), translate and matrix");
}

}  // namespace

Transform read_transform(const Node& steps) {
    Transform transform;
    for (const Node& step : steps.elements()) {
        if (!transform.append(read_step(step))) {
            step.fail(
                "the transform is singular: up to this step it flattens the shape; use factors other than 0");
        }
    }
    return transform;
}

std::vector<Transform> read_transforms(const Node& node, const Scene& scene) {
    constexpr uint64_t NUMBERS = 16;
    const ArrayRows rows(node, scene, {NUMBERS});
    std::vector<Transform> transforms;
    rows.for_each([&](uint64_t row, const double* numbers) {
        glm::dmat4 matrix;
        for (int i = 0; i < int(NUMBERS); ++i)
            matrix[i % 4][i / 4] = numbers[i];
        if (glm::row(matrix, 3) != glm::dvec4(0, 0, 0, 1))
            rows.fail(row, "an affine matrix, whose last row is 0, 0, 0, 1", numbers[NUMBERS - 1]);
        if (!transforms.emplace_back().append(matrix))
            rows.fail(row, "a matrix that does not flatten the object", numbers[0]);
    });
    return transforms;
}

}  // namespace candela
