// Ref: Vogel 1979, A better way to construct the sunflower head.
#include "load/gltf/far_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace candela::gltf {

// Directions after the first six have a nearest neighbour within 22 degrees, so that none is farther than
// about 11 degrees from one of them: a point beyond the hull exceeds it by 1 - cos(11 degrees) of a radius.
template <size_t N>
static std::array<dvec3, N> even_directions() {
    std::array<dvec3, N> all{dvec3(1, 0, 0),  dvec3(-1, 0, 0), dvec3(0, 1, 0),
                             dvec3(0, -1, 0), dvec3(0, 0, 1),  dvec3(0, 0, -1)};
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (size_t i = 6; i < N; ++i) {
        const double y = 1.0 - (2.0 * double(i - 6) + 1.0) / double(N - 6), r = std::sqrt(1.0 - y * y);
        all[i] = {r * std::sin(golden_angle * double(i)), y, r * std::cos(golden_angle * double(i))};
    }
    return all;
}

void FarPoints::add(dvec3 p) {
    static const auto directions = even_directions<DIRECTIONS>();
    for (size_t i = 0; i < DIRECTIONS; ++i) {
        const double reached = dot(directions[i], p);
        if (!(reached > reached_[i])) continue;
        reached_[i] = reached;
        points_[i] = p;
    }
}

std::vector<dvec3> FarPoints::points() const {
    std::vector<dvec3> points;
    for (size_t i = 0; i < DIRECTIONS; ++i) {
        const bool is_there = reached_[i] > -double(INFINITE);
        if (is_there && std::ranges::find(points, points_[i]) == points.end()) points.push_back(points_[i]);
    }
    return points;
}

}  // namespace candela::gltf
