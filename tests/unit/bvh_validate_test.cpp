// validate() against trees that were broken on purpose, one promise each.
#include <gtest/gtest.h>

#include "bvh/bvh.h"
#include "bvh_boxes.h"

namespace candela {
namespace {

class BvhValidate : public testing::Test {
  protected:
    const std::vector<Box> boxes_ = random_boxes(1000, 0.1f);
    Bvh bvh_ = build_bvh(boxes_);

    void SetUp() override { ASSERT_EQ(validate(bvh_, boxes_), std::nullopt); }

    void expect_problem(const std::string& words) const {
        const std::optional<std::string> problem = validate(bvh_, boxes_);
        ASSERT_TRUE(problem.has_value());
        EXPECT_EQ(*problem, words);
    }
    // Some leaf reference, and where it stands.
    struct Place {
        size_t node;
        int child;
    };
    Place find_leaf() const {
        for (size_t i = 0; i < bvh_.nodes.size(); ++i) {
            for (int c = 0; c < int(BVH_WIDTH); ++c) {
                const uint32_t reference = bvh_.nodes[i][3][c];
                if (is_leaf(reference) && leaf_count(reference) > 0) return {i, c};
            }
        }
        return {};
    }
    std::string at(const Place& place) const { return "node " + std::to_string(place.node) + ": "; }
    uint32_t& reference(const Place& place) { return bvh_.nodes[place.node][3][place.child]; }
};

TEST_F(BvhValidate, SeesAMissingRoot) {
    bvh_.nodes.clear();
    expect_problem("there is no root");
}

TEST_F(BvhValidate, SeesAnOrderOfTheWrongLength) {
    bvh_.order.pop_back();
    expect_problem("order has entries 999 for primitives 1000");
}

TEST_F(BvhValidate, SeesAPrimitiveOutOfRange) {
    bvh_.order[7] = 1000;
    expect_problem("order names primitive 1000 of 1000");
}

TEST_F(BvhValidate, SeesAPrimitiveTwice) {
    bvh_.order[7] = bvh_.order[3];
    expect_problem("order names primitive " + std::to_string(bvh_.order[3]) + " twice");
}

TEST_F(BvhValidate, SeesANodeOutOfRange) {
    bvh_.nodes[0][3].x = uint32_t(bvh_.nodes.size());
    expect_problem("node 0: reference to node " + std::to_string(bvh_.nodes.size()) +
                   ", which is out of range");
}

TEST_F(BvhValidate, SeesACycle) {
    bvh_.nodes[1][3].x = 0;
    expect_problem("node 1: reference back to node 0");
}

TEST_F(BvhValidate, SeesANodeTwice) {
    bvh_.nodes[0][3].y = bvh_.nodes[0][3].x;
    expect_problem("node 0: second reference to node 1");
}

TEST_F(BvhValidate, SeesALeafOutOfRange) {
    const Place leaf = find_leaf();
    reference(leaf) = leaf_reference(999, 2);
    expect_problem(at(leaf) + "leaf with position 1000, which is out of range");
}

TEST_F(BvhValidate, SeesALeafThatIsLost) {
    // The last node has leaves alone.
    int last = int(BVH_WIDTH) - 1;
    while (bvh_.nodes.back()[3][last] == BVH_EMPTY)
        --last;
    const uint32_t lost = leaf_first(bvh_.nodes.back()[3][last]);
    bvh_.nodes.back()[3][last] = BVH_EMPTY;
    expect_problem("position " + std::to_string(lost) + " of order: in no leaf");
}

TEST_F(BvhValidate, SeesALeafTwice) {
    const Place leaf = find_leaf();
    const uint32_t old = reference(leaf);
    bvh_.nodes.back()[3] = uvec4(leaf_reference(leaf_first(old), 1), uvec3(BVH_EMPTY));
    expect_problem("node " + std::to_string(bvh_.nodes.size() - 1) + ": second leaf with position " +
                   std::to_string(leaf_first(old)));
}

TEST_F(BvhValidate, SeesANodeThatNothingRefersTo) {
    bvh_.nodes.push_back(bvh_.nodes.back());
    bvh_.nodes.back()[3] = uvec4(BVH_EMPTY);
    expect_problem("node " + std::to_string(bvh_.nodes.size() - 1) + ": no child");
    bvh_.nodes.pop_back();
    bvh_.nodes[0][3].w = BVH_EMPTY;
    const std::optional<std::string> problem = validate(bvh_, boxes_);
    ASSERT_TRUE(problem.has_value());
    EXPECT_NE(problem->find(": no reference to it"), std::string::npos) << *problem;
}

TEST_F(BvhValidate, SeesAHoleBetweenChildren) {
    bvh_.nodes[0][3].y = BVH_EMPTY;
    expect_problem("node 0: child behind an empty one");
}

TEST_F(BvhValidate, SeesABoxThatIsTooSmall) {
    const Place leaf = find_leaf();
    bvh_.nodes[leaf.node][1].y &= ~(0xFFu << 8 * leaf.child);  // q_lo.y = 0 ...
    bvh_.nodes[leaf.node][2].x &= ~(0xFFu << 8 * leaf.child);  // ... and q_hi.y = 0.
    expect_problem(at(leaf) + "the box of child " + std::to_string(leaf.child) +
                   " does not contain what is below it");
}

TEST_F(BvhValidate, SeesABoxTooSmallForWhatIsFurtherDown) {
    BvhNode root = unpack(bvh_.nodes[0]);
    root.scale *= 0.5f;
    bvh_.nodes[0] = pack(root);
    expect_problem("node 0: the box of child 0 does not contain what is below it");
}

TEST_F(BvhValidate, SeesWrongBounds) {
    bvh_.bounds.hi.z += 1.0f;
    expect_problem("bounds are not those of the primitives");
}

TEST_F(BvhValidate, SeesWrongMeasures) {
    const std::string depth = std::to_string(bvh_.depth);
    ++bvh_.depth;
    expect_problem("depth is " + depth + ", not " + std::to_string(bvh_.depth));
    --bvh_.depth;
    bvh_.sah_cost *= 1.01f;
    expect_problem("sah_cost is not that of the nodes");
}

// A chain of nodes with three leaves each, as a builder without a bound would make it.
TEST(BvhValidateStack, SeesATreeThatIsTooDeep) {
    constexpr uint32_t LEVELS = 33;
    const std::vector<Box> boxes(size_t(3) * LEVELS, Box{vec3(0), vec3(1)});
    Bvh bvh = build_bvh(boxes);
    bvh.nodes.clear();
    for (uint32_t i = 0; i < LEVELS; ++i) {
        BvhNode node{vec3(0), vec3(1), uvec3(0), uvec3(0x01010101u), uvec4(BVH_EMPTY)};
        for (uint32_t c = 0; c < 3; ++c)
            node.child[int(c)] = leaf_reference(3 * i + c, 1);
        if (i + 1 < LEVELS) node.child.w = i + 1;
        bvh.nodes.push_back(pack(node));
    }
    bvh.depth = LEVELS;
    EXPECT_EQ(validate(bvh, boxes), "depth is 33, more than BVH_STACK_SIZE, 32");
}

}  // namespace
}  // namespace candela
