// See studio.h. Radiance is in W/(m^2 sr); directions are the world's, where the front of a model faces +Z.
#include "scene/studio.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "scene/catchers.h"
#include "scene/environment.h"

namespace candela {
namespace {

// A light in the shape of a cone, with soft edges.
struct RoundBox {
    dvec3 towards;    // Its middle.
    double half;      // Cosine of the angle to its edge.
    double softness;  // In cosines.
    double radiance;

    double at(dvec3 w) const {
        return radiance * glm::smoothstep(half - softness, half + softness, dot(w, towards));
    }
};

// A rectangle at distance 1, with soft edges.
struct SquareBox {
    dvec3 towards;  // Its middle.
    double half_width, half_height;
    double radiance;

    double at(dvec3 w) const {
        constexpr double SOFTNESS = 0.03;
        const double depth = dot(w, towards);
        if (depth <= 0.0) return 0.0;
        const dvec3 right = normalize(cross(towards, dvec3(0, 1, 0))), up = cross(right, towards);
        const auto within = [&](dvec3 axis, double half) {
            return 1.0 - glm::smoothstep(half - SOFTNESS, half + SOFTNESS, std::abs(dot(w, axis)) / depth);
        };
        return radiance * within(right, half_width) * within(up, half_height);
    }
};

template <class Box, size_t N>
double sum_of(const Box (&boxes)[N], dvec3 w) {
    double sum = 0.0;
    for (const Box& box : boxes)
        sum += box.at(w);
    return sum;
}

dvec3 standard_light(dvec3 w) {
    static const RoundBox boxes[] = {{normalize(dvec3(-0.6, 0.9, 0.6)), 0.85, 0.03, 2.5},
                                     {normalize(dvec3(1.0, 0.35, 0.5)), 0.9, 0.03, 0.85},
                                     {normalize(dvec3(0.2, 0.6, -1.0)), 0.93, 0.03, 1.25}};
    const double room = w.y < 0.0 ? 0.15 + 0.06 * -w.y : 0.15 + 0.15 * w.y;  // Floor; walls and ceiling.
    return dvec3(room + sum_of(boxes, w));
}

dvec3 softbox_light(dvec3 w) {
    static const SquareBox boxes[] = {{normalize(dvec3(-1.0, 0.55, 0.8)), 0.55, 0.55, 4.0},
                                      {normalize(dvec3(1.0, 0.2, 0.25)), 0.16, 0.9, 3.0},
                                      {normalize(dvec3(0.1, 1.0, -0.7)), 0.9, 0.25, 3.0}};
    return dvec3(0.05 + sum_of(boxes, w));
}

dvec3 white_light(dvec3 w) {
    static const RoundBox box[] = {
        {normalize(dvec3(-0.3, 1.0, 0.3)), 0.88, 0.06, 1.207}};  // White paper: 1.25.
    return dvec3(1.0 + sum_of(box, w));
}

// Ref: CIE S 011/E:2003, "Spatial Distribution of Daylight", the traditional overcast sky.
dvec3 overcast_light(dvec3 w) {
    constexpr double ZENITH = 0.9 * 9.0 / 7.0;  // White paper has 7/9 of it.
    return dvec3(0.97, 1.0, 1.05) * (ZENITH * (1.0 + 2.0 * std::max(w.y, 0.0)) / 3.0);
}

dvec3 sunset_light(dvec3 w) {
    static const dvec3 sun = normalize(dvec3(-1.0, 0.17, 0.55));
    static const dvec3 across = normalize(dvec3(sun.x, 0.0, sun.z));
    const dvec3 zenith(0.13, 0.21, 0.42), away(0.36, 0.33, 0.42), towards(1.1, 0.62, 0.32);
    const double near = 0.5 + 0.5 * dot(w, across), height = std::max(w.y, 0.0);
    const dvec3 horizon = mix(away, towards, near * near * near);
    const double angle = std::acos(std::clamp(dot(w, sun), -1.0, 1.0));
    constexpr double SUN_RADIUS = 0.03, EDGE = 0.01;  // [rad]
    const double disk = 1.0 - glm::smoothstep(SUN_RADIUS - EDGE, SUN_RADIUS + EDGE, angle);
    return 1.5 * (mix(zenith, horizon, std::exp(-4.0 * height)) +
                  dvec3(1.2, 0.65, 0.3) * std::exp(-angle / 0.15) + dvec3(1.0, 0.58, 0.27) * (1100.0 * disk));
}

struct Design {
    dvec3 (*light)(dvec3 towards);
    uvec2 size;
    bool visible;
    double ground;  // Reflectance of the ground; 0: none.
};

Design design_of(StudioChoice studio) {
    switch (studio) {
        case StudioChoice::softbox:
            return {softbox_light, {256, 128}, false, 0.0};
        case StudioChoice::white:
            return {white_light, {128, 64}, true, 0.8};
        case StudioChoice::overcast:
            return {overcast_light, {1, 512}, true, 0.3};  // The same in all horizontal directions.
        case StudioChoice::sunset:
            return {sunset_light, {512, 256}, true, 0.3};
        default:
            return {standard_light, {128, 64}, false, 0.0};
    }
}

dvec3 direction_of(uvec2 size, uint32_t x, uint32_t y) {
    return latitude_longitude_direction({(x + 0.5) / size.x, (y + 0.5) / size.y});
}

}  // namespace

Environment studio_environment(StudioChoice studio) {
    assert(studio != StudioChoice::automatic && studio != StudioChoice::off);
    const Design design = design_of(studio);
    Environment environment{.size = design.size, .radiance = {}, .visible = design.visible};
    for (uint32_t y = 0; y < design.size.y; ++y) {
        for (uint32_t x = 0; x < design.size.x; ++x)
            environment.radiance.emplace_back(design.light(direction_of(design.size, x, y)));
    }
    if (design.ground > 0.0) {
        const vec3 below(design.ground * paper_radiance(environment));
        const size_t texels = environment.radiance.size();
        std::fill(environment.radiance.begin() + std::ptrdiff_t(texels / 2), environment.radiance.end(),
                  below);
    }
    return environment;
}

bool is_unseen_studio(std::string_view name) {
    return name == name_of(StudioChoice::standard, STUDIO_NAMES) ||
           name == name_of(StudioChoice::softbox, STUDIO_NAMES);
}

void put_into_studio(Scene& scene, StudioChoice studio) {
    scene.environment = studio_environment(studio);
    scene.attributes.emplace_back(STUDIO_ATTRIBUTE, name_of(studio, STUDIO_NAMES));
    const Design design = design_of(studio);
    if (design.ground == 0.0) return;
    add_ground(scene, {.name = "studio ground",
                       .model = DiffuseMaterial{.reflectance = vec3(float(design.ground))}});
}

}  // namespace candela
