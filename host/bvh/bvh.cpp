// Builds the tree from the root down. A large range is a task of its own, split directly into the children of
// one node; a smaller one becomes a binary tree, which is then turned into wide nodes at the least cost. The
// pieces are joined in depth-first order. A task depends on its range alone, so the number of threads never
// changes the result.
#include "bvh/bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <functional>
#include <memory>
#include <sstream>
#include <thread>
#include <utility>

#include "base/error.h"
#include "bvh/collapse.h"
#include "bvh/measure.h"
#include "bvh/quantise.h"
#include "bvh/split.h"
#include "bvh/task_queue.h"

namespace candela {

namespace {

// Up to this size, a task builds the whole subtree of a range; for a larger one it builds a node, whose child
// nodes become tasks. Small enough for many tasks per thread, large enough that the cost of a task itself is
// negligible.
constexpr uint32_t TASK_SIZE = 8192;

// A piece of the tree, whose references count from its own first node and position. Either a whole subtree,
// or one node whose child nodes begin pieces of their own.
struct Piece {
    std::vector<PackedBvhNode> nodes;
    std::vector<uint32_t> order;
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

// The parts of a range that become the children of one node; the first `nodes` of them are nodes, the others
// leaves.
struct Children {
    std::array<PrimitiveRange, BVH_WIDTH> ranges;
    uint32_t count = 0;
    uint32_t nodes = 0;
};

bool makes_leaf(const PrimitiveRange& range) {
    return range.count == 1;
}

// Levels of nodes over `count` primitives if each splits into two equal parts.
uint32_t balanced_depth(uint32_t count) {
    return uint32_t(std::bit_width(count - 1));
}

// Whether a range at that depth must be split into equal parts. The heuristic may split off a single
// primitive every time (from boxes that grow exponentially). So if a child with all primitives except one
// might need more than the remaining levels of BVH_MAX_DEPTH, the parts must be equal. They fit, since the
// nodes above followed this rule. A binary tree may follow it level by level, since a wide node replaces at
// least one of its levels.
bool must_balance(uint32_t depth, uint32_t count) {
    return depth + 1 + balanced_depth(count - 1) >= BVH_MAX_DEPTH;
}

// Splits the range of a node, then the part that most rays would hit (the largest surface), until there are
// BVH_WIDTH parts, or all are leaves.
Children open_children(std::span<PrimitiveRef> refs, const Job& job) {
    const bool balanced = must_balance(job.depth, job.range.count);
    const auto priority = [balanced](const PrimitiveRange& range) {
        return std::make_pair(balanced ? 0.0 : half_area(Box(range.bounds)), range.count);
    };

    Children children{{job.range}, 1, 0};
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
    const auto begin = children.ranges.begin();
    const auto leaves = std::stable_partition(begin, begin + children.count, std::not_fn(makes_leaf));
    children.nodes = uint32_t(leaves - begin);
    return children;
}

// Puts a node into `piece` at `index`, and its leaves into the piece's order; its child nodes are to be
// appended to the piece.
void put_node(std::span<const PrimitiveRef> refs, const Children& children, Piece& piece, uint32_t index) {
    std::array<Box, BVH_WIDTH> boxes;
    for (uint32_t c = 0; c < children.count; ++c)
        boxes[c] = Box(children.ranges[c].bounds);
    BvhNode node = quantise(std::span(boxes).first(children.count));
    node.children = bvh_children(children.nodes, uint32_t(piece.nodes.size()), children.count,
                                 uint32_t(piece.order.size()));
    piece.nodes[index] = pack(node);
    for (uint32_t c = children.nodes; c < children.count; ++c)
        piece.order.push_back(refs[children.ranges[c].first].index);
}

// The binary tree below `root`; both arrays in the same order.
struct BinaryTree {
    std::vector<BinaryNode> nodes;
    std::vector<PrimitiveRange> ranges;
};

BinaryTree build_binary(std::span<PrimitiveRef> refs, const Job& root) {
    BinaryTree tree;
    std::vector<uint32_t> depths;
    const size_t count = 2 * size_t(root.range.count) - 1;
    tree.nodes.reserve(count);
    tree.ranges.reserve(count);
    depths.reserve(count);
    const auto add = [&](const PrimitiveRange& range, uint32_t depth) {
        tree.nodes.push_back({.area = half_area(Box(range.bounds))});
        tree.ranges.push_back(range);
        depths.push_back(depth);
    };
    add(root.range, root.depth);
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
        const PrimitiveRange range = tree.ranges[i];
        if (makes_leaf(range)) continue;
        const bool balanced = must_balance(depths[i], range.count);
        const auto [left, right] = balanced ? split_median(refs, range) : split_sah(refs, range);
        tree.nodes[i].left = uint32_t(tree.nodes.size());
        add(left, depths[i] + 1);
        add(right, depths[i] + 1);
    }
    return tree;
}

// Builds the whole subtree of `root`.
void build_subtree(std::span<PrimitiveRef> refs, const Job& root, Piece& piece) {
    BinaryTree tree = build_binary(refs, root);
    find_min_costs(tree.nodes);
    struct Pending {
        uint32_t binary;
        uint32_t index;
    };
    piece.nodes.resize(1);
    std::vector<Pending> stack{{0, 0}};
    while (!stack.empty()) {
        const Pending next = stack.back();
        stack.pop_back();
        WideChildren wide = wide_children(tree.nodes, next.binary);
        const auto begin = wide.indices.begin();
        const auto is_node = [&](uint32_t binary) { return tree.nodes[binary].left != 0; };
        const auto leaves = std::stable_partition(begin, begin + wide.count, is_node);
        Children children{{}, wide.count, uint32_t(leaves - begin)};
        for (uint32_t c = 0; c < wide.count; ++c)
            children.ranges[c] = tree.ranges[wide.indices[c]];
        put_node(refs, children, piece, next.index);
        const auto first = uint32_t(piece.nodes.size());
        piece.nodes.resize(first + children.nodes);
        for (uint32_t c = children.nodes; c-- > 0;)
            stack.push_back({wide.indices[c], first + c});
    }
}
// Runs one task: builds a subtree, or a node and the tasks of its children.
void run_task(std::span<PrimitiveRef> refs, const Task& task, TaskQueue<Task>& queue) {
    Piece& piece = *task.piece;
    if (task.job.range.count <= TASK_SIZE) {
        build_subtree(refs, task.job, piece);
        return;
    }
    const Children children = open_children(refs, task.job);
    piece.nodes.resize(1);
    put_node(refs, children, piece, 0);
    for (uint32_t c = 0; c < children.nodes; ++c) {
        piece.children[c] = std::make_unique<Piece>();
        queue.push({{children.ranges[c], task.job.depth + 1}, piece.children[c].get()});
    }
}

size_t count_nodes(const Piece& piece) {
    size_t count = piece.nodes.size();
    for (const std::unique_ptr<Piece>& child : piece.children)
        count += child ? count_nodes(*child) : 0;
    return count;
}

// Joins all pieces into nodes and order, and makes their references count from there. The first node of a
// piece goes beside its siblings, the others behind everything joined before.
void join_pieces(std::unique_ptr<Piece> root, Bvh& bvh) {
    struct Pending {
        std::unique_ptr<Piece> piece;
        uint32_t index;
    };
    bvh.nodes.reserve(count_nodes(*root));
    bvh.nodes.resize(1);
    std::vector<Pending> stack;
    stack.push_back({std::move(root), 0});
    while (!stack.empty()) {
        const Pending next = std::move(stack.back());
        stack.pop_back();
        Piece& piece = *next.piece;
        const auto nodes_before = uint32_t(bvh.nodes.size()), order_before = uint32_t(bvh.order.size());
        for (PackedBvhNode& packed : piece.nodes) {
            BvhNode node = unpack(packed);
            node.children += uvec2(nodes_before - 1, order_before);
            packed = pack(node);
        }
        bvh.nodes[next.index] = piece.nodes.front();
        bvh.nodes.insert(bvh.nodes.end(), piece.nodes.begin() + 1, piece.nodes.end());
        bvh.order.insert(bvh.order.end(), piece.order.begin(), piece.order.end());
        const auto siblings =
            uint32_t(std::ranges::count_if(piece.children, [](auto& c) { return bool(c); }));
        bvh.nodes.resize(bvh.nodes.size() + siblings);
        for (uint32_t c = siblings; c-- > 0;)
            stack.push_back({std::move(piece.children[c]), nodes_before + c});
    }
}

std::string in_words(const Box& box) {
    std::ostringstream out;
    out << "[" << box.lo.x << " " << box.lo.y << " " << box.lo.z << "] to [" << box.hi.x << " " << box.hi.y
        << " " << box.hi.z << "]";
    return out.str();
}

// The references in the caller's order, and the range of all; throws on a box that no tree can hold.
std::vector<PrimitiveRef> make_refs(std::span<const Box> boxes, PrimitiveRange& all) {
    if (boxes.size() > BVH_MAX_PRIMITIVES) {
        throw Error("BVH: " + std::to_string(boxes.size()) +
                    " primitives, but the node record holds at most " + std::to_string(BVH_MAX_PRIMITIVES) +
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
                "; coordinates must be numbers from -1e37 to 1e37, and no lower one above its upper one");
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
        BvhNode node = quantise({});
        node.children = bvh_children(0, 0, 1, 0);
        bvh.nodes.push_back(pack(node));
    } else {
        auto root = std::make_unique<Piece>();
        TaskQueue<Task> queue;
        queue.push({{all, 0}, root.get()});
        const unsigned threads = options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
        queue.run(std::max(threads, 1u), [&](const Task& task) { run_task(refs, task, queue); });
        bvh.order.reserve(refs.size());
        join_pieces(std::move(root), bvh);
    }
    if (bvh.nodes.size() >= BVH_MAX_NODES) {
        throw Error("BVH: " + std::to_string(boxes.size()) + " primitives need " +
                    std::to_string(bvh.nodes.size()) + " nodes, but traversal can address fewer than " +
                    std::to_string(BVH_MAX_NODES) + "; simplify the meshes");
    }
    const BvhMeasures measures = measure(bvh.nodes, bvh.bounds);
    bvh.depth = measures.depth;
    bvh.sah_cost = measures.sah_cost;
    assert(bvh.depth <= BVH_MAX_DEPTH);
    return bvh;
}

}  // namespace candela
