// The BVH builder: valid trees for any input, the same bytes for any number of threads, a bounded stack.
#include "bvh/bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include <gtest/gtest.h>

#include "base/error.h"
#include "bvh/task_queue.h"
#include "unit/bvh/bvh_boxes.h"

namespace candela {
namespace {

// Builds over `boxes` and expects a valid tree.
Bvh build_valid(const std::vector<Box>& boxes) {
    Bvh bvh = build_bvh(boxes);
    EXPECT_EQ(validate(bvh, boxes), std::nullopt);
    return bvh;
}

void expect_refused(std::span<const Box> boxes, const std::string& message) {
    try {
        build_bvh(boxes);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.what(), message);
    }
}

Box point(float x, float y = 0.0f, float z = 0.0f) {
    return {vec3(x, y, z), vec3(x, y, z)};
}

// Nodes on the longest way down from node `index`.
uint32_t levels(const Bvh& bvh, uint32_t index) {
    const BvhNode node = unpack(bvh.nodes[index]);
    uint32_t below = 0;
    for (uint32_t c = 0; c < bvh_child_count(node); ++c) {
        const uint32_t child = bvh_child(node.children, c);
        if (!is_leaf(child)) below = std::max(below, levels(bvh, child));
    }
    return below + 1;
}

TEST(Bvh, HoldsNothing) {
    const Bvh bvh = build_valid({});
    ASSERT_EQ(bvh.nodes.size(), 1u);
    EXPECT_EQ(unpack(bvh.nodes[0]).children, bvh_children(0, 0, 1, 0));
    EXPECT_TRUE(bvh.order.empty());
    EXPECT_TRUE(bvh.bounds.is_empty());
    EXPECT_EQ(bvh.depth, 1u);
    EXPECT_EQ(bvh.sah_cost, 0.0f);
}

TEST(Bvh, HoldsOnePrimitiveInOneLeaf) {
    const Bvh bvh = build_valid({Box{vec3(1, 2, 3), vec3(4, 5, 6)}});
    ASSERT_EQ(bvh.nodes.size(), 1u);
    const BvhNode root = unpack(bvh.nodes[0]);
    EXPECT_EQ(bvh_child_count(root), 1u);
    EXPECT_EQ(bvh_child(root.children, 0), BVH_LEAF_BIT | 0u);
    EXPECT_EQ(bvh.order, std::vector<uint32_t>{0});
}

TEST(Bvh, IsValidForRandomBoxesOfAnyCount) {
    for (const size_t count : {2, 3, 4, 5, 6, 7, 8, 9, 16, 17, 33, 100, 1000, 10000}) {
        for (const float size : {0.01f, 1.0f}) {
            SCOPED_TRACE(count);
            const Bvh bvh = build_valid(random_boxes(count, size, uint32_t(count)));
            EXPECT_LE(bvh.depth, BVH_MAX_DEPTH);
        }
    }
}

// Siblings are adjacent; then come all nodes below the first of them, then all below the second, and so on.
// Positions are in the order in which the nodes are visited.
TEST(Bvh, NumbersSiblingsSideBySideAndTheRestDepthFirst) {
    const Bvh bvh = build_bvh(random_boxes(20000, 0.01f));
    std::vector<uint32_t> stack{0};
    uint32_t next_node = 1, next_position = 0;
    while (!stack.empty()) {
        const BvhNode node = unpack(bvh.nodes[stack.back()]);
        stack.pop_back();
        std::vector<uint32_t> nodes;
        for (uint32_t c = 0; c < bvh_child_count(node); ++c) {
            const uint32_t child = bvh_child(node.children, c);
            if (is_leaf(child)) {
                ASSERT_EQ(leaf_position(child), next_position++);
            } else {
                ASSERT_EQ(child, next_node++);
                nodes.push_back(child);
            }
        }
        stack.insert(stack.end(), nodes.rbegin(), nodes.rend());
    }
    EXPECT_EQ(next_node, bvh.nodes.size());
    EXPECT_EQ(next_position, bvh.order.size());
}

// 20 000 boxes make several tasks; the grid and the equal boxes make many ties.
TEST(Bvh, IsTheSameForAnyNumberOfThreads) {
    std::vector<Box> grid(20000), equal(20000, Box{vec3(-1), vec3(1)});
    for (int i = 0; i < 20000; ++i) {
        const int x = i % 40, y = i / 40 % 40, z = i / 1600;
        grid[i] = point(float(x), float(y), float(z));
    }
    for (const std::vector<Box>& boxes : {random_boxes(20000, 0.01f), grid, equal}) {
        const Bvh one = build_bvh(boxes, {.threads = 1});
        for (const unsigned threads : {2u, 3u, 8u}) {
            const Bvh other = build_bvh(boxes, {.threads = threads});
            EXPECT_EQ(one.nodes, other.nodes);
            EXPECT_EQ(one.order, other.order);
            EXPECT_EQ(one.sah_cost, other.sah_cost);
        }
    }
}

TEST(Bvh, SplitsEqualCentroidsInHalvesByIndex) {
    const Bvh bvh = build_valid(std::vector<Box>(64, Box{vec3(-1), vec3(1)}));
    // The root's children are eighths but for one quarter; the quarter's are a pair or two and single ones.
    EXPECT_EQ(bvh.depth, 3u);
    for (auto quarter = bvh.order.begin(); quarter != bvh.order.end(); quarter += 16) {
        const auto [min, greatest] = std::minmax_element(quarter, quarter + 16);
        EXPECT_EQ(*greatest - *min, 15u);
    }
}

TEST(Bvh, BalancesPointsOnALine) {
    std::vector<Box> boxes(4096);
    for (int i = 0; i < 4096; ++i)
        boxes[i] = point(float(i));  // No split has any area.
    const Bvh bvh = build_valid(boxes);
    EXPECT_LE(bvh.depth, 6u);  // log4(4096): of seven children six are an eighth, one is a quarter.
    EXPECT_EQ(bvh.sah_cost, 0.0f);
}

TEST(Bvh, HoldsFlatBoxes) {
    std::vector<Box> boxes = random_boxes(1000, 0.1f);
    for (Box& box : boxes)
        box.lo.y = box.hi.y = 0.25f;
    const Bvh bvh = build_valid(boxes);
    EXPECT_GT(bvh.sah_cost, 0.0f);
}

TEST(Bvh, HoldsCoordinatesOfAnySize) {
    for (const float scale : {1e-44f, 1e-38f, 1e-20f, 1e6f, 1e30f, 1.9e37f}) {
        SCOPED_TRACE(scale);
        std::vector<Box> boxes = random_boxes(1000, 0.05f);
        for (Box& box : boxes)
            box = {box.lo * scale, box.hi * scale};
        EXPECT_TRUE(std::isfinite(build_valid(boxes).sah_cost));
    }
}

TEST(Bvh, HoldsADetailInARoomAMillionTimesLarger) {
    std::vector<Box> boxes = random_boxes(1000, 0.05f);
    const float cost_alone = build_valid(boxes).sah_cost;
    boxes.push_back({vec3(-1e6f), vec3(1e6f, 1e6f, -1e6f)});
    boxes.push_back({vec3(-1e6f, -1e6f, 1e6f), vec3(1e6f)});
    // Hardly any ray through the room comes near the detail.
    EXPECT_LT(build_valid(boxes).sah_cost, 0.5f * cost_alone);
}

TEST(Bvh, IsNotTooDeepWhereTheHeuristicWouldPeelOffBoxesOneByOne) {
    std::vector<Box> boxes;
    for (float x = 1e-37f; x < 1e37f; x *= 1.25f)
        boxes.push_back({vec3(0.0f), vec3(x)});
    const Bvh bvh = build_valid(boxes);
    EXPECT_GT(bvh.depth, BVH_MAX_DEPTH / 2);
    EXPECT_LE(bvh.depth, BVH_MAX_DEPTH);
    EXPECT_EQ(bvh.depth, levels(bvh, 0));
}

TEST(Bvh, DepthIsThatOfTheLongestWayDown) {
    for (const size_t count : {1, 2, 5, 17, 300, 3000}) {
        const Bvh bvh = build_bvh(random_boxes(count, 0.1f, uint32_t(count)));
        EXPECT_EQ(bvh.depth, levels(bvh, 0));
    }
}

// Two unit cubes, one unit apart: the root costs one test; each leaf, which has 3/7 of its area, one as well.
TEST(Bvh, SahCostIsThatOfTheFormula) {
    const Bvh bvh = build_valid({Box{vec3(0), vec3(1)}, Box{vec3(2, 0, 0), vec3(3, 1, 1)}});
    ASSERT_EQ(unpack(bvh.nodes[0]).children, bvh_children(0, 1, 2, 0));
    EXPECT_FLOAT_EQ(bvh.sah_cost, 1.0f + 6.0f / 7.0f);
}

TEST(Bvh, RefusesBoxesThatAreNoBoxes) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::string rule =
        "; coordinates must be numbers from -1e37 to 1e37, and no lower one above its upper one";
    std::vector<Box> boxes(3, Box{vec3(0), vec3(1)});
    boxes[2].lo.y = nan;
    expect_refused(boxes, "BVH: primitive 2 has the box [0 nan 0] to [1 1 1]" + rule);
    boxes[2] = {vec3(0), vec3(1, 1, INFINITE)};
    expect_refused(boxes, "BVH: primitive 2 has the box [0 0 0] to [1 1 inf]" + rule);
    boxes[1] = {vec3(0, 2, 0), vec3(1)};
    expect_refused(boxes, "BVH: primitive 1 has the box [0 2 0] to [1 1 1]" + rule);
    boxes[0] = {vec3(-2e37f, 0, 0), vec3(1)};
    expect_refused(boxes, "BVH: primitive 0 has the box [-2e+37 0 0] to [1 1 1]" + rule);
    boxes[0] = Box();
    expect_refused(boxes, "BVH: primitive 0 has the box [inf inf inf] to [-inf -inf -inf]" + rule);
}

TEST(Bvh, RefusesMorePrimitivesThanReferencesCanName) {
    const Box box;
    const std::span<const Box> too_many(&box, size_t(BVH_MAX_PRIMITIVES) + 1);  // Only counted, never read.
    expect_refused(
        too_many,
        "BVH: 67108864 primitives, but the node record holds at most 67108863; simplify the meshes");
}

TEST(TaskQueue, RunsTasksOfTasksAndThrowsWhatOneThrows) {
    for (const unsigned threads : {1u, 4u}) {
        std::mutex mutex;
        int sum = 0;
        TaskQueue<int> queue;
        queue.push(10);
        queue.run(threads, [&](int task) {
            if (task > 1) queue.push(task - 1);
            const std::lock_guard lock(mutex);
            sum += task;
        });
        EXPECT_EQ(sum, 55);

        TaskQueue<int> failing;
        failing.push(10);
        EXPECT_THROW(failing.run(threads,
                                 [&](int task) {
                                     if (task == 5) throw Error("five");
                                     failing.push(task - 1);
                                 }),
                     Error);
    }
}

}  // namespace
}  // namespace candela
