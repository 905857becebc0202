// A split of a range of primitives: the cut is the one that the heuristic demands, and the parts are what
// they say.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bvh/measure.h"
#include "bvh/split.h"
#include "unit/bvh/bvh_boxes.h"

namespace candela {
namespace {

std::vector<PrimitiveRef> make_refs(const std::vector<Box>& boxes) {
    std::vector<PrimitiveRef> refs;
    for (const Box& box : boxes)
        refs.push_back({box.lo, uint32_t(refs.size()), box.hi});
    return refs;
}

PrimitiveRange range_of(const std::vector<PrimitiveRef>& refs) {
    PrimitiveRange range;
    for (const PrimitiveRef& ref : refs)
        range.add(ref);
    return range;
}

// Unit cubes on an axis: counts[i] of them at positions[i].
std::vector<Box> clusters(int axis, const std::vector<float>& positions, const std::vector<int>& counts) {
    std::vector<Box> boxes;
    for (size_t i = 0; i < counts.size(); ++i) {
        vec3 lo(0.0f);
        lo[axis] = positions[i];
        boxes.insert(boxes.end(), size_t(counts[i]), Box{lo, lo + vec3(1.0f)});
    }
    return boxes;
}

void expect_counts(const std::vector<Box>& boxes, uint32_t left, uint32_t right) {
    std::vector<PrimitiveRef> refs = make_refs(boxes);
    const SplitRanges parts = split_sah(refs, range_of(refs));
    EXPECT_EQ(parts[0].count, left);
    EXPECT_EQ(parts[1].count, right);
}

// A row of unit cubes of length L has half the area 1 + 2 L. Behind the first cluster or behind the second,
// the cuts cost (counts times half areas)
//   40 * 3 + 30 * 24 = 840     and   50 * 23 + 20 * 3 = 1210    of clusters at 0, 10 and 20.5,
//   60 * 3 + 11 * 183 = 2193   and   70 * 23 + 1 * 3 = 1613     of clusters at 0, 10 and 100.
// By areas alone the first row would be cut behind the second cluster (27 to 26), and by balance alone the
// second row behind the first.
TEST(BvhSplit, CutsWhereAreaTimesCountIsLeast) {
    for (int axis = 0; axis < 3; ++axis) {
        expect_counts(clusters(axis, {0.0f, 10.0f, 20.5f}, {40, 10, 20}), 40, 30);
        expect_counts(clusters(axis, {0.0f, 10.0f, 100.0f}, {60, 10, 1}), 70, 1);
    }
}

// Half areas times counts of both sides of a cut behind centroid `at` on an axis [m^2], from the definition.
double cost_of_cut(const std::vector<Box>& boxes, int axis, float at) {
    std::array<Box, 2> bounds;
    std::array<double, 2> counts{};
    for (const Box& box : boxes) {
        const size_t side = box.centroid()[axis] > at ? 1 : 0;
        bounds[side].extend(box);
        ++counts[side];
    }
    return half_area(bounds[0]) * counts[0] + half_area(bounds[1]) * counts[1];
}

// Centroids at whole numbers from 0 to 11: 64 primitives have at least 12 bins, so that there is a cut
// between any two numbers. The search computes in floats: from areas to costs there are fewer than ten
// roundings on either side of a comparison, and the cut that it finds may cost more by twice that.
TEST(BvhSplit, FindsTheBestCutOfAllAxes) {
    std::mt19937 generator(11);
    std::uniform_int_distribution<int> place(0, 11);
    std::exponential_distribution<float> size(1.0f);
    for (int trial = 0; trial < 200; ++trial) {
        const vec3 centres[2] = {vec3(0.0f), vec3(11.0f)};
        std::vector<Box> boxes;
        for (int i = 0; i < 64; ++i) {
            vec3 centre(0.0f), extent(0.0f);
            for (int a = 0; a < 3; ++a) {
                centre[a] = i < 2 ? centres[i][a] : float(place(generator));
                extent[a] = std::round(16.0f * size(generator)) / 16.0f;  // Exact, and so are centroids.
            }
            boxes.push_back({centre - extent, centre + extent});
        }
        double min = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            for (int at = 0; at < 11; ++at)
                min = std::min(min, cost_of_cut(boxes, axis, float(at)));
        }
        std::vector<PrimitiveRef> refs = make_refs(boxes);
        double found = 0.0;
        for (const PrimitiveRange& part : split_sah(refs, range_of(refs)))
            found += half_area(Box(part.bounds)) * part.count;
        EXPECT_LE(found, min * (1.0 + 20 * 0x1p-24)) << "trial " << trial;
    }
}

// Areas of such boxes overflow floats, or underflow.
TEST(BvhSplit, CutsBoxesOfAnySizeAlike) {
    for (const float scale : {1e-38f, 1e-25f, 1e25f, 9e34f}) {
        std::vector<Box> boxes = clusters(0, {0.0f, 10.0f, 100.0f}, {60, 10, 1});
        for (Box& box : boxes)
            box = {box.lo * scale, box.hi * scale};
        expect_counts(boxes, 70, 1);
    }
}

// Points: every cut costs nothing.
TEST(BvhSplit, CutsInTheMiddleWhereCostsAreEqual) {
    std::vector<Box> boxes;
    for (int i = 0; i < 32; ++i)
        boxes.push_back({vec3(0, float(i), 0), vec3(0, float(i), 0)});
    expect_counts(boxes, 16, 16);
}

// The parts of ranges of many sizes and scales hold each primitive once, and their bounds are exact.
TEST(BvhSplit, PartsAreWhatTheySay) {
    for (const uint32_t count : {2u, 3u, 7u, 40u, 1000u}) {
        for (const float scale : {1e-40f, 1e-20f, 1.0f, 1e37f}) {
            SCOPED_TRACE(testing::Message() << count << " boxes times " << scale);
            std::vector<Box> boxes = random_boxes(count, 0.2f, count);
            for (Box& box : boxes)
                box = {box.lo * scale, box.hi * scale};
            std::vector<PrimitiveRef> refs = make_refs(boxes);
            const SplitRanges parts = split_sah(refs, range_of(refs));
            ASSERT_EQ(parts[0].count + parts[1].count, count);
            EXPECT_EQ(parts[0].first, 0u);
            EXPECT_EQ(parts[1].first, parts[0].count);
            std::vector<bool> seen(count);
            for (const PrimitiveRange& part : parts) {
                ASSERT_GT(part.count, 0u);
                Box bounds, centroids2;
                for (uint32_t i = part.first; i < part.first + part.count; ++i) {
                    const Box& box = boxes[refs[i].index];
                    EXPECT_FALSE(seen[refs[i].index]);
                    seen[refs[i].index] = true;
                    bounds.extend(box);
                    centroids2.extend(box.lo + box.hi);
                }
                EXPECT_EQ(Box(part.bounds).lo, bounds.lo);
                EXPECT_EQ(Box(part.bounds).hi, bounds.hi);
                EXPECT_EQ(Box(part.centroids2).lo, centroids2.lo);
                EXPECT_EQ(Box(part.centroids2).hi, centroids2.hi);
            }
        }
    }
}

}  // namespace
}  // namespace candela
