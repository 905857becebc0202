// The tree is built from the root down: the nodes above large ranges of lights first, then the trees of
// smaller ranges in parallel. The tree of a range depends on the range alone, so the number of threads never
// changes the result.
#include "gpu_scene/light_tree.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <thread>

#include "base/threads.h"
#include "gpu_scene/light_split.h"

namespace candela {
namespace {

constexpr uint32_t WIDTH = LIGHT_TREE_WIDTH;
constexpr uint32_t LARGE = 4096;  // A smaller range has at most this many lights.
// Multiplied by other factors, a lower one could give denormal floats.
constexpr double MIN_STRENGTH = 1e-30;
// Bounds the error of a cosine, and the relative error of a length, of floats.
constexpr double BOUNDS_ROUNDING = 4e-7;

// A node to build, `depth` nodes below the root.
struct Job {
    LightRange range;
    uint32_t depth = 0;
    uint32_t trail = 0;
};

// Nodes, whose indices of each other count from the first of them.
struct Piece {
    struct Child {
        Job job;
        uint32_t node;  // The parent's index,
        uint32_t slot;  // and which of its children this is.
    };
    std::vector<LightTreeNode> nodes;
    std::vector<Child> left;  // Children whose trees are other pieces.
};

struct Parts {
    std::array<LightRange, WIDTH> ranges;
    uint32_t count = 1;
};

// Levels of nodes over `count` lights if each splits into equal parts.
uint32_t balanced_depth(uint32_t count) {
    return (uint32_t(std::bit_width(count - 1)) + 1) / 2;
}

// Splits the range of a node, then the part with the highest cost, until there are WIDTH parts or each is one
// light. The parts are equal where a child with all lights but three might need more levels than are left.
Parts open(std::span<LightRef> lights, const Job& job) {
    const bool balanced = job.depth + 1 + balanced_depth(job.range.count) > LIGHT_TREE_MAX_DEPTH;
    const auto priority = [balanced](const LightRange& range) {
        return std::pair(balanced ? 0.0f : light_cost(range), range.count);
    };
    Parts parts{{job.range}, 1};
    while (parts.count < WIDTH) {
        const auto max = std::max_element(parts.ranges.begin(), parts.ranges.begin() + parts.count,
                                          [&](const LightRange& a, const LightRange& b) {
                                              return std::pair(a.count > 1, priority(a)) <
                                                     std::pair(b.count > 1, priority(b));
                                          });
        if (max->count == 1) break;
        const auto [left, right] =
            balanced ? split_lights_at_median(lights, *max) : split_lights(lights, *max);
        *max = left;
        parts.ranges[parts.count++] = right;
    }
    return parts;
}

// An axis as in a node's word.
struct Axis {
    uint32_t word = 0;
    vec3 unit;  // Its direction.

    explicit Axis(const vec3& axis) {
        const glm::ivec3 steps(glm::round(axis * LIGHT_TREE_AXIS));
        for (int i = 0; i < 3; ++i)
            word |= (uint32_t(steps[i]) & 0x3FFu) << 10 * i;
        unit = normalize(vec3(steps));
    }
};

// At least the sine of half the angle, in the unit of a cone's word.
uint32_t half_sine(double angle) {
    const double sine = std::sin(0.5 * std::min(angle, double(PI)));
    return std::min(uint32_t(std::ceil(sine * LIGHT_TREE_SINE)), LIGHT_TREE_SINE);
}

// An upper bound on the angle with that cosine, which is rounded.
double max_angle(float cosine) {
    return std::acos(std::max(double(cosine) - BOUNDS_ROUNDING, -1.0));
}

// Writes the bounds of the lights of a range.
void put_child(std::span<const LightRef> lights, const LightRange& range, LightTreeChild& child) {
    const Box box(range.bounds);
    const vec3 centre = box.centroid();
    const vec3 sum(range.sums[0], range.sums[1], range.sums[2]);
    const float sum_length = length(sum);
    const Axis axis(sum_length > 0.0f ? sum / sum_length : vec3(0, 0, 1));
    child.axis = axis.word;
    float min_cosine = 1.0f, emission = 0.0f;
    double radius2 = 0.0, normals = sum_length > 0.0f ? 0.0 : double(PI), strength = 0.0;
    uint32_t two_sided = 0;
    for (const LightRef& light : lights.subspan(range.first, range.count)) {
        const dvec3 reach(glm::max(light.hi - centre, centre - light.lo));
        radius2 = std::max(radius2, dot(reach, reach));
        const float cosine = dot(axis.unit, light.axis);
        if (light.normals == 0.0f) {
            min_cosine = std::min(min_cosine, cosine);
        } else {
            normals = std::max(normals, max_angle(cosine) + double(light.normals));
        }
        emission = std::max(emission, light.emission);
        two_sided |= light.two_sided;
        strength += double(light.strength);
    }
    normals = std::max(normals, max_angle(min_cosine));
    child.centre = centre;
    child.radius = float(std::sqrt(radius2) * (1.0 + BOUNDS_ROUNDING));
    child.strength = float(strength);
    child.cone = half_sine(normals) | half_sine(double(emission)) << LIGHT_TREE_EMISSION_SHIFT |
                 two_sided * LIGHT_TREE_BOTH_SIDES;
}

// Builds the node of `root` and those below it, except nodes over at most `small` lights.
Piece build_piece(std::span<LightRef> lights, const Job& root, uint32_t small, std::span<uint32_t> trails) {
    struct Pending {
        Job job;
        uint32_t node;
    };
    Piece piece;
    piece.nodes.emplace_back();
    std::vector<Pending> stack{{root, 0}};
    while (!stack.empty()) {
        const auto [job, index] = stack.back();
        stack.pop_back();
        const Parts parts = open(lights, job);
        LightTreeNode node{};
        for (LightTreeChild& child : node)
            child.at = LIGHT_TREE_LEAF_BIT;
        for (uint32_t c = 0; c < parts.count; ++c) {
            const LightRange& range = parts.ranges[c];
            put_child(lights, range, node[c]);
            const Job child{range, job.depth + 1, job.trail | c << 2 * job.depth};
            if (range.count == 1) {
                const uint32_t light = lights[range.first].index;
                node[c].at = LIGHT_TREE_LEAF_BIT | light;
                trails[light] = child.trail;
            } else if (range.count <= small) {
                piece.left.push_back({child, index, c});
            } else {
                node[c].at = uint32_t(piece.nodes.size());
                stack.push_back({child, node[c].at});
                piece.nodes.emplace_back();
            }
        }
        piece.nodes[index] = node;
    }
    return piece;
}

// Appends a piece's nodes; their indices of each other count from the first of `nodes` then.
void append_piece(std::vector<LightTreeNode>& nodes, const Piece& piece) {
    const auto first = uint32_t(nodes.size());
    for (LightTreeNode node : piece.nodes) {
        for (LightTreeChild& child : node) {
            if ((child.at & LIGHT_TREE_LEAF_BIT) == 0) child.at += first;
        }
        nodes.push_back(node);
    }
}

std::vector<LightRef> make_refs(std::span<const LightBounds> lights, double strength, LightRange& all) {
    std::vector<LightRef> refs;
    refs.reserve(lights.size());
    for (const LightBounds& light : lights) {
        assert(!light.box.is_empty() && light.strength > 0.0);
        const bool all_around = light.normals >= PI;
        refs.push_back({.lo = light.box.lo,
                        .index = uint32_t(refs.size()),
                        .hi = light.box.hi,
                        .two_sided = light.two_sided,
                        .axis = all_around ? vec3(0.0f) : light.axis,
                        .strength = float(std::max(light.strength / strength, MIN_STRENGTH)),
                        .normals = light.normals,
                        .emission = light.emission});
        all.add(refs.back());
    }
    return refs;
}

}  // namespace

LightTree build_light_tree(std::span<const LightBounds> lights, unsigned threads) {
    LightTree tree;
    if (lights.empty()) return tree;
    for (const LightBounds& light : lights)
        tree.strength += light.strength;
    LightRange all;
    std::vector<LightRef> refs = make_refs(lights, tree.strength, all);
    tree.trails.resize(lights.size());
    Piece top = build_piece(refs, {all}, LARGE, tree.trails);

    std::vector<Piece> pieces(top.left.size());
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        for (size_t i = next++; i < pieces.size(); i = next++)
            pieces[i] = build_piece(refs, top.left[i].job, 1, tree.trails);
    };
    const unsigned hardware = std::max(std::thread::hardware_concurrency(), 1u);
    const size_t helpers = std::min<size_t>(threads > 0 ? threads : hardware, pieces.size() + 1) - 1;
    {
        const auto running = start_helpers(helpers, work);
        work();
    }
    auto first = uint32_t(top.nodes.size());
    for (size_t i = 0; i < pieces.size(); ++i) {
        top.nodes[top.left[i].node][top.left[i].slot].at = first;
        first += uint32_t(pieces[i].nodes.size());
    }
    tree.nodes.reserve(first);
    append_piece(tree.nodes, top);
    for (const Piece& piece : pieces)
        append_piece(tree.nodes, piece);
    return tree;
}

}  // namespace candela
