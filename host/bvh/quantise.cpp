// See quantise.h.
#include "bvh/quantise.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace candela {

namespace {

constexpr uint32_t LAST_STEP = 255;
constexpr int MIN_EXPONENT = -126;  // Least exponent of a normal float: devices may flush smaller ones to
                                    // zero.

// One axis of the grid. Estimates are made in double precision; decode() is the device's arithmetic and
// decides. It rounds once, and rounding is monotonic, so step 0 decodes to `origin` itself and no step to
// less than an earlier one.
struct GridAxis {
    float origin;
    float scale;

    float decode(uint32_t q) const { return origin + float(q) * scale; }

    // The finest grid from `lo` that reaches `hi`.
    GridAxis(float lo, float hi) : origin(lo) {
        int exponent;  // frexp: mantissa in [0.5, 1), or 0 with exponent 0 for a flat box.
        const double extent = double(hi) - double(lo);
        const double mantissa = std::frexp(extent / LAST_STEP, &exponent);
        if (mantissa == 0.0) exponent = MIN_EXPONENT;
        if (mantissa == 0.5) --exponent;
        scale = std::ldexp(1.0f, std::max(exponent, MIN_EXPONENT));
        while (decode(LAST_STEP) < hi)
            scale *= 2.0f;  // `extent` was rounded, as for [-255, 1e-30].
    }

    // The last step at or below x, which is in the range of the grid.
    uint32_t at_most(float x) const {
        auto q = uint32_t(steps(x));
        while (decode(q) > x)
            --q;
        return q;
    }
    // The first step at or above x, which is in the range of the grid.
    uint32_t at_least(float x) const {
        auto q = uint32_t(std::ceil(steps(x)));
        while (decode(q) < x)
            ++q;
        return q;
    }

  private:
    double steps(float x) const {
        return std::min((double(x) - double(origin)) / double(scale), double(LAST_STEP));
    }
};

}  // namespace

BvhNode quantise(std::span<const Box> boxes) {
    assert(boxes.size() <= BVH_WIDTH);
    Box bounds = boxes.empty() ? Box{vec3(0), vec3(0)} : boxes.front();
    for (const Box& box : boxes)
        bounds.extend(box);

    // A child that does not exist keeps the inverted box [255, 0].
    BvhNode node{.origin = bounds.lo,
                 .scale = vec3(1),
                 .q_lo = {uvec3(0xFFFFFFFFu), uvec3(0xFFFFFFu)},
                 .q_hi = {uvec3(0), uvec3(0)},
                 .children = uvec2(0)};
    for (int a = 0; a < 3; ++a) {
        const GridAxis axis(bounds.lo[a], bounds.hi[a]);
        node.scale[a] = axis.scale;
        for (size_t i = 0; i < boxes.size(); ++i) {
            node.q_lo[i / 4][a] ^= (LAST_STEP ^ axis.at_most(boxes[i].lo[a])) << 8 * (i % 4);
            node.q_hi[i / 4][a] |= axis.at_least(boxes[i].hi[a]) << 8 * (i % 4);
        }
    }
    return node;
}

}  // namespace candela
