// The matrices of transforms.
#include "scene/transform.h"

#include <algorithm>
#include <cmath>

namespace candela {
bool Transform::append(const glm::dmat4& step) {
    constexpr double FLAT = 1e-12;
    matrix_ = step * matrix_;
    const glm::dmat3 m(matrix_);
    cofactor_ = {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
    const double volume = dot(m[0], cofactor_[0]);
    mirrors_ = volume < 0.0;
    // Also false for NaN.
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
    // products off by at most 2 * 5e-7 * sqrt(3): |column|_1 <= sqrt(3) |column|. The errors of several in a
    // chain may add up.
    constexpr double UNEVEN = 1e-5;
    const glm::dmat3 m(matrix_);
    const glm::dmat3 products = transpose(m) * m;  // s^2 times the identity if the scale is uniform.
    const double square = (products[0][0] + products[1][1] + products[2][2]) / 3.0;
    for (glm::length_t i = 0; i < 3; ++i) {
        for (glm::length_t j = 0; j < 3; ++j) {
            const double expected = i == j ? square : 0.0;
            if (!(std::abs(products[i][j] - expected) <= UNEVEN * square)) return std::nullopt;
        }
    }
    return std::sqrt(square);
}

double Transform::mean_scale() const {
    return uniform_scale().value_or(std::cbrt(std::abs(determinant(glm::dmat3(matrix_)))));
}

}  // namespace candela
