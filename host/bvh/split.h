// Splits a range of primitives in two: by the binned surface area heuristic, or at the median.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/math.h"

namespace candela {

// What the builder keeps of a primitive: 32 bytes, moved about until they stand in leaf order.
struct PrimitiveRef {
    vec3 lo;
    uint32_t index;  // In the caller's order.
    vec3 hi;
    uint32_t unused = 0;

    vec3 centroid() const { return 0.5f * lo + 0.5f * hi; }
};

// Primitives [first, first + count) of the array of references.
struct PrimitiveRange {
    uint32_t first = 0;
    uint32_t count = 0;
    Box bounds;
    Box centroids;  // Bounds of the centroids.

    void add(const PrimitiveRef& ref) {
        ++count;
        bounds.extend(Box{ref.lo, ref.hi});
        centroids.extend(ref.centroid());
    }
};

using SplitRanges = std::array<PrimitiveRange, 2>;

// Reorders `range` (2 primitives or more) of `refs` and returns its two parts, neither empty: the cut between
// bins of centroids with the least A(left) * n(left) + A(right) * n(right), the more balanced one where
// several are equal; where no axis can be binned (equal centroids), split_median().
SplitRanges split_sah(std::span<PrimitiveRef> refs, const PrimitiveRange& range);

// The same, but in two halves by centroid along the longest axis of `range.centroids`, equal ones by index.
SplitRanges split_median(std::span<PrimitiveRef> refs, const PrimitiveRange& range);

}  // namespace candela
