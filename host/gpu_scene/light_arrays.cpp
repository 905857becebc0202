// See light_arrays.h.
#include "gpu_scene/light_arrays.h"

#include <algorithm>
#include <iterator>
#include <map>
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
double power_of(const SkyLight& sky, const Box& box, std::span<const double> others) {
    const double radius = box.is_empty() ? 0.0 : 0.5 * length(glm::dvec3(box.extent()));
    const double power = radius * radius * sky.irradiance;
    return others.empty() ? power : std::min(power, std::accumulate(others.begin(), others.end(), 0.0));
}

void append_lights(PoweredLights& all, const PoweredLights& lights) {
    all.records.insert(all.records.end(), lights.records.begin(), lights.records.end());
    all.powers.insert(all.powers.end(), lights.powers.begin(), lights.powers.end());
}

// What a light adds to the constant LIGHTS.
uint32_t bits_of(const LightRecord& light) {
    return 1u << light.kind | (light.spread > 0.0f ? 1u << LIGHT_SPREAD : 0u);
}

// The records of placed lamps, complete but for their pmf, where the table of lights and its alias tables
// have the lamps' lights from `first` and from `alias` on.
std::vector<LampRecord> lamp_records(const SceneLights& lights, uint32_t first, uint32_t alias) {
    auto root = uint32_t(lights.tree.nodes.size());
    std::map<ShownMesh, LampRecord> shared;
    for (const auto& [shown, lamp] : lights.lamps) {
        const auto count = uint32_t(lamp.area.pieces.size());
        LampRecord& record = shared[shown];
        record.root = root;
        record.first = first;
        record.count = count;
        record.alias = alias;
        root += uint32_t(lamp.tree.nodes.size());
        first += count;
        alias += count;
    }
    std::vector<LampRecord> records;
    for (const PlacedLamp& placed : lights.placed) {
        LampRecord record = shared.at(placed.mesh);
        record.node = placed.record.node;
        record.mirrored = placed.record.mirrored;
        record.area = placed.record.area;
        records.push_back(record);
    }
    return records;
}

// Appends the records of the lights of lamps.
void append_lamp_lights(LightArrays& arrays, std::vector<AliasEntry>& alias, const Lamps& lamps) {
    for (const auto& [shown, lamp] : lamps) {
        const PoweredLights& lights = lamp.area.lights;
        if (lights.records.empty()) continue;
        for (size_t i = 0; i < lights.records.size(); ++i) {
            LightRecord light = lights.records[i];
            light.pmf = float(lights.powers[i] / lamp.power);
            append(arrays.lights, pack(light));
            arrays.facts.lights_present |= bits_of(light);
        }
        std::ranges::copy(build_alias_table(lights.powers), std::back_inserter(alias));
        arrays.facts.light_count += uint32_t(lights.records.size());
    }
}

// A light and a node of the tree where there are none, for kernels that may read, though never use them.
void add_dark_records(LightArrays& arrays) {
    if (arrays.lights.empty()) append(arrays.lights, pack(LightRecord{}));
    LightTreeChild none{};
    none.at = LIGHT_TREE_LEAF_BIT;
    while (arrays.tree.nodes.size() < size_t{LIGHT_TREE_WIDTH} * LIGHT_TREE_WORDS)
        append(arrays.tree.nodes, pack(none));
    if (arrays.tree.trails.empty()) arrays.tree.trails.resize(1);
}

// Appends the textures of lights whose primitives begin at `first` in leaf order.
void append_textures(std::vector<uvec4>& words, const Scene& scene, const MaterialArrays& materials,
                     const FlatScene& flat, const AreaLights& area, std::span<const uint32_t> order,
                     uint32_t first) {
    std::vector<uint32_t> places(order.size());
    for (uint32_t i = 0; i < order.size(); ++i)
        places[order[i]] = first + i;
    for (const uint32_t i : area.pieces) {
        const EmittingPiece& piece = flat.pieces[i];
        append(words, pack(LightTextures{.primitive = places[piece.primitive],
                                         .emission = materials.emission_textures[piece.shape],
                                         .material = scene.shapes[piece.shape].material}));
    }
}

}  // namespace

LightArrays build_light_arrays(const SceneLights& lights, const Box& box, bool of_small_model) {
    LightArrays result;
    PoweredLights all = lights.area.lights;
    const size_t first_lamp = all.records.size();
    for (const PlacedLamp& lamp : lights.placed) {
        LightRecord record{};
        record.kind = LIGHT_LAMP;
        append_lights(all, {{record}, {lamp.power}});
    }
    append_lights(all, lights.punctual);
    if (const double power = lights.sky ? power_of(*lights.sky, box, all.powers) : 0.0; power > 0.0) {
        LightRecord record{};
        record.kind = LIGHT_ENVIRONMENT;
        result.sky_is_light = true;
        append_lights(all, {{record}, {power}});
    }
    LightGroups& groups = result.facts.light_groups;
    groups = group_lights(all);
    result.first_of_lamps = result.facts.light_count = uint32_t(all.records.size());
    const std::vector<LampRecord> lamps =
        lamp_records(lights, result.first_of_lamps, groups.placed + groups.suns);
    result.lights.reserve(all.records.size() * LIGHT_WORDS);
    for (size_t i = 0; i < all.records.size(); ++i) {
        const LightRecord& light = all.records[i];
        result.facts.lights_present |= bits_of(light);
        if (light.kind == LIGHT_LAMP) {
            LampRecord lamp = lamps[i - first_lamp];
            lamp.pmf = light.pmf;
            append(result.lights, pack(lamp));
        } else {
            append(result.lights, pack(light));
        }
    }
    std::vector<AliasEntry> alias = light_alias_tables(groups, all.powers);
    append_lamp_lights(result, alias, lights.lamps);
    result.alias = pack_pairs<AliasEntry>(alias);
    result.facts.light_tree_pays = light_tree_pays(result.facts.light_count, all, lights.bounds,
                                                   lights.sky ? lights.sky->irradiance : 0.0, lights.places);
    constexpr uint32_t SKY = 1u << LIGHT_ENVIRONMENT;
    if (of_small_model && (result.facts.lights_present & ~SKY) != 0) result.facts.light_tree_pays = true;
    if (result.facts.light_count > 1 || of_small_model) {
        result.tree = pack_light_trees(lights.tree, lights.lamps, result.first_of_lamps);
        set_fluxes(groups, all.records, result.sky_is_light ? lights.sky->flux : dvec4(0.0), lights.tree);
    }
    if (of_small_model) add_dark_records(result);
    return result;
}

LightSampler chosen_light_sampler(LightSampler requested, const LightFacts& lights) {
    if (lights.light_count < 2) return LightSampler::power;
    if (requested != LightSampler::automatic) return requested;
    return lights.light_tree_pays ? LightSampler::tree : LightSampler::power;
}

std::vector<uvec4> light_textures(const Scene& scene, const MaterialArrays& materials, const FlatScene& flat,
                                  const AreaLights& area, std::span<const uint32_t> order,
                                  const MeshTrees& trees, const Lamps& lamps, uint32_t first_of_lamps) {
    std::vector<uvec4> words;
    if (!materials.facts.small_model &&
        (materials.facts.textured & (TEXTURED_EMISSION | TEXTURED_OPACITY)) == 0 &&
        (materials.facts.principled & PRINCIPLED_HAS_COATED_EMISSION) == 0)
        return words;
    append_textures(words, scene, materials, flat, area, order, 0);
    if (!lamps.empty()) words.resize(size_t{first_of_lamps} * LIGHT_TEXTURES_WORDS);
    auto first = uint32_t(order.size());
    for (const auto& [shown, tree] : trees) {
        if (const auto lamp = lamps.find(shown); lamp != lamps.end())
            append_textures(words, scene, materials, tree.flat, lamp->second.area, tree.bvh.order, first);
        first += uint32_t(tree.bvh.order.size());
    }
    return words;
}

}  // namespace candela
