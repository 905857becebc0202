// See ways.h.
#include "load/gltf/ways.h"

#include <algorithm>
#include <set>
#include <string>

#include "load/gltf/accessor.h"
#include "load/gltf/far_points.h"
#include "load/gltf/primitive_triangles.h"
#include "load/gltf/skin.h"
#include "load/gltf/vertex_data.h"

namespace candela::gltf {
namespace {

// The box of the places that morph targets can give a vertex.
struct Range {
    dvec3 lo, hi;
};

void add_corners(FarPoints& points, const Range& range) {
    for (int i = 0; i < (range.lo == range.hi ? 1 : 8); ++i)
        points.add({i & 1 ? range.hi.x : range.lo.x, i & 2 ? range.hi.y : range.lo.y,
                    i & 4 ? range.hi.z : range.lo.z});
}

// The positions of the vertices `rows`; none if the accessor has others.
std::vector<dvec3> positions_of(const Accessor& accessor, const std::vector<uint32_t>& rows,
                                uint32_t vertices) {
    std::vector<dvec3> positions;
    if (accessor.count() != vertices) return positions;
    const std::vector<float> numbers = accessor.floats(rows);
    for (size_t i = 0; i < numbers.size(); i += 3)
        positions.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return positions;
}

std::vector<Range> ranges_of(File& file, const Node& primitive, const WeightRanges& weights,
                             const std::vector<uint32_t>& rows, uint32_t vertices) {
    std::vector<Range> ranges;
    const Node position = primitive.require("attributes").require("POSITION");
    const Accessor accessor = vertex_accessor(file, primitive, position, {"VEC3"});
    for (const dvec3 p : positions_of(accessor, rows, vertices))
        ranges.push_back({p, p});
    const auto targets = primitive.find("targets");
    for (size_t t = 0; targets && t < std::min(targets->size(), weights.size()); ++t) {
        const auto moved = (*targets)[t].find("POSITION");
        if (!moved) continue;
        const std::vector<dvec3> moves = positions_of(Accessor(file, *moved, {"VEC3"}), rows, vertices);
        for (size_t i = 0; i < moves.size(); ++i) {
            const dvec3 a = weights[t].first * moves[i], b = weights[t].second * moves[i];
            ranges[i].lo += min(a, b);
            ranges[i].hi += max(a, b);
        }
    }
    return ranges;
}

// For each joint, the vertices that follow it.
std::vector<FarPoints> points_of_joints(File& file, const Node& primitive, const std::vector<Range>& ranges,
                                        const std::vector<uint32_t>& rows, size_t joints) {
    const Node attributes = primitive.require("attributes");
    std::vector<FarPoints> points(joints);
    std::vector<bool> is_free(rows.size(), true);
    for (int set = 0;; ++set) {
        const auto joint_reference = attributes.find("JOINTS_" + std::to_string(set));
        const auto weight_reference = attributes.find("WEIGHTS_" + std::to_string(set));
        if (!joint_reference || !weight_reference) break;
        const std::vector<uint32_t> joint =
            vertex_accessor(file, primitive, *joint_reference, {"VEC4"}).integers();
        const std::vector<float> weight =
            vertex_accessor(file, primitive, *weight_reference, {"VEC4"}).floats();
        for (size_t i = 0; i < rows.size(); ++i) {
            for (size_t k = 4 * size_t(rows[i]); k < 4 * (size_t(rows[i]) + 1); ++k) {
                if (k >= joint.size() || k >= weight.size() || !(weight[k] > 0.0f) || joint[k] >= joints)
                    continue;
                add_corners(points[joint[k]], ranges[i]);
                is_free[i] = false;
            }
        }
    }
    for (size_t i = 0; i < rows.size(); ++i) {
        if (is_free[i]) add_corners(points[0], ranges[i]);
    }
    return points;
}

}  // namespace

void add_clouds(File& file, const Node& primitive, const WeightRanges& weights,
                const std::optional<Node>& skin, uint32_t carrier, std::vector<Cloud>& clouds) {
    const Node position = primitive.require("attributes").require("POSITION");
    const uint32_t vertices = vertex_accessor(file, primitive, position, {"VEC3"}).count();
    std::vector<uvec3> triangles = read_triangles(file, primitive, mode_of(primitive), vertices);
    const std::vector<uint32_t> rows = keep_used(triangles, vertices);
    const std::vector<Range> ranges = ranges_of(file, primitive, weights, rows, vertices);
    if (!skin) {
        FarPoints points;
        for (const Range& range : ranges)
            add_corners(points, range);
        clouds.push_back({carrier, carrier, points.points()});
        return;
    }
    // Where all nodes are at the origin, only the inverse matrices of the bind pose remain.
    const std::vector<PosedNode> at_origin(file.count("nodes"));
    const std::vector<glm::dmat4> to_joints = joint_matrices(file, *skin, at_origin);
    const std::vector<Node> joints = skin->require("joints").elements();
    const std::vector<FarPoints> points = points_of_joints(file, primitive, ranges, rows, to_joints.size());
    for (size_t i = 0; i < points.size(); ++i) {
        Cloud cloud{file.index("nodes", joints[i]), carrier, points[i].points()};
        for (dvec3& p : cloud.points)
            p = dvec3(to_joints[i] * glm::dvec4(p, 1.0));
        if (!cloud.points.empty()) clouds.push_back(std::move(cloud));
    }
}

std::vector<double> times_of(const Animation& animation, size_t most) {
    constexpr size_t MOST_STEPS = 16;  // From one key to the next; of half a turn, each is 11 degrees.
    std::set<const float*> known;
    std::vector<double> keys;
    for (const Channel& channel : animation.channels()) {
        const auto& times = channel.sampler.times;
        if (known.insert(times.data()).second) keys.insert(keys.end(), times.begin(), times.end());
    }
    std::ranges::sort(keys);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    if (keys.empty()) return keys;
    const size_t stride = (keys.size() + most - 1) / most;
    const size_t steps = std::clamp(most / keys.size(), size_t(1), MOST_STEPS);
    std::vector<double> times;
    for (size_t i = 0; i + 1 < keys.size(); i += stride) {
        for (size_t k = 0; k < steps; ++k)
            times.push_back(keys[i] + (keys[i + 1] - keys[i]) * double(k) / double(steps));
    }
    times.push_back(keys.back());
    return times;
}

}  // namespace candela::gltf
