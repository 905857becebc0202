// Vector types under the names that the shaders use, and the axis-aligned box. Nothing here knows of
// rendering.
#pragma once

#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

namespace candela {

using glm::dvec3;
using glm::dvec4;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float PI = 3.14159265358979f;
inline constexpr float INFINITE = std::numeric_limits<float>::infinity();
inline constexpr float FLOAT_MAX = std::numeric_limits<float>::max();  // The greatest finite float.
inline constexpr float FLOAT_MIN = std::numeric_limits<float>::min();  // The least normal float.
// No shape reaches further along an axis, so that boxes can be added, subtracted and scaled as floats.
inline constexpr float MAX_COORDINATE = 1e37f;

// True if no component is NaN or infinite.
inline bool is_finite(vec3 v) {
    return !glm::any(glm::isnan(v)) && !glm::any(glm::isinf(v));
}

// Axis-aligned box [lo, hi], metres. A fresh one is empty: lo = +infinity, hi = -infinity.
template <class Vec>
struct BoxOf {
    using Number = typename Vec::value_type;

    Vec lo{std::numeric_limits<Number>::infinity()};
    Vec hi{-std::numeric_limits<Number>::infinity()};

    void extend(Vec p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    void extend(const BoxOf& box) {
        lo = glm::min(lo, box.lo);
        hi = glm::max(hi, box.hi);
    }
    bool is_empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
    Vec extent() const { return hi - lo; }
    Vec centroid() const { return Number(0.5) * lo + Number(0.5) * hi; }
    // Half the surface area [m^2]; 0 for an empty box.
    Number half_area() const {
        if (is_empty()) return Number(0);
        const Vec d = extent();
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
};
using Box = BoxOf<vec3>;
using DoubleBox = BoxOf<glm::dvec3>;

}  // namespace candela
