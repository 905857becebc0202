// The matrices of transforms, and their steps in a scene file.
#include "scene/transform.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>

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

bool Transform::append(const glm::dmat4& step) {
    constexpr double FLAT = 1e-12;
    matrix_ = step * matrix_;
    const glm::dmat3 m(matrix_);
    cofactor_ = {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
    const double volume = dot(m[0], cofactor_[0]);
    mirrors_ = volume < 0.0;
    // False for NaN as well.
    return std::abs(volume) > FLAT * length(m[0]) * length(m[1]) * length(m[2]) && std::isfinite(volume);
}

vec3 Transform::normal(vec3 n) const {
    const glm::dvec3 m = (mirrors_ ? -1.0 : 1.0) * (cofactor_ * glm::dvec3(n));
    if (m == glm::dvec3(0.0)) return vec3(0.0f);
    const glm::dvec3 size = abs(m);
    return vec3(
        normalize(m / std::max({size.x, size.y, size.z})));  // Divided first, so that no square overflows.
}

std::optional<double> Transform::uniform_scale() const {
    // A matrix whose numbers were written to six decimals of the largest, M + E with |E_ij| <= 5e-7, has
    // products off by at most 2 * 5e-7 * sqrt(3): |column|_1 <= sqrt(3) |column|. Some of them in a chain may
    // add up.
    constexpr double UNEVEN = 1e-5;
    const glm::dmat3 m(matrix_);
    const glm::dmat3 products = transpose(m) * m;  // s^2 times the identity if the transform is even.
    const double square = (products[0][0] + products[1][1] + products[2][2]) / 3.0;
    for (glm::length_t i = 0; i < 3; ++i) {
        for (glm::length_t j = 0; j < 3; ++j) {
            const double expected = i == j ? square : 0.0;
            if (!(std::abs(products[i][j] - expected) <= UNEVEN * square)) return std::nullopt;
        }
    }
    return std::sqrt(square);
}

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

}  // namespace candela
