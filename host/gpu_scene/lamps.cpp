// See lamps.h.
#include "gpu_scene/lamps.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gpu_scene/light_tree_arrays.h"

namespace candela {
namespace {

LightBounds bounds_around(const std::vector<LightBounds>& lights) {
    LightBounds all;
    dvec3 sum(0.0);
    for (const LightBounds& light : lights) {
        sum += light.strength * dvec3(light.axis);
        all.strength += light.strength;
        all.emission = std::max(all.emission, light.emission);
        all.two_sided = all.two_sided || light.two_sided;
    }
    all.normals = PI;
    if (!(length(sum) > 0.0)) return all;
    const dvec3 axis = normalize(sum);
    double min_cosine = 1.0;
    for (const LightBounds& light : lights)
        min_cosine = std::min(min_cosine, dot(axis, dvec3(light.axis)));
    all.axis = vec3(axis);
    all.normals = float(std::acos(std::max(min_cosine, -1.0)));
    return all;
}

LampLights build_lamp(const Scene& scene, const FlatScene& flat) {
    LampLights lamp;
    lamp.area = build_area_lights(scene, flat);
    const PoweredLights& lights = lamp.area.lights;
    std::vector<LightBounds> bounds;
    for (size_t i = 0; i < lights.records.size(); ++i)
        bounds.push_back(bounds_of(lights.records[i], lights.powers[i]));
    lamp.tree = build_light_tree(bounds);
    lamp.bounds = bounds_around(bounds);
    lamp.power = std::accumulate(lights.powers.begin(), lights.powers.end(), 0.0);
    return lamp;
}

// The lights that an instance shows; null if there are none.
const LampLights* lights_of(const Lamps& lamps, const TreeInstance& instance) {
    const auto lamp = lamps.find(instance.mesh);
    return lamp == lamps.end() || lamp->second.area.pieces.empty() ? nullptr : &lamp->second;
}

PlacedLamp place(const LampLights& lamp, const TreeInstance& instance) {
    const glm::dmat3 to_mesh = map_to_mesh(instance.record);
    const double determinant = glm::determinant(to_mesh);
    const double area = std::pow(std::abs(determinant), -2.0 / 3.0);
    PlacedLamp placed{.mesh = instance.mesh, .record = {}, .bounds = lamp.bounds, .power = area * lamp.power};
    placed.record.node = instance.node;
    placed.record.mirrored = determinant < 0.0;
    placed.record.area = float(area);
    placed.bounds.box = instance.box;
    // A normal, which is a row vector; mirrored or not, it stays on its side.
    placed.bounds.axis = vec3(normalize(dvec3(lamp.bounds.axis) * to_mesh));
    placed.bounds.strength *= area;
    return placed;
}

}  // namespace

Lamps build_lamps(const Scene& scene, const MeshTrees& trees) {
    Lamps lamps;
    for (const auto& [shown, tree] : trees) {
        if (shown.emitter != NO_EMITTER) lamps.emplace(shown, build_lamp(scene, tree.flat));
    }
    return lamps;
}

std::vector<PlacedLamp> place_lamps(const Lamps& lamps, const SceneTree& tree) {
    std::vector<PlacedLamp> placed;
    for (const TreeInstance& instance : tree.instances) {
        if (const LampLights* lamp = lights_of(lamps, instance)) placed.push_back(place(*lamp, instance));
    }
    return placed;
}

void number_lamps(SceneTree& tree, const Lamps& lamps, uint32_t first) {
    for (TreeInstance& instance : tree.instances)
        instance.record.lamp = lights_of(lamps, instance) != nullptr ? first++ : 0;
}

}  // namespace candela
