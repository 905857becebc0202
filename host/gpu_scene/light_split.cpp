// See light_split.h.
#include "gpu_scene/light_split.h"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace candela {
namespace {

constexpr uint32_t MAX_BINS = 16;

// The bins on an axis, of centroids times 2.
struct Binning {
    float origin;
    float scale;  // 0: all centroids are equal, or too close for floats.
    uint32_t bins;

    Binning(const LightRange& range, int axis)
        : origin(range.centroids2.lo[axis]), bins(std::min(range.count, MAX_BINS)) {
        // A little less than the ratio, which would put the last centroid into a bin past the last one.
        const float extent = range.centroids2.extent()[axis];
        scale = float(bins) * 0.99999f / extent;
        if (!(extent > 0.0f) || scale > FLOAT_MAX) scale = 0.0f;
    }
    uint32_t bin(const LightRef& light, int axis) const {
        return std::min(uint32_t((light.centroid2(axis) - origin) * scale), bins - 1);
    }
};

void join(LightRange& range, const LightRange& other) {
    range.count += other.count;
    range.bounds.extend(other.bounds);
    range.centroids2.extend(other.centroids2);
    range.sums += other.sums;
}

struct Cut {
    float cost = INFINITE;
    uint32_t imbalance = UINT32_MAX;
    int axis = -1;     // -1 if there is none.
    uint32_t bin = 0;  // The first bin of the right part.
    std::array<LightRange, 2> sides{};
};

// Improves `best` by the cuts between the bins of an axis.
void find_cut(std::span<const LightRange> bins, int axis, Cut& best) {
    std::array<LightRange, MAX_BINS> right;
    right[bins.size() - 1] = bins.back();
    for (size_t i = bins.size() - 1; i-- > 1;) {
        right[i] = right[i + 1];
        join(right[i], bins[i]);
    }
    LightRange left = bins.front();
    for (uint32_t i = 1; i < bins.size(); ++i) {
        const float cost = light_cost(left) + light_cost(right[i]);
        const uint32_t imbalance = std::max(left.count, right[i].count);
        if (std::tie(cost, imbalance) < std::tie(best.cost, best.imbalance))
            best = {cost, imbalance, axis, i, {left, right[i]}};
        join(left, bins[i]);
    }
}

}  // namespace

void LightRange::add(const LightRef& light) {
    const Box4 box{{light.lo.x, light.lo.y, light.lo.z, 0.0f}, {light.hi.x, light.hi.y, light.hi.z, 0.0f}};
    ++count;
    bounds.extend(box);
    centroids2.extend(box.lo + box.hi);
    sums += Float4{light.axis.x, light.axis.y, light.axis.z, light.strength};
}

float light_cost(const LightRange& range) {
    const Float4 extent = range.bounds.extent();
    const float diameter2 = extent[0] * extent[0] + extent[1] * extent[1] + extent[2] * extent[2];
    // Directions that are evenly spread over a cap of a sphere have the mean length (1 + cos(a)) / 2, for a
    // cap of the angle a. The reference's measure of directions for such normals, in multiples of that for a
    // single one, is this polynomial in h = 1 - cos(a), exactly for h = 0, 1 and 2 (where it has 2 + pi / 2
    // and 4), without a sine.
    const Float4 sums = range.sums;
    const float length2 = sums[0] * sums[0] + sums[1] * sums[1] + sums[2] * sums[2];
    const float h = std::max(0.0f, 2.0f - 2.0f * std::sqrt(length2) / float(range.count));
    return sums[3] * diameter2 * (1.0f + h * (3.642f - 1.071f * h));
}

std::array<LightRange, 2> split_lights(std::span<LightRef> lights, const LightRange& range) {
    assert(range.count >= 2);
    const std::span<LightRef> part = lights.subspan(range.first, range.count);
    const std::array<Binning, 3> binnings{Binning(range, 0), Binning(range, 1), Binning(range, 2)};
    std::array<std::array<LightRange, MAX_BINS>, 3> bins;
    for (const LightRef& light : part) {
        for (int axis = 0; axis < 3; ++axis) {
            if (binnings[axis].scale > 0.0f) bins[axis][binnings[axis].bin(light, axis)].add(light);
        }
    }
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
        if (binnings[axis].scale > 0.0f)
            find_cut(std::span(bins[axis]).first(binnings[axis].bins), axis, best);
    }
    if (best.axis < 0 || best.sides[0].count == 0 || best.sides[1].count == 0)
        return split_lights_at_median(lights, range);
    std::partition(part.begin(), part.end(), [&](const LightRef& light) {
        return binnings[best.axis].bin(light, best.axis) < best.bin;
    });
    best.sides[0].first = range.first;
    best.sides[1].first = range.first + best.sides[0].count;
    return best.sides;
}

std::array<LightRange, 2> split_lights_at_median(std::span<LightRef> lights, const LightRange& range) {
    assert(range.count >= 2);
    const Float4 extent = range.centroids2.extent();
    const int axis = extent[0] >= std::max(extent[1], extent[2]) ? 0 : extent[1] >= extent[2] ? 1 : 2;
    const std::span<LightRef> part = lights.subspan(range.first, range.count);
    const uint32_t half = range.count / 2;
    std::ranges::nth_element(part, part.begin() + half, {}, [axis](const LightRef& light) {
        return std::pair(light.centroid2(axis), light.index);
    });
    std::array<LightRange, 2> sides;
    sides[0].first = range.first;
    sides[1].first = range.first + half;
    for (uint32_t i = 0; i < range.count; ++i)
        sides[i >= half].add(part[i]);
    return sides;
}

}  // namespace candela
