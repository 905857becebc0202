// See light_tree_arrays.h.
#include "gpu_scene/light_tree_arrays.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/color.h"
#include "gpu_scene/append.h"
#include "gpu_scene/beam.h"
#include "gpu_scene/punctual_lights.h"

namespace candela {
namespace {

constexpr float HALF_PI = 0.5f * PI;

// The angle with that 1 - cos.
double angle_of(double one_minus_cosine) {
    return 2.0 * std::asin(std::sqrt(std::clamp(0.5 * one_minus_cosine, 0.0, 1.0)));
}

Box around(vec3 p, vec3 reach) {
    return {p - reach, p + reach};
}

// Points and spheres have the same intensity in all directions.
LightBounds all_around(const Box& box, double strength) {
    return {.box = box, .normals = PI, .emission = HALF_PI, .strength = strength};
}

// Of a light that emits in a cone.
LightBounds bounds_in_cone(const Box& box, vec3 axis, double outer, double steepness, double strength) {
    const double inner = outer - 1.0 / steepness;
    return {.box = box,
            .axis = axis,
            .normals = float(angle_of(inner)),
            .emission = float(angle_of(outer) - angle_of(inner)),
            .strength = strength};
}

LightBounds bounds_of_spot(const LightRecord& light) {
    return bounds_in_cone(around(light.p, vec3(0.0f)), light.e1, double(light.e2.x), double(light.e2.y),
                          double(luminance(light.radiance)));
}

// From the whole of the sphere, light leaves in each direction of the cone.
LightBounds bounds_of_beam(const LightRecord& light) {
    const double radius = double(light.e1.x);
    return bounds_in_cone(around(light.p, vec3(light.e1.x)), vec3(light.e1.y, light.e1.z, light.e2.z),
                          double(light.e2.x), std::abs(double(light.e2.y)),
                          double(PI) * radius * radius * double(luminance(light.radiance)));
}

// `light` is a triangle, parallelogram or disk; `one_side` is the power over pi of one side.
LightBounds bounds_of_flat(const LightRecord& light, double one_side) {
    LightBounds bounds{.box = {},
                       .axis = vec3(normalize(cross(dvec3(light.e1), dvec3(light.e2)))),
                       .emission = std::atan2(1.0f, light.spread),
                       .two_sided = light.two_sided != 0,
                       .strength = one_side / fraction_within(light.spread)};
    if (light.kind == LIGHT_DISK) {
        bounds.box = around(light.p, sqrt(light.e1 * light.e1 + light.e2 * light.e2));
        return bounds;
    }
    bounds.box.extend(light.p);
    bounds.box.extend(light.p + light.e1);
    bounds.box.extend(light.p + light.e2);
    if (light.kind == LIGHT_PARALLELOGRAM) bounds.box.extend(light.p + light.e1 + light.e2);
    return bounds;
}

vec4 relative(const dvec4& flux, double unit) {
    return vec4(glm::clamp(flux / unit, dvec4(-1e30), dvec4(1e30)));
}

}  // namespace

LightBounds bounds_of(const LightRecord& light, double power) {
    const double one_side = light.two_sided != 0 ? 0.5 * power : power;
    switch (light.kind) {
        case LIGHT_SPHERE:
            return all_around(around(light.p, vec3(light.e1.x)), 0.25 * one_side);
        case LIGHT_POINT:
            return all_around(around(light.p, vec3(0.0f)), 0.25 * power);
        case LIGHT_SPOT:
            return bounds_of_spot(light);
        case LIGHT_BEAM:
            return bounds_of_beam(light);
        default:
            return bounds_of_flat(light, one_side);
    }
}

std::vector<LightBounds> bounds_of_placed(const PoweredLights& area, std::span<const PlacedLamp> lamps,
                                          const PoweredLights& punctual) {
    std::vector<LightBounds> placed;
    placed.reserve(area.records.size() + lamps.size() + punctual.records.size());
    const auto add = [&](const PoweredLights& lights) {
        for (size_t i = 0; i < lights.records.size(); ++i) {
            if (!is_afar(lights.records[i])) placed.push_back(bounds_of(lights.records[i], lights.powers[i]));
        }
    };
    add(area);
    for (const PlacedLamp& lamp : lamps)
        placed.push_back(lamp.bounds);
    add(punctual);
    return placed;
}

LightTreeArrays pack_light_trees(const LightTree& tree, const Lamps& lamps, uint32_t first) {
    LightTreeArrays arrays;
    uint32_t root = 0;
    const auto add_nodes = [&](const LightTree& one) {
        for (const LightTreeNode& node : one.nodes) {
            for (LightTreeChild child : node) {
                if ((child.at & LIGHT_TREE_LEAF_BIT) == 0) child.at += root;
                append(arrays.nodes, pack(child));
            }
        }
        root += uint32_t(one.nodes.size());
    };
    add_nodes(tree);
    std::vector<uint32_t> trails = tree.trails;
    if (!lamps.empty()) trails.resize(first);
    for (const auto& [shown, lamp] : lamps) {
        add_nodes(lamp.tree);
        trails.insert(trails.end(), lamp.tree.trails.begin(), lamp.tree.trails.end());
    }
    arrays.trails.resize((trails.size() + 3) / 4);
    for (size_t i = 0; i < trails.size(); ++i)
        arrays.trails[i / 4][int(i % 4)] = trails[i];
    return arrays;
}

void set_fluxes(LightGroups& groups, std::span<const LightRecord> lights, const dvec4& sky_flux,
                const LightTree& tree) {
    dvec4 suns(0.0);
    for (const LightRecord& sun : lights.subspan(groups.placed, groups.suns)) {
        const double irradiance = irradiance_across(sun);
        suns += dvec4(irradiance * dvec3(sun.e1), irradiance);
    }
    // Exact for one sun. Suns from all sides together give any normal about a quarter of their irradiance.
    suns.w = 0.25 * std::max(0.0, suns.w - length(dvec3(suns)));
    const double unit =
        tree.strength > 0.0 ? tree.strength : std::max({length(suns), length(sky_flux), 1e-300});
    groups.sun_flux = relative(suns, unit);
    groups.sky_flux = relative(sky_flux, unit);
}

LightGroups turned(LightGroups groups, float sky_rotation) {
    const float c = std::cos(sky_rotation), s = std::sin(sky_rotation);
    const vec4 f = groups.sky_flux;
    groups.sky_flux = vec4(c * f.x + s * f.z, f.y, c * f.z - s * f.x, f.w);
    return groups;
}

}  // namespace candela
