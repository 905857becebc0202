// Instances become nodes of the tree, and nothing else about it changes.
#include "bvh/two_levels.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/bvh/bvh_boxes.h"

namespace candela {
namespace {

// What a walk through all nodes finds: the decoded box of each leaf, and how often each node is a child.
struct Found {
    std::map<uint32_t, Box> primitives;   // By position in leaf order.
    std::map<uint32_t, Box> instances;    // By node.
    std::map<uint32_t, uint32_t> levels;  // Levels of nodes.
};

// `sorted`: by bvh_longest_axis().
Found walk(const std::vector<PackedBvhNode>& nodes, uint32_t root,
           const std::vector<uint32_t>& instance_nodes, bool sorted = true) {
    Found found;
    std::vector<uint32_t> waiting{root};
    found.levels[root] = 1;
    while (!waiting.empty()) {
        const uint32_t at = waiting.back();
        waiting.pop_back();
        const BvhNode node = unpack(nodes.at(at));
        const auto axis = glm::length_t(bvh_longest_axis(node.scale));
        float middle = -INFINITE;
        for (uint32_t i = 0; i < bvh_child_count(node); ++i) {
            const uint32_t child = bvh_child(node.children, i);
            if (sorted && !is_leaf(child)) {
                const Box box = child_box(node, i);
                EXPECT_GE(0.5f * (box.lo + box.hi)[axis], middle);
                middle = 0.5f * (box.lo + box.hi)[axis];
            }
            if (is_leaf(child)) {
                EXPECT_TRUE(found.primitives.emplace(leaf_position(child), child_box(node, i)).second);
                continue;
            }
            EXPECT_TRUE(found.levels.emplace(child, found.levels[at] + 1).second) << "two ways to " << child;
            if (std::ranges::find(instance_nodes, child) == instance_nodes.end()) {
                waiting.push_back(child);
            } else {
                found.instances.emplace(child, child_box(node, i));
            }
        }
    }
    return found;
}

void expect_equal(const Box& a, const Box& b) {
    EXPECT_EQ(a.lo, b.lo);
    EXPECT_EQ(a.hi, b.hi);
}

// The boxes from index `primitives` on are instances.
void expect_separated(size_t count, uint32_t primitives) {
    SCOPED_TRACE(count);
    SCOPED_TRACE(primitives);
    const std::vector<Box> boxes = random_boxes(count, 0.1f);
    const Bvh bvh = build_bvh(boxes);
    const Found before = walk(bvh.nodes, 0, {}, false);
    std::map<uint32_t, Box> decoded;  // By the boxes' indices.
    for (const auto& [position, box] : before.primitives)
        decoded.emplace(bvh.order[position], box);

    const TwoLevelTree tree = separate_instances(bvh, primitives);
    ASSERT_EQ(tree.nodes.size(), bvh.nodes.size() + count - primitives);
    ASSERT_EQ(tree.order.size(), primitives);
    ASSERT_EQ(tree.instance_nodes.size(), count - primitives);
    const Found after = walk(tree.nodes, 0, tree.instance_nodes);
    EXPECT_EQ(after.levels.size(), tree.nodes.size());
    ASSERT_EQ(after.primitives.size(), primitives);
    ASSERT_EQ(after.instances.size(), count - primitives);
    for (const auto& [position, box] : after.primitives)
        expect_equal(box, decoded.at(tree.order[position]));
    uint32_t deepest = 0;
    for (const auto& [node, level] : after.levels)
        deepest = std::max(deepest, level);
    EXPECT_EQ(tree.depth, deepest);
    for (size_t i = 0; i < tree.instance_nodes.size(); ++i) {
        const uint32_t node = tree.instance_nodes[i];
        expect_equal(after.instances.at(node), decoded.at(primitives + uint32_t(i)));
        EXPECT_EQ(tree.instance_levels[i], after.levels.at(node));
    }
}

TEST(TwoLevels, InstancesBecomeNodesAndAllBoxesStay) {
    for (const size_t count : {1, 2, 6, 7, 8, 50, 1000}) {
        expect_separated(count, 0);
        expect_separated(count, uint32_t(count / 2));
        expect_separated(count, uint32_t(count - 1));
    }
    expect_separated(20'000, 15'000);  // Built in several tasks.
}

TEST(TwoLevels, TheTreeOfAMeshFollows) {
    const std::vector<Box> top = random_boxes(40, 0.1f), below = random_boxes(300, 0.1f, 2);
    TwoLevelTree tree = separate_instances(build_bvh(top), 30);
    Bvh mesh = build_bvh(below);
    const Found alone = walk(mesh.nodes, 0, {}, false);
    sort_children(mesh);
    const std::vector<PackedBvhNode> before = tree.nodes;
    const uint32_t root = append_tree(tree.nodes, 30, mesh);
    EXPECT_EQ(root, before.size());
    EXPECT_TRUE(std::equal(before.begin(), before.end(), tree.nodes.begin()));
    const Found found = walk(tree.nodes, root, {});
    EXPECT_EQ(found.levels.size(), mesh.nodes.size());
    ASSERT_EQ(found.primitives.size(), below.size());
    for (const auto& [position, box] : alone.primitives)
        expect_equal(found.primitives.at(position + 30), box);
}

TEST(TwoLevels, MorePrimitivesThanPositionsAreAnError) {
    std::vector<PackedBvhNode> nodes(1);
    const Bvh mesh = build_bvh(random_boxes(10, 0.1f));
    EXPECT_NO_THROW(append_tree(nodes, BVH_MAX_PRIMITIVES - 10, mesh));
    try {
        append_tree(nodes, BVH_MAX_PRIMITIVES - 9, mesh);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "BVH: the meshes have 67108864 primitives, but at most 67108863 can be addressed; "
                     "simplify the meshes");
    }
}

}  // namespace
}  // namespace candela
