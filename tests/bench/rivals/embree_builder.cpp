// The rival in `candela bench` of building, if the program is built with it; see bench/build.h.
#include <cassert>
#include <new>

#include <embree3/rtcore.h>

#include "base/error.h"
#include "bench/build.h"
#include "bvh/measure.h"
#include "bvh/quantise.h"

namespace candela {
namespace {

// Made by Embree's callbacks: a node with children, or a leaf with primitives of the array that Embree was
// given.
struct EmbreeNode {
    unsigned count = 0;  // Number of either.
    const RTCBuildPrimitive* primitives = nullptr;
    std::array<const EmbreeNode*, BVH_WIDTH> children{};
    std::array<Box, BVH_WIDTH> boxes;
};

EmbreeNode* allocate(RTCThreadLocalAllocator allocator) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(EmbreeNode), alignof(EmbreeNode))) EmbreeNode();
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned children, void*) {
    EmbreeNode* const node = allocate(allocator);
    node->count = children;
    return node;
}

void set_children(void* parent, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<EmbreeNode*>(parent)->children[i] = static_cast<const EmbreeNode*>(children[i]);
}

void set_bounds(void* parent, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) {
        const RTCBounds& b = *bounds[i];
        static_cast<EmbreeNode*>(parent)->boxes[i] = {vec3(b.lower_x, b.lower_y, b.lower_z),
                                                      vec3(b.upper_x, b.upper_y, b.upper_z)};
    }
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                  void*) {
    EmbreeNode* const leaf = allocate(allocator);
    leaf->count = unsigned(count);
    leaf->primitives = primitives;
    return leaf;
}

// Puts a node at `index`, and all below it at the end, depth first.
void put_node(const EmbreeNode& node, uint32_t index, Bvh& bvh) {
    const auto first_node = uint32_t(bvh.nodes.size()), first_primitive = uint32_t(bvh.order.size());
    std::vector<const EmbreeNode*> nodes;
    std::vector<Box> boxes, of_leaves;
    for (unsigned i = 0; i < node.count; ++i) {
        const EmbreeNode& child = *node.children[i];
        if (child.primitives == nullptr) {
            nodes.push_back(&child);
            boxes.push_back(node.boxes[i]);
        } else {
            assert(child.count == 1);
            bvh.order.push_back(child.primitives->primID);
            of_leaves.push_back(node.boxes[i]);
        }
    }
    boxes.insert(boxes.end(), of_leaves.begin(), of_leaves.end());
    BvhNode record = quantise(boxes);
    record.children = bvh_children(uint32_t(nodes.size()), first_node, node.count, first_primitive);
    bvh.nodes[index] = pack(record);
    bvh.nodes.resize(first_node + nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i)
        put_node(*nodes[i], first_node + uint32_t(i), bvh);
}

Bvh to_bvh(const EmbreeNode& root, std::span<const Box> boxes) {
    Bvh bvh;
    bvh.nodes.resize(1);
    for (const Box& box : boxes)
        bvh.bounds.extend(box);
    if (root.primitives != nullptr) {  // A leaf, which in our records hangs below a node.
        EmbreeNode node;
        node.count = 1;
        node.children[0] = &root;
        node.boxes[0] = bvh.bounds;
        put_node(node, 0, bvh);
    } else {
        put_node(root, 0, bvh);
    }
    const BvhMeasures measures = measure(bvh.nodes, bvh.bounds);
    bvh.depth = measures.depth;
    bvh.sah_cost = measures.sah_cost;
    return bvh;
}

std::vector<RTCBuildPrimitive> to_primitives(std::span<const Box> boxes) {
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(boxes.size());
    for (const Box& box : boxes) {
        primitives.push_back(
            {box.lo.x, box.lo.y, box.lo.z, 0, box.hi.x, box.hi.y, box.hi.z, uint32_t(primitives.size())});
    }
    return primitives;
}

}  // namespace

std::optional<TimedBvh> build_with_embree(std::span<const Box> boxes) {
    assert(!boxes.empty());
    std::vector<RTCBuildPrimitive> primitives = to_primitives(boxes);
    RTCDevice device = rtcNewDevice(nullptr);
    RTCBVH tree = rtcNewBVH(device);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = BVH_WIDTH;
    arguments.maxDepth = 64;
    arguments.sahBlockSize = 1;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = 1;
    arguments.traversalCost = float(BVH_NODE_COST);
    arguments.intersectionCost = 1.0f;
    arguments.bvh = tree;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    const Stopwatch watch;
    const auto* const root = static_cast<const EmbreeNode*>(rtcBuildBVH(&arguments));
    const Clocks clocks = watch.elapsed();
    std::optional<TimedBvh> result;
    if (root != nullptr) result = {to_bvh(*root, boxes), clocks};
    rtcReleaseBVH(tree);
    rtcReleaseDevice(device);
    if (!result) {
        throw Error("Embree has no memory for the mesh; use a smaller one (--triangles)",
                    ErrorKind::out_of_memory);
    }
    return result;
}

}  // namespace candela
