// validate() against trees that were broken on purpose, one promise each.
#include <gtest/gtest.h>

#include "bvh/bvh.h"
#include "bvh/quantise.h"
#include "unit/bvh/bvh_boxes.h"

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
    // A node, whose `children` say where its children are.
    BvhNode node(size_t i) const { return unpack(bvh_.nodes[i]); }
    void set_children(size_t i, uvec2 children) {
        BvhNode changed = node(i);
        changed.children = children;
        bvh_.nodes[i] = pack(changed);
    }
    // The position of the first child that is a primitive.
    uint32_t first_position(size_t i) const { return node(i).children.y & BVH_MAX_PRIMITIVES; }
    static std::string at(size_t node) { return "node " + std::to_string(node) + ": "; }
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

// The root of a thousand boxes has seven nodes; the last node of all has only leaves.
TEST_F(BvhValidate, SeesANodeOutOfRange) {
    const auto size = uint32_t(bvh_.nodes.size());
    set_children(0, bvh_children(7, size - 6, 7, 0));
    expect_problem(at(0) + "reference to node " + std::to_string(size) + ", which is out of range");
}

TEST_F(BvhValidate, SeesACycle) {
    set_children(1, bvh_children(7, 0, 7, 0));
    expect_problem(at(1) + "reference back to node 0");
}

TEST_F(BvhValidate, SeesANodeTwice) {
    set_children(1, bvh_children(7, 7, 7, 0));
    expect_problem(at(1) + "second reference to node 7");
}

TEST_F(BvhValidate, SeesALeafOutOfRange) {
    const size_t last = bvh_.nodes.size() - 1;
    set_children(last, bvh_children(0, 0, 1, 1000));
    expect_problem(at(last) + "leaf with position 1000, which is out of range");
}

TEST_F(BvhValidate, SeesALeafThatIsLost) {
    const size_t last = bvh_.nodes.size() - 1;
    const uint32_t count = bvh_child_count(node(last));
    ASSERT_GT(count, 1u);
    const uint32_t lost = leaf_position(bvh_child(node(last).children, count - 1));
    set_children(last, bvh_children(0, 0, count - 1, first_position(last)));
    expect_problem("position " + std::to_string(lost) + " of order: in no leaf");
}

TEST_F(BvhValidate, SeesALeafTwice) {
    const size_t last = bvh_.nodes.size() - 1;
    set_children(last, bvh_children(0, 0, 1, 0));
    expect_problem(at(last) + "second leaf with position 0");
}

TEST_F(BvhValidate, SeesANodeThatNothingRefersTo) {
    const size_t last = bvh_.nodes.size() - 1;
    bvh_.nodes.push_back(bvh_.nodes.back());
    expect_problem(at(last + 1) + "second leaf with position " + std::to_string(first_position(last)));
    bvh_.nodes.pop_back();
    set_children(0, bvh_children(6, 1, 6, 0));
    expect_problem(at(7) + "no reference to it");
}

TEST_F(BvhValidate, SeesABoxThatIsTooSmall) {
    const size_t last = bvh_.nodes.size() - 1;
    BvhNode changed = node(last);
    changed.q_lo[0].y &= ~0xFFu;
    changed.q_hi[0].y &= ~0xFFu;
    bvh_.nodes[last] = pack(changed);
    expect_problem(at(last) + "the box of child 0 does not contain what is below it");
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
    constexpr uint32_t LEVELS = 49;
    const std::vector<Box> boxes(size_t(3) * LEVELS, Box{vec3(0), vec3(1)});
    Bvh bvh = build_bvh(boxes);
    bvh.nodes.clear();
    for (uint32_t i = 0; i < LEVELS; ++i) {
        const bool last = i + 1 == LEVELS;
        BvhNode node = quantise(std::vector(4, Box{vec3(0), vec3(1)}));
        node.children = bvh_children(last ? 0 : 1, i + 1, last ? 3 : 4, 3 * i);
        bvh.nodes.push_back(pack(node));
    }
    bvh.depth = LEVELS;
    EXPECT_EQ(validate(bvh, boxes), "depth is 49, more than BVH_MAX_DEPTH, 48");
}

}  // namespace
}  // namespace candela
