// Builds the tree from the root down, straight to 4 children a node: what a binary build and a collapse give,
// without the binary tree. Large ranges are tasks of their own, whose pieces are joined in depth-first order.
// What a task does follows from its range alone, so the number of threads never changes the result.
#include "bvh/bvh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>
#include <sstream>
#include <thread>
#include <utility>

#include "base/error.h"
#include "bvh/measure.h"
#include "bvh/quantise.h"
#include "bvh/split.h"
#include "bvh/task_queue.h"

namespace candela {

namespace {

// A range larger than this is a task of its own: small enough for many tasks a thread, large enough that
// taking a task costs nothing against it.
constexpr uint32_t TASK_SIZE = 8192;
// Coordinates below it leave room to add, subtract and scale boxes in float arithmetic.
constexpr float MAX_COORDINATE = 1e37f;

// A piece of the tree in depth-first order, with references from its first node. Either a whole subtree, or
// one node whose children stand in pieces of their own.
struct Piece {
    std::vector<PackedBvhNode> nodes;
    std::array<std::unique_ptr<Piece>, BVH_WIDTH> children;
};

// A node to build, at `depth` nodes below the root.
struct Job {
    PrimitiveRange range;
    uint32_t depth = 0;
};

struct Task {
    Job job;
    Piece* piece = nullptr;  // Receives the result.
};

// The parts of a range that become the children of one node.
struct Children {
    std::array<PrimitiveRange, BVH_WIDTH> ranges;
    uint32_t count = 0;
};

bool makes_leaf(const PrimitiveRange& range) {
    return range.count <= BVH_LEAF_SIZE;
}

// Levels of nodes over `count` primitives if each splits into four equal parts.
uint32_t balanced_depth(uint32_t count) {
    uint32_t depth = 0;
    for (; count > BVH_LEAF_SIZE; count = (count + 3) / 4)
        ++depth;
    return depth;
}

// Splits the range of a node, then the part that most rays would meet (the largest surface), until there are
// four parts. The heuristic may take a single primitive
// off at every split (boxes that grow exponentially). So wherever a child of all primitives but one might
// be too deep for what is left of BVH_STACK_SIZE levels, the node is split into equal parts, and those fit:
// nodes on the way down kept to this rule.
Children open_children(std::span<PrimitiveRef> refs, const Job& job) {
    const bool balanced = job.depth + 1 + balanced_depth(job.range.count - 1) >= BVH_STACK_SIZE;
    const auto priority = [balanced](const PrimitiveRange& range) {
        return std::make_pair(balanced ? 0.0 : half_area(Box(range.bounds)), range.count);
    };

    Children children{{job.range}, 1};
    while (children.count < BVH_WIDTH) {
        PrimitiveRange* chosen = nullptr;
        for (PrimitiveRange& range : std::span(children.ranges).first(children.count)) {
            if (!makes_leaf(range) && (!chosen || priority(*chosen) < priority(range))) chosen = &range;
        }
        if (!chosen) break;
        const auto [left, right] = balanced ? split_median(refs, *chosen) : split_sah(refs, *chosen);
        *chosen = left;
        children.ranges[children.count++] = right;
    }
    return children;
}

// The record of a node with its leaf references; those to nodes are still 0.
BvhNode make_node(const Children& children) {
    std::array<Box, BVH_WIDTH> boxes;
    for (uint32_t c = 0; c < children.count; ++c)
        boxes[c] = Box(children.ranges[c].bounds);
    BvhNode node = quantise(std::span(boxes).first(children.count));
    for (uint32_t c = 0; c < children.count; ++c) {
        const PrimitiveRange& range = children.ranges[c];
        node.child[int(c)] = makes_leaf(range) ? leaf_reference(range.first, range.count) : 0;
    }
    return node;
}

// Builds the whole subtree of `root` into `nodes`.
void build_subtree(std::span<PrimitiveRef> refs, const Job& root, std::vector<PackedBvhNode>& nodes) {
    struct Pending {
        Job job;
        uint32_t parent;
        uint32_t slot;
    };
    std::vector<Pending> stack{{root, 0, 0}};
    while (!stack.empty()) {
        const Pending next = stack.back();
        stack.pop_back();
        const Children children = open_children(refs, next.job);
        const auto index = uint32_t(nodes.size());
        if (index > 0) nodes[next.parent][3][int(next.slot)] = index;
        nodes.push_back(pack(make_node(children)));
        for (uint32_t c = children.count; c-- > 0;) {
            const PrimitiveRange& range = children.ranges[c];
            if (!makes_leaf(range)) stack.push_back({{range, next.job.depth + 1}, index, c});
        }
    }
}

// Builds what one task stands for: a subtree, or a node and the tasks of its children.
void run_task(std::span<PrimitiveRef> refs, const Task& task, TaskQueue<Task>& queue) {
    Piece& piece = *task.piece;
    if (task.job.range.count <= TASK_SIZE) {
        build_subtree(refs, task.job, piece.nodes);
        return;
    }
    const Children children = open_children(refs, task.job);
    piece.nodes.push_back(pack(make_node(children)));
    for (uint32_t c = 0; c < children.count; ++c) {
        const PrimitiveRange& range = children.ranges[c];
        if (makes_leaf(range)) continue;
        piece.children[c] = std::make_unique<Piece>();
        queue.push({{range, task.job.depth + 1}, piece.children[c].get()});
    }
}

size_t count_nodes(const Piece& piece) {
    size_t count = piece.nodes.size();
    for (const std::unique_ptr<Piece>& child : piece.children)
        count += child ? count_nodes(*child) : 0;
    return count;
}

// The nodes of all pieces, depth first, with references from node 0.
std::vector<PackedBvhNode> join_pieces(std::unique_ptr<Piece> root) {
    struct Pending {
        std::unique_ptr<Piece> piece;
        uint32_t parent;
        uint32_t slot;
    };
    std::vector<PackedBvhNode> nodes;
    nodes.reserve(count_nodes(*root));
    std::vector<Pending> stack;
    stack.push_back({std::move(root), 0, 0});
    while (!stack.empty()) {
        const Pending next = std::move(stack.back());
        stack.pop_back();
        const auto base = uint32_t(nodes.size());
        if (base > 0) nodes[next.parent][3][int(next.slot)] = base;
        for (PackedBvhNode node : next.piece->nodes) {
            for (int c = 0; c < int(BVH_WIDTH); ++c) {
                if ((node[3][c] & BVH_LEAF_BIT) == 0) node[3][c] += base;
            }
            nodes.push_back(node);
        }
        for (uint32_t c = BVH_WIDTH; c-- > 0;) {
            if (next.piece->children[c]) stack.push_back({std::move(next.piece->children[c]), base, c});
        }
    }
    return nodes;
}

std::string in_words(const Box& box) {
    std::ostringstream out;
    out << "[" << box.lo.x << " " << box.lo.y << " " << box.lo.z << "] to [" << box.hi.x << " " << box.hi.y
        << " " << box.hi.z << "]";
    return out.str();
}

// The references in the caller's order, and the range of all; throws on a box that no tree can hold.
std::vector<PrimitiveRef> make_refs(std::span<const Box> boxes, PrimitiveRange& all) {
    if (boxes.size() > BVH_FIRST_MASK) {
        throw Error("BVH: " + std::to_string(boxes.size()) +
                    " primitives, but the node record holds at most " + std::to_string(BVH_FIRST_MASK) +
                    "; simplify the meshes");
    }
    std::vector<PrimitiveRef> refs;
    refs.reserve(boxes.size());
    for (const Box& box : boxes) {
        // Comparisons with NaN are false.
        const bool valid = glm::all(glm::lessThanEqual(box.lo, box.hi)) &&
                           glm::all(glm::greaterThanEqual(box.lo, vec3(-MAX_COORDINATE))) &&
                           glm::all(glm::lessThanEqual(box.hi, vec3(MAX_COORDINATE)));
        if (!valid) {
            throw Error(
                "BVH: primitive " + std::to_string(refs.size()) + " has the box " + in_words(box) +
                "; coordinates must be numbers from -1e37 to 1e37, and none of the first above the second");
        }
        refs.push_back({box.lo, uint32_t(refs.size()), box.hi});
        all.add(refs.back());
    }
    return refs;
}

}  // namespace

Bvh build_bvh(std::span<const Box> boxes, const BvhOptions& options) {
    PrimitiveRange all;
    std::vector<PrimitiveRef> refs = make_refs(boxes, all);
    Bvh bvh;
    bvh.bounds = Box(all.bounds);
    if (boxes.empty()) {
        bvh.nodes.push_back(pack(quantise({})));
    } else {
        auto root = std::make_unique<Piece>();
        TaskQueue<Task> queue;
        queue.push({{all, 0}, root.get()});
        const unsigned threads = options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
        queue.run(std::max(threads, 1u), [&](const Task& task) { run_task(refs, task, queue); });
        bvh.nodes = join_pieces(std::move(root));
    }
    if (bvh.nodes.size() >= BVH_MAX_NODES) {
        throw Error("BVH: " + std::to_string(boxes.size()) + " primitives need " +
                    std::to_string(bvh.nodes.size()) + " nodes, but traversal can address fewer than " +
                    std::to_string(BVH_MAX_NODES) + "; simplify the meshes");
    }
    bvh.order.reserve(refs.size());
    for (const PrimitiveRef& ref : refs)
        bvh.order.push_back(ref.index);
    const BvhMeasures measures = measure(bvh.nodes, bvh.bounds);
    bvh.depth = measures.depth;
    bvh.sah_cost = measures.sah_cost;
    assert(bvh.depth <= BVH_STACK_SIZE);
    return bvh;
}

}  // namespace candela
