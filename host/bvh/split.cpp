// See split.h. Ref: Wald 2007, On fast Construction of SAH-based Bounding Volume Hierarchies, section 3.
#include "bvh/split.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <tuple>

#include "bvh/measure.h"

namespace candela {

namespace {

// Few bins cannot cut a small detailed object out of a large room: 8 instead of 16 cost a ray a fifth more
// there, and 32 is as good as 16 or better. A small range gets fewer, since a bin costs as much as several
// primitives.
constexpr uint32_t MIN_BINS = 4;
constexpr uint32_t MAX_BINS = 32;

int bin_count(uint32_t primitives) {
    return int(std::min(MAX_BINS, MIN_BINS + primitives / 4));
}

struct Bin {
    Box bounds;
    uint32_t count = 0;
};

// Maps centroids to bins, on each axis linearly from the least to the greatest.
struct Binning {
    vec3 origin;
    vec3 scale;  // 0 on an axis that is too flat to be cut.
    int count;

    explicit Binning(const PrimitiveRange& range)
        : origin(range.centroids.lo), count(bin_count(range.count)) {
        const vec3 extent = range.centroids.extent();
        for (int a = 0; a < 3; ++a) {
            scale[a] = float(count) / extent[a];
            if (!std::isfinite(scale[a])) scale[a] = 0.0f;
        }
    }
    int bin(vec3 centroid, int axis) const {
        return std::min(int((centroid[axis] - origin[axis]) * scale[axis]), count - 1);
    }
};

struct Cut {
    int axis = -1;  // -1: none.
    int bin = 0;    // The first bin of the right part.
    double cost = 0.0;
    uint32_t imbalance = 0;

    bool operator<(const Cut& other) const {
        return std::tie(cost, imbalance) < std::tie(other.cost, other.imbalance);
    }
};

using Bins = std::array<std::array<Bin, MAX_BINS>, 3>;

Bins fill_bins(std::span<const PrimitiveRef> refs, const Binning& binning) {
    Bins bins;
    for (const PrimitiveRef& ref : refs) {
        const vec3 centroid = ref.centroid();
        for (int a = 0; a < 3; ++a) {
            Bin& bin = bins[a][binning.bin(centroid, a)];
            bin.bounds.extend(Box{ref.lo, ref.hi});
            ++bin.count;
        }
    }
    return bins;
}

Cut best_cut(const Bins& bins, const Binning& binning, uint32_t count) {
    Cut best;
    for (int a = 0; a < 3; ++a) {
        if (binning.scale[a] == 0.0f) continue;
        std::array<double, MAX_BINS> right_cost;
        Bin right;
        for (int i = binning.count - 1; i > 0; --i) {
            right.bounds.extend(bins[a][i].bounds);
            right.count += bins[a][i].count;
            right_cost[i] = half_area(right.bounds) * right.count;
        }
        Bin left;
        for (int i = 1; i < binning.count; ++i) {
            left.bounds.extend(bins[a][i - 1].bounds);
            left.count += bins[a][i - 1].count;
            if (left.count == count) break;
            const uint32_t right_count = count - left.count;
            const uint32_t imbalance = std::max(left.count, right_count) - std::min(left.count, right_count);
            const Cut cut{a, i, half_area(left.bounds) * left.count + right_cost[i], imbalance};
            if (best.axis < 0 || cut < best) best = cut;
        }
    }
    return best;
}

}  // namespace

SplitRanges split_sah(std::span<PrimitiveRef> refs, const PrimitiveRange& range) {
    assert(range.count >= 2);
    const Binning binning(range);
    const std::span<PrimitiveRef> part = refs.subspan(range.first, range.count);
    const Bins bins = fill_bins(part, binning);
    const Cut cut = best_cut(bins, binning, range.count);
    if (cut.axis < 0) return split_median(refs, range);

    SplitRanges sides;
    for (int i = 0; i < binning.count; ++i) {
        PrimitiveRange& side = sides[i >= cut.bin];
        side.bounds.extend(bins[cut.axis][i].bounds);
        side.count += bins[cut.axis][i].count;
    }
    // Without branches on the side, which would be mispredicted for half of all primitives.
    size_t left_end = 0;
    for (PrimitiveRef& place : part) {
        const PrimitiveRef ref = place;
        const vec3 centroid = ref.centroid();
        const bool right = binning.bin(centroid, cut.axis) >= cut.bin;
        sides[right].centroids.extend(centroid);
        place = part[left_end];
        part[left_end] = ref;
        left_end += !right;
    }
    sides[0].first = range.first;
    sides[1].first = range.first + sides[0].count;
    return sides;
}

SplitRanges split_median(std::span<PrimitiveRef> refs, const PrimitiveRange& range) {
    assert(range.count >= 2);
    const vec3 extent = range.centroids.extent();
    const int axis = extent.x >= std::max(extent.y, extent.z) ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::span<PrimitiveRef> part = refs.subspan(range.first, range.count);
    const uint32_t half = range.count / 2;
    const auto before = [axis](const PrimitiveRef& a, const PrimitiveRef& b) {
        return std::make_tuple(a.centroid()[axis], a.index) < std::make_tuple(b.centroid()[axis], b.index);
    };
    std::nth_element(part.begin(), part.begin() + half, part.end(), before);

    SplitRanges result;
    auto& [left, right] = result;
    left.first = range.first;
    right.first = range.first + half;
    for (const PrimitiveRef& ref : part.first(half))
        left.add(ref);
    for (const PrimitiveRef& ref : part.subspan(half))
        right.add(ref);
    return result;
}

}  // namespace candela
