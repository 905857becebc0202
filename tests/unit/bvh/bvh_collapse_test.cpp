// The wide tree that a binary one becomes is the cheapest: compared with every other, on small trees.
#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bvh/collapse.h"

namespace candela {
namespace {

using Tree = std::vector<BinaryNode>;

// A tree of `leaves` leaves whose nodes divide at random; no child is larger than its parent.
Tree random_tree(uint32_t leaves, std::mt19937& generator) {
    Tree tree{{.area = 1.0}};
    std::vector<uint32_t> counts{leaves};
    for (size_t i = 0; i < tree.size(); ++i) {
        if (counts[i] == 1) continue;
        tree[i].left = uint32_t(tree.size());
        const auto left = std::uniform_int_distribution<uint32_t>(1, counts[i] - 1)(generator);
        for (const uint32_t count : {left, counts[i] - left}) {
            const double area = tree[i].area * std::uniform_real_distribution<>(0.3, 1.0)(generator);
            tree.push_back({.area = area});
            counts.push_back(count);
        }
    }
    return tree;
}

// The least sum of areas of wide nodes with at most `places` nodes or leaves in the place of a binary node.
double min_cost(const Tree& tree, uint32_t index, uint32_t places);

// The same in place of its two children, with any division between them.
double min_cost_of_children(const Tree& tree, uint32_t index, uint32_t places) {
    double min = std::numeric_limits<double>::infinity();
    for (uint32_t left = 1; left < places; ++left) {
        min = std::min(min, min_cost(tree, tree[index].left, left) +
                                min_cost(tree, tree[index].left + 1, places - left));
    }
    return min;
}

double min_cost(const Tree& tree, uint32_t index, uint32_t places) {
    if (tree[index].left == 0) return 0.0;
    const double as_node = tree[index].area + min_cost_of_children(tree, index, BVH_WIDTH);
    return places == 1 ? as_node : std::min(as_node, min_cost_of_children(tree, index, places));
}

// What wide_children makes of the tree at a wide node and below.
struct Wide {
    double cost = 0.0;
    uint32_t leaves = 0;
    uint32_t depth = 0;
};

Wide walk(const Tree& tree, uint32_t index) {
    Wide wide{.cost = tree[index].area};
    const WideChildren children = wide_children(tree, index);
    EXPECT_LE(children.count, BVH_WIDTH);
    for (uint32_t c = 0; c < children.count; ++c) {
        const uint32_t child = children.indices[c];
        if (tree[child].left == 0) {
            ++wide.leaves;
            continue;
        }
        const Wide below = walk(tree, child);
        wide.cost += below.cost;
        wide.leaves += below.leaves;
        wide.depth = std::max(wide.depth, below.depth);
    }
    ++wide.depth;
    return wide;
}

TEST(BvhCollapse, CostsAsLittleAsAnyOther) {
    std::mt19937 generator(1);
    for (uint32_t leaves = 2; leaves <= 14; ++leaves) {
        for (int trial = 0; trial < 20; ++trial) {
            Tree tree = random_tree(leaves, generator);
            const double min = min_cost(tree, 0, 1);
            find_min_costs(tree);
            const Wide wide = walk(tree, 0);
            EXPECT_NEAR(wide.cost, min, 1e-12);
            EXPECT_EQ(wide.leaves, leaves);
        }
    }
}

TEST(BvhCollapse, ALeafIsItsOwnOnlyChild) {
    Tree tree{{.area = 1.0}};
    find_min_costs(tree);
    const WideChildren children = wide_children(tree, 0);
    ASSERT_EQ(children.count, 1u);
    EXPECT_EQ(children.indices[0], 0u);
}

// Without areas all trees cost the same. With 4096 leaves, halved again and again, a node has an eighth in
// each of six children and a quarter in one.
TEST(BvhCollapse, IsFlatAmongEquals) {
    Tree tree{{}};
    for (uint32_t i = 0; i < 4095; ++i) {
        tree[i].left = uint32_t(tree.size());
        tree.resize(tree.size() + 2);
    }
    find_min_costs(tree);
    const Wide wide = walk(tree, 0);
    EXPECT_EQ(wide.leaves, 4096u);
    EXPECT_LE(wide.depth, 6u);
}

}  // namespace
}  // namespace candela
