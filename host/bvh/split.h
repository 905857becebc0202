// Splits a range of primitives in two: by the binned surface area heuristic, or at the median.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "bvh/box4.h"

namespace candela {

// The builder's data of a primitive: 32 bytes, which it moves until they are in leaf order.
struct alignas(16) PrimitiveRef {
    vec3 lo;
    uint32_t index;  // In the caller's order.
    vec3 hi;
    uint32_t unused = 0;

    // The fourth lanes are 0: as a float, an index would be denormal, and slow to compute with.
    Box4 box() const {
        constexpr Int4 XYZ{-1, -1, -1, 0};
        const auto halves = std::bit_cast<std::array<Int4, 2>>(*this);
        return {Float4(halves[0] & XYZ), Float4(halves[1] & XYZ)};
    }
    // The centroid, times 2; on all axes or on one.
    static Float4 centroid2(const Box4& box) { return box.lo + box.hi; }
    float centroid2(int axis) const { return lo[axis] + hi[axis]; }
};

// Primitives [first, first + count) of the array of references.
struct PrimitiveRange {
    uint32_t first = 0;
    uint32_t count = 0;
    Box4 bounds = Box4::empty();
    Box4 centroids2 = Box4::empty();  // Bounds of the centroids, times 2.

    void add(const PrimitiveRef& ref) {
        const Box4 box = ref.box();
        ++count;
        bounds.extend(box);
        centroids2.extend(PrimitiveRef::centroid2(box));
    }
};

using SplitRanges = std::array<PrimitiveRange, 2>;

// Reorders `range` (2 primitives or more) of `refs` and returns its two parts, neither empty: the cut between
// bins of centroids with the least A(left) * n(left) + A(right) * n(right), the more balanced one if several
// are equal. If no axis can be binned (equal centroids), split_median().
SplitRanges split_sah(std::span<PrimitiveRef> refs, const PrimitiveRange& range);

// The same, but in two halves by centroid along the longest axis of the centroids' bounds; equal centroids
// are ordered by index.
SplitRanges split_median(std::span<PrimitiveRef> refs, const PrimitiveRange& range);

}  // namespace candela
