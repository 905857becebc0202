// Air along a ray to space, as an integral over height: a second opinion on host/scene/atmosphere.cpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace candela {

inline constexpr double EARTH = 6371.0, EYE = 0.1;  // Radius, and height of the eye above it [km].

// The column of molecules, aerosol and ozone above the eye, relative to that above the sea, straight up, at
// an elevation above 0 [degrees]: the integral of density * r dr / sqrt(r^2 - (r0 cos e)^2), with r^2 - (r0
// cos e)^2 as the square of the variable.
inline dvec3 slant_column(double elevation) {
    const double eye = EARTH + EYE, top = EARTH + 100.0;
    const double nearest = eye * std::cos(glm::radians(elevation));
    const double from = std::sqrt(eye * eye - nearest * nearest),
                 to = std::sqrt(top * top - nearest * nearest);
    constexpr int STEPS = 4000;
    dvec3 sum(0.0);
    for (int i = 0; i < STEPS; ++i) {
        const double x = from + (to - from) * (i + 0.5) / STEPS, h = std::hypot(x, nearest) - EARTH;
        sum += dvec3(std::exp(-h / 8.0) / 8.0, std::exp(-h / 1.2) / 1.2,
                     std::max(0.0, 1.0 - std::abs(h - 25.0) / 15.0) / 15.0);
    }
    return (to - from) / STEPS * sum;
}

}  // namespace candela
