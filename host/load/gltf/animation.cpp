// Ref: Khronos, "glTF 2.0 Specification", section 3.11 and appendix C.
#include "load/gltf/animation.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "base/error.h"
#include "base/text.h"
#include "load/gltf/accessor.h"
#include "load/gltf/names.h"
#include "load/gltf/values.h"
#include "load/quote.h"

namespace candela::gltf {
namespace {

Interpolation read_interpolation(const Node& sampler) {
    constexpr std::array<std::pair<std::string_view, Interpolation>, 3> NAMES{
        {{"LINEAR", Interpolation::linear},
         {"STEP", Interpolation::step},
         {"CUBICSPLINE", Interpolation::cubic}}};
    const auto node = sampler.find("interpolation");
    return node ? node->choice(NAMES) : Interpolation::linear;
}

// Notes the first key of a rotation that is not a unit quaternion. Quaternions of integers have a length of
// about 1.
void check_rotations(File& file, const Node& output, const Sampler& sampler) {
    for (size_t key = 0; key < sampler.times.size(); ++key) {
        const float* q = sampler.value(key);
        const double size = length(glm::dvec4(q[0], q[1], q[2], q[3]));
        if (std::abs(size - 1.0) <= ROTATION_TOLERANCE) continue;
        file.warn(output, concat("the rotation of key ", key,
                                 " is a quaternion whose length is not 1; all are normalised"));
        return;
    }
}

// `width`: numbers per key, of a SCALAR, VEC3 or VEC4; 0: as many scalars per key as there are.
Sampler read_sampler(File& file, const Node& node, size_t width) {
    Sampler sampler;
    sampler.interpolation = read_interpolation(node);
    const Node input = node.require("input");
    sampler.times = Accessor(file, input, {"SCALAR"}).kept_floats(file);
    for (size_t i = 0; i < sampler.times.size(); ++i) {
        if (!std::isfinite(sampler.times[i]) || (i > 0 && sampler.times[i] <= sampler.times[i - 1]))
            input.fail(concat("the times of an animation must grow, but that of key ", i, " does not"));
    }
    const Node output = node.require("output");
    const char* const type = width < 3 ? "SCALAR" : width == 3 ? "VEC3" : "VEC4";
    sampler.values = Accessor(file, output, {type}).kept_floats(file);
    const size_t keys = sampler.times.size() * (sampler.interpolation == Interpolation::cubic ? 3 : 1);
    sampler.width = width == 0 ? sampler.values.size() / keys : width;
    if (sampler.width == 0 || sampler.values.size() != keys * sampler.width) {
        output.fail(concat("there are ", sampler.values.size(), " numbers for ", sampler.times.size(),
                           " keys; is the file damaged?"));
    }
    if (!std::ranges::all_of(sampler.values, [](float v) { return std::isfinite(v); }))
        output.fail("a value of the animation is not finite; export it again");
    if (width == 4) check_rotations(file, output, sampler);
    return sampler;
}

// The value of a cubic Hermite spline between two keys, at t in [0, 1]; `step` is their distance [s].
double spline(double v0, double out0, double in1, double v1, double step, double t) {
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * v0 + step * (t3 - 2 * t2 + t) * out0 + (3 * t2 - 2 * t3) * v1 +
           step * (t3 - t2) * in1;
}

std::vector<double> sample(const Sampler& s, float time, bool is_rotation) {
    const auto after = std::upper_bound(s.times.begin(), s.times.end(), time);
    const auto key = size_t(after - s.times.begin());
    const auto at = [&](size_t k) { return std::vector<double>(s.value(k), s.value(k) + s.width); };
    if (key == 0) return at(0);
    if (key == s.times.size() || s.interpolation == Interpolation::step) return at(key - 1);
    const double step = double(s.times[key]) - double(s.times[key - 1]);
    const double t = (double(time) - double(s.times[key - 1])) / step;
    std::vector<double> result(s.width);
    if (s.interpolation == Interpolation::linear && is_rotation) {
        const float* a = s.value(key - 1);
        const float* b = s.value(key);
        const glm::dquat q = glm::slerp(normalize(glm::dquat(a[3], a[0], a[1], a[2])),
                                        normalize(glm::dquat(b[3], b[0], b[1], b[2])), t);
        return {q.x, q.y, q.z, q.w};
    }
    for (size_t i = 0; i < s.width; ++i) {
        const double v0 = s.value(key - 1)[i], v1 = s.value(key)[i];
        result[i] = s.interpolation == Interpolation::linear
                        ? v0 + t * (v1 - v0)
                        : spline(v0, s.out_tangent(key - 1)[i], s.in_tangent(key)[i], v1, step, t);
    }
    return result;
}

// The node whose visibility a pointer names, as the specification writes it; nothing for another pointer.
std::optional<uint32_t> node_of_pointer(const File& file, const Node& target) {
    constexpr std::string_view BEFORE = "/nodes/", AFTER = "/extensions/KHR_node_visibility/visible";
    const auto extension = extension_of(target, "KHR_animation_pointer");
    const auto pointer = extension ? extension->find("pointer") : std::nullopt;
    if (!pointer) return std::nullopt;
    const std::string_view text = pointer->string();
    if (!text.starts_with(BEFORE) || !text.ends_with(AFTER) || text.size() < BEFORE.size() + AFTER.size())
        return std::nullopt;
    const std::string_view digits = text.substr(BEFORE.size(), text.size() - BEFORE.size() - AFTER.size());
    uint32_t node = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), node);
    if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    if (node >= file.count("nodes"))
        pointer->fail(concat("there are only ", file.count("nodes"), " nodes; export the file again"));
    return node;
}

constexpr std::array<std::pair<std::string_view, Path>, 4> PATHS{{{"translation", Path::translation},
                                                                  {"rotation", Path::rotation},
                                                                  {"scale", Path::scale},
                                                                  {"weights", Path::weights}}};

size_t width_of(Path path) {
    switch (path) {
        case Path::rotation:
            return 4;
        case Path::weights:
            return 0;
        case Path::visible:
            return 1;
        default:
            return 3;
    }
}

// Notes channels of an animation with the same target: the last one is used.
void check_targets(File& file, const std::vector<Node>& channels) {
    std::map<std::pair<uint32_t, std::string>, size_t> known;
    for (size_t i = 0; i < channels.size(); ++i) {
        const Node target = channels[i].require("target");
        const auto node = target.find("node");
        if (!node) continue;
        const auto [first, is_new] =
            known.try_emplace({file.index("nodes", *node), target.require("path").string()}, i);
        if (is_new) continue;
        file.warn(channels[first->second].require("target"),
                  concat("channel ", i, " has the same target, and replaces this one"));
        first->second = i;
    }
}

}  // namespace

Animation::Animation(File& file, const std::optional<std::string>& name,
                     const std::vector<PosedNode>& nodes) {
    const size_t count = file.count("animations");
    std::vector<size_t> chosen;
    if (name && *name == "all") {
        for (size_t i = 0; i < count; ++i)
            chosen.push_back(i);
    } else if (name) {
        chosen.push_back(
            find_by_name(file, file.root().find("animations"), *name, "animations", "--animation"));
    } else if (count > 0) {
        chosen.push_back(0);
    }
    if (count > 1 && !name) {
        file.warn(file.path().string() + ": posed by the first animation, " +
                  quote(name_of(file.element("animations", 0), "0")) + ", of " + std::to_string(count) +
                  "; choose by --animation NAME, or all");
    }
    for (const size_t i : chosen) {
        const Node animation = file.element("animations", i);
        const std::vector<Node> channels = animation.require("channels").elements();
        check_targets(file, channels);
        for (const Node& channel : channels)
            read_channel(file, animation, channel, nodes);
    }
}

void Animation::read_channel(File& file, const Node& animation, const Node& channel,
                             const std::vector<PosedNode>& nodes) {
    const Node target = channel.require("target");
    Channel read;
    if (const auto reference = target.find("node")) {
        read.node = file.index("nodes", *reference);
        const Node path = target.require("path");
        const auto known =
            std::ranges::find(PATHS, std::string_view(path.string()), &decltype(PATHS)::value_type::first);
        if (known == PATHS.end()) {
            file.warn(path, "ignored the unknown path " + quote(path.string()));
            return;
        }
        read.path = known->second;
    } else if (const auto pointed = node_of_pointer(file, target)) {
        read.node = *pointed;
        read.path = Path::visible;
    } else {
        if (extension_of(target, "KHR_animation_pointer")) {
            file.warn(target,
                      "ignored the targets of KHR_animation_pointer: only nodes and weights are animated");
        }
        return;
    }
    const Node samplers = animation.require("samplers");
    const Node number = channel.require("sampler");
    const uint32_t i = number.integer(0, UINT32_MAX);
    if (i >= samplers.size()) number.fail(concat("the animation has only ", samplers.size(), " samplers"));
    read.sampler = read_sampler(file, samplers[i], width_of(read.path));
    Interpolation& interpolation = read.sampler.interpolation;
    if (read.path == Path::visible && interpolation != Interpolation::step) {
        constexpr const char* ONLY_STEP =
            "a node is either visible or not, so the interpolation must be STEP";
        if (interpolation == Interpolation::cubic)
            samplers[i].fail(concat(ONLY_STEP, "; export the file again"));
        file.warn(samplers[i], concat(ONLY_STEP, ", and is read as if it were"));
        interpolation = Interpolation::step;
    }
    if (nodes[read.node].matrix && read.path != Path::weights && read.path != Path::visible)
        file.warn(channel, "the node has a matrix, which cannot be animated; the animation replaces it");
    channels_.push_back(read);
}

void Animation::pose(double time, std::vector<PosedNode>& nodes) const {
    // Rounded as the times of keys are, so that the time of a key selects exactly that key.
    const auto moment = float(std::clamp(time, -double(FLOAT_MAX), double(FLOAT_MAX)));
    for (const Channel& channel : channels_) {
        PosedNode& node = nodes[channel.node];
        const std::vector<double> v = sample(channel.sampler, moment, channel.path == Path::rotation);
        if (channel.path != Path::weights && channel.path != Path::visible) node.matrix.reset();
        if (channel.path == Path::translation) node.trs.translation = {v[0], v[1], v[2]};
        if (channel.path == Path::scale) node.trs.scale = {v[0], v[1], v[2]};
        if (channel.path == Path::weights) node.weights = v;
        if (channel.path == Path::visible) node.is_visible = v[0] != 0.0;
        if (channel.path == Path::rotation) {
            const glm::dquat q(v[3], v[0], v[1], v[2]);
            if (length(q) > 0.0) node.trs.rotation = normalize(q);
        }
    }
}

}  // namespace candela::gltf
