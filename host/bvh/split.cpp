// See split.h. Ref: Wald 2007, On fast Construction of SAH-based Bounding Volume Hierarchies, section 3.
#include "bvh/split.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <tuple>

namespace candela {

namespace {

// Few bins cannot cut a small detailed object out of a large room: with 32 instead of 128, rays there cost a
// tenth more, and with 8 far more; the build is as fast. A small range gets fewer bins, since a bin costs as
// much as several primitives; with a bin for every 4 primitives, trees are 0.1 % better and builds 3 %
// slower.
constexpr uint32_t MIN_BINS = 4;
constexpr uint32_t MAX_BINS = 128;
constexpr uint32_t PRIMITIVES_PER_BIN = 8;  // Above MIN_BINS.

constexpr float MAX_FLOAT = std::numeric_limits<float>::max();

int bin_count(uint32_t primitives) {
    return int(std::min(MAX_BINS, MIN_BINS + primitives / PRIMITIVES_PER_BIN));
}

// Maps centroids to bins, on each axis linearly from the least to the greatest.
struct Binning {
    Float4 origin;
    Float4 scale;  // 0 on an axis that is too flat to be cut.
    int count;

    explicit Binning(const PrimitiveRange& range)
        : origin(range.centroids2.lo), count(bin_count(range.count)) {
        scale = all4(float(count)) / range.centroids2.extent();
        scale = scale <= MAX_FLOAT ? scale : all4(0.0f);
    }
    // The bin on each axis. On an axis that can be cut, the first bin and the last always get a primitive.
    Int4 bins(Float4 centroid2) const {
        return __builtin_convertvector(min4((centroid2 - origin) * scale, all4(float(count - 1))), Int4);
    }
};

// The contents of the bins of each axis; elements from Binning::count on are not set.
struct Bins {
    std::array<std::array<Box4, 3>, MAX_BINS> bounds;
    std::array<Int4, MAX_BINS> counts;
};

void fill_bins(std::span<const PrimitiveRef> refs, const Binning& binning, Bins& bins) {
    std::fill_n(bins.bounds.begin(), binning.count, std::array{Box4::empty(), Box4::empty(), Box4::empty()});
    std::fill_n(bins.counts.begin(), binning.count, Int4{});
    for (const PrimitiveRef& ref : refs) {
        const Box4 box = ref.box();
        const Int4 bin = binning.bins(PrimitiveRef::centroid2(box));
        for (int a = 0; a < 3; ++a) {
            bins.bounds[bin[a]][a].extend(box);
            ++bins.counts[bin[a]][a];
        }
    }
}

// The union of neighbouring bins, on the three axes at once: one axis per lane.
struct BinUnion {
    std::array<Box4, 3> bounds{Box4::empty(), Box4::empty(), Box4::empty()};
    Float4 count{};

    void add(const Bins& bins, int i) {
        for (int a = 0; a < 3; ++a)
            bounds[a].extend(bins.bounds[i][a]);
        count += __builtin_convertvector(bins.counts[i], Float4);
    }
    // Half the surface area in units of 1 / `unit`^2, times the number of primitives. The unit keeps the
    // products of the largest and the smallest extents within the range of floats.
    Float4 cost(float unit) const {
        const Float4 a = bounds[0].extent() * unit, b = bounds[1].extent() * unit,
                     c = bounds[2].extent() * unit;
        const Float4 x{a[0], b[0], c[0], 0.0f}, y{a[1], b[1], c[1], 0.0f}, z{a[2], b[2], c[2], 0.0f};
        return (x * y + y * z + z * x) * count;
    }
};

struct Cut {
    int axis = -1;  // -1: none.
    int bin = 0;    // The first bin of the right part.
};

Cut best_cut(const Bins& bins, const Binning& binning, const PrimitiveRange& range) {
    const float unit = std::min(1.0f / range.bounds.longest_side(), MAX_FLOAT);
    std::array<Float4, MAX_BINS> right_cost;
    BinUnion right;
    for (int i = binning.count - 1; i > 0; --i) {
        right.add(bins, i);
        right_cost[i] = right.cost(unit);
    }
    // The best cut on each axis.
    Float4 min_cost = all4(INFINITE), min_imbalance = all4(INFINITE);
    Int4 best_bin{};
    BinUnion left;
    for (int i = 1; i < binning.count; ++i) {
        left.add(bins, i - 1);
        const Float4 cost = left.cost(unit) + right_cost[i];
        const Float4 excess = left.count + left.count - float(range.count);
        const Float4 imbalance = max4(excess, -excess);
        const Int4 better = (cost < min_cost) | ((cost == min_cost) & (imbalance < min_imbalance));
        min_cost = better ? cost : min_cost;
        min_imbalance = better ? imbalance : min_imbalance;
        best_bin = better ? Int4{i, i, i, i} : best_bin;
    }
    Cut best;
    for (int a = 0; a < 3; ++a) {
        if (binning.scale[a] == 0.0f) continue;
        const auto rank = [&](int axis) { return std::array<float, 2>{min_cost[axis], min_imbalance[axis]}; };
        if (best.axis < 0 || rank(a) < rank(best.axis)) best = {a, best_bin[a]};
    }
    return best;
}

}  // namespace

SplitRanges split_sah(std::span<PrimitiveRef> refs, const PrimitiveRange& range) {
    assert(range.count >= 2);
    const Binning binning(range);
    const std::span<PrimitiveRef> part = refs.subspan(range.first, range.count);
    Bins bins;
    fill_bins(part, binning, bins);
    const Cut cut = best_cut(bins, binning, range);
    if (cut.axis < 0) return split_median(refs, range);

    SplitRanges sides;
    for (int i = 0; i < binning.count; ++i) {
        PrimitiveRange& side = sides[i >= cut.bin];
        side.bounds.extend(bins.bounds[i][cut.axis]);
        side.count += uint32_t(bins.counts[i][cut.axis]);
    }
    // There is no branch on the side, which would be mispredicted for half of all primitives. A primitive is
    // in the first bin of the right part or a later one exactly if it is not before that bin's start, since
    // binning only rounds down.
    const float origin = binning.origin[cut.axis];
    const float scale = binning.scale[cut.axis];
    size_t left_end = 0;
    for (PrimitiveRef& place : part) {
        const PrimitiveRef ref = place;
        const bool right = (ref.centroid2(cut.axis) - origin) * scale >= float(cut.bin);
        sides[right].centroids2.extend(PrimitiveRef::centroid2(ref.box()));
        place = part[left_end];
        part[left_end] = ref;
        left_end += !right;
    }
    assert(left_end == sides[0].count);
    sides[0].first = range.first;
    sides[1].first = range.first + sides[0].count;
    return sides;
}

SplitRanges split_median(std::span<PrimitiveRef> refs, const PrimitiveRange& range) {
    assert(range.count >= 2);
    const Float4 extent = range.centroids2.extent();
    const int axis = extent[0] >= std::max(extent[1], extent[2]) ? 0 : extent[1] >= extent[2] ? 1 : 2;
    const std::span<PrimitiveRef> part = refs.subspan(range.first, range.count);
    const uint32_t half = range.count / 2;
    const auto before = [axis](const PrimitiveRef& a, const PrimitiveRef& b) {
        return std::make_tuple(a.centroid2(axis), a.index) < std::make_tuple(b.centroid2(axis), b.index);
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
