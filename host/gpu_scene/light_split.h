// Splits a range of lights in two, so that the lights of each part look alike from afar.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bvh/box4.h"

namespace candela {

// A light as the builder of the tree sorts it.
struct alignas(16) LightRef {
    vec3 lo;
    uint32_t index;  // In the caller's order.
    vec3 hi;
    uint32_t two_sided;
    vec3 axis;       // 0 if it has normals in all directions.
    float strength;  // Its fraction of the sum over all lights; > 0.
    float normals;   // As in LightBounds [rad].
    float emission;

    float centroid2(int axis_number) const { return lo[axis_number] + hi[axis_number]; }
};

// Lights [first, first + count) of the array of references.
struct LightRange {
    uint32_t first = 0;
    uint32_t count = 0;
    Box4 bounds = Box4::empty();
    Box4 centroids2 = Box4::empty();  // Bounds of the centroids, times 2.
    Float4 sums{};                    // Of the axes, and in the fourth lane, of the strengths.

    void add(const LightRef& light);
};

// How much the lights of a range differ as seen from a point: their strength, times the squared diameter of
// their box, times a measure of the directions into which they emit.
float light_cost(const LightRange& range);

// Reorders `range` (2 lights or more) of `lights` and returns its two parts, neither empty: the cut between
// bins of centroids with the least sum of costs, the more balanced one where several are equal; at the median
// where no axis can be binned (equal centroids).
std::array<LightRange, 2> split_lights(std::span<LightRef> lights, const LightRange& range);

// The same, but in two halves by centroid along the longest axis; equal centroids are ordered by index.
std::array<LightRange, 2> split_lights_at_median(std::span<LightRef> lights, const LightRange& range);

}  // namespace candela
