// See light_sampler_rule.h.
#include "gpu_scene/light_sampler_rule.h"

#include <algorithm>

#include "base/color.h"
#include "gpu_scene/punctual_lights.h"

namespace candela {
namespace {

constexpr size_t MAX_PLACES = 64;
// Among more lights, the tree has always paid.
constexpr size_t MAX_FEW_LIGHTS = 64;
// Measured: at 2, the tree spares 2 % of the noise of whole pictures, whose other sources remain, and its
// walks make samples 1.2 times as expensive (see the notebook).
constexpr double MIN_MOMENT = 4.0;

// The step with which at most MAX_PLACES of `count` things are visited.
size_t stride(size_t count) {
    return std::max<size_t>((count + MAX_PLACES - 1) / MAX_PLACES, 1);
}

// What a light with a place may send to another place, averaged over its normals [W/m^2], times 4.
double irradiance(const LightBounds& light, const vec3& place) {
    const glm::dvec3 from_centre(place - light.box.centroid()), reach(0.5f * light.box.extent());
    return light.strength / std::max({dot(from_centre, from_centre), dot(reach, reach), 1e-30});
}

}  // namespace

std::vector<vec3> some_places(const FlatScene& flat, const SceneTree& tree) {
    std::vector<vec3> places;
    for (size_t i = 0; i < flat.primitives.size(); i += stride(flat.primitives.size())) {
        if (flat.surfaces[i].light == NO_LIGHT) places.push_back(bounds(flat.primitives[i]).centroid());
    }
    for (size_t i = 0; i < tree.instances.size(); i += stride(tree.instances.size()))
        places.push_back(tree.instances[i].record.centre);
    return places;
}

// If a light that sends E_i is chosen with the probability p_i, the second moment of a sample is the sum of
// E_i^2 / p_i. Divided by the square of the sum of E_i, it is 1 for the best choice.
bool light_tree_pays(uint32_t count, const PoweredLights& lights, std::span<const LightBounds> placed,
                     double sky_irradiance, std::span<const vec3> places) {
    if (count < 2) return false;
    if (count > MAX_FEW_LIGHTS) return true;
    double moments = 0.0;
    for (const vec3& place : places) {
        double sum = 0.0, squares = 0.0;
        for (size_t i = 0; i < lights.records.size(); ++i) {
            double sent = sky_irradiance;
            if (i < placed.size()) {
                sent = irradiance(placed[i], place);
            } else if (is_afar(lights.records[i])) {
                sent = irradiance_across(lights.records[i]);
            }
            sum += sent;
            squares += sent * sent / double(lights.records[i].pmf);
        }
        if (sum > 0.0) moments += squares / (sum * sum);
    }
    return moments > MIN_MOMENT * double(places.size());
}

}  // namespace candela
