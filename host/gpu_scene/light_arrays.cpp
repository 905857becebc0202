// See light_arrays.h.
#include "gpu_scene/light_arrays.h"

#include <algorithm>
#include <numeric>

#include "gpu_scene/alias_table.h"
#include "gpu_scene/append.h"
#include "gpu_scene/light_groups.h"
#include "gpu_scene/light_sampler_rule.h"
#include "shared/principled.h"
#include "shared/texture.h"

namespace candela {
namespace {

// The power of the sky as a light: what falls onto the scene, as if onto a disk as wide as the sphere around
// its box; but no more than that of all other lights together, so that these get at least half of the
// samples: a large floor receives much light from the sky and yet is no brighter for it, and half as many
// samples as needed cost less than a tenth as many. Ref: Pharr, Jakob and Humphreys 2023, Physically Based
// Rendering, section 12.5.
//
// It is 0 for an even sky: BSDF samples find it as well as light samples would, and those are better spent on
// the lamps.
double power_of(const SkyLight& sky, const Box& box, std::span<const double> others) {
    if (sky.even) return 0.0;
    const double radius = box.is_empty() ? 0.0 : 0.5 * length(glm::dvec3(box.extent()));
    const double power = radius * radius * sky.irradiance;
    return others.empty() ? power : std::min(power, std::accumulate(others.begin(), others.end(), 0.0));
}

// The factor of a broad BSDF's density in the MIS weights of sky samples: less than 1 if light samples are
// the better strategy there. On a diffuse surface, averaged over its orientations, the second moment of light
// samples, which choose the sky with the probability pmf, is 1 / (6 pi^2 pmf) times the squared irradiance of
// a sphere, and that of BSDF samples contrast / (16 pi^2) times it. So the former are ahead if contrast * pmf
// is above 8/3; the power and the bound are measured (see the notebook), since random numbers in order favour
// light samples further.
float sky_rival(const SkyLight& sky, double pmf) {
    const double ratio = 8.0 / 3.0 / (sky.contrast * pmf);
    return float(std::clamp(ratio * ratio * ratio, 0.2, 1.0));
}

void append_lights(PoweredLights& all, const PoweredLights& lights) {
    all.records.insert(all.records.end(), lights.records.begin(), lights.records.end());
    all.powers.insert(all.powers.end(), lights.powers.begin(), lights.powers.end());
}

}  // namespace

LightArrays build_light_arrays(const AreaLights& area, const PoweredLights& punctual, const LightTree& tree,
                               const std::optional<SkyLight>& sky, const Box& box,
                               std::span<const vec3> places) {
    LightArrays result;
    PoweredLights all = area.lights;
    append_lights(all, punctual);
    if (const double power = sky ? power_of(*sky, box, all.powers) : 0.0; power > 0.0) {
        LightRecord record{};
        record.kind = LIGHT_ENVIRONMENT;
        result.sky_is_light = true;
        append_lights(all, {{record}, {power}});
    }
    result.facts.light_groups = group_lights(all);
    if (result.sky_is_light) result.facts.sky_rival = sky_rival(*sky, double(all.records.back().pmf));
    result.facts.light_count = uint32_t(all.records.size());
    result.facts.light_tree_pays = light_tree_pays(all, sky ? sky->irradiance : 0.0, places);
    if (result.facts.light_count > 1) {
        result.tree = pack_light_tree(tree);
        set_fluxes(result.facts.light_groups, all.records, result.sky_is_light ? sky->flux : dvec4(0.0),
                   tree);
    }
    result.lights.reserve(all.records.size() * LIGHT_WORDS);
    for (const LightRecord& light : all.records) {
        append(result.lights, pack(light));
        result.facts.lights_present |= 1u << light.kind;
    }
    result.alias = pack_pairs<AliasEntry>(light_alias_tables(result.facts.light_groups, all.powers));
    return result;
}

LightSampler chosen_light_sampler(LightSampler requested, const LightFacts& lights) {
    if (lights.light_count < 2) return LightSampler::power;
    if (requested != LightSampler::automatic) return requested;
    return lights.light_tree_pays ? LightSampler::tree : LightSampler::power;
}

std::vector<uvec4> light_textures(const Scene& scene, const MaterialArrays& materials, const FlatScene& flat,
                                  const AreaLights& area, std::span<const uint32_t> order) {
    std::vector<uvec4> words;
    if ((materials.facts.textured & (TEXTURED_EMISSION | TEXTURED_OPACITY)) == 0 &&
        (materials.facts.principled & PRINCIPLED_HAS_COATED_EMISSION) == 0)
        return words;
    std::vector<uint32_t> places(order.size());
    for (uint32_t i = 0; i < order.size(); ++i)
        places[order[i]] = i;
    for (const uint32_t i : area.pieces) {
        const EmittingPiece& piece = flat.pieces[i];
        append(words, pack(LightTextures{.primitive = places[piece.primitive],
                                         .emission = materials.emission_textures[piece.shape],
                                         .material = scene.shapes[piece.shape].material}));
    }
    return words;
}

}  // namespace candela
