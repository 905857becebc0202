// Splits a range of lights in two, by what it costs a choice to tell the parts apart from afar only.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bvh/box4.h"

namespace candela {

// What the builder of the tree keeps of a light, and moves until it is in the order of the tree.
struct alignas(16) LightRef {
    vec3 lo;
    uint32_t index;  // In the caller's order.
    vec3 hi;
    uint32_t two_sided;
    vec3 axis;       // 0 if its normals are all around.
    float strength;  // Of all lights together, which is 1; > 0.
    float normals;   // Angles of its cone [rad].
    float emission;

    float centroid2(int axis_number) const { return lo[axis_number] + hi[axis_number]; }
};

// Lights [first, first + count) of the array of references.
struct LightRange {
    uint32_t first = 0;
    uint32_t count = 0;
    Box4 bounds = Box4::empty();
    Box4 centroids2 = Box4::empty();  // Bounds of the centroids, times 2.
    Float4 sums{};                    // Of axes; in the fourth lane, of strengths.

    void add(const LightRef& light);
};

// How much the lights of a range differ as seen from a point: their strength, times the square of the
// diameter of the box, times the directions into which they emit.
float light_cost(const LightRange& range);

// Reorders `range` (2 lights or more) of `lights` and returns its two parts, neither empty: the cut between
// bins of centroids with the least sum of costs, the more balanced one where several are equal; at the median
// where no axis can be binned (equal centroids).
std::array<LightRange, 2> split_lights(std::span<LightRef> lights, const LightRange& range);

// The same, but in two halves by centroid along the longest axis; equal centroids are ordered by index.
std::array<LightRange, 2> split_lights_at_median(std::span<LightRef> lights, const LightRange& range);

}  // namespace candela
