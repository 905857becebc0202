// The choice of a light for a lit point, and its probability: the whole sampler of lights. A path that hits a light
// needs the probability of its choice for the previous point, so choice and probability may depend on the point.
#ifndef LIGHT_CHOICE_GLSL
#define LIGHT_CHOICE_GLSL

#include "base/random_range.glsl"
#include "base/warp.glsl"
#include "light/lamp.glsl"
#include "light/tree.glsl"

const bool HAS_SUN_DISKS = (LIGHTS & 1u << LIGHT_SUN) != 0u;
const bool HAS_SUNS = (LIGHTS & (1u << LIGHT_DIRECTIONAL | 1u << LIGHT_SUN)) != 0u;
const bool SKY_IS_LIGHT = (LIGHTS & 1u << LIGHT_ENVIRONMENT) != 0u;
const bool LIGHTS_AFAR = HAS_SUNS || SKY_IS_LIGHT;
const bool LIGHTS_PLACED = (LIGHTS & ~(1u << LIGHT_DIRECTIONAL | 1u << LIGHT_SUN | 1u << LIGHT_ENVIRONMENT)) != 0u;

// A chosen light and its probability.
struct LightChoice {
    uint i;     // Its place in the table of lights,
    uint lamp;  // and that of the lamp that has it, or NO_LIGHT.
    float pmf;
};

// The light of a scene that has only one; an invocation reads it once.
LightRecord only_light;

// Must run before an invocation's first light sample.
void light_prepare() {
    if (ONE_LIGHT) only_light = scene_light(0u);
}

// The light at that place in the table of lights.
LightRecord light_at(uint i) {
    if (ONE_LIGHT) return only_light;
    return scene_light(i);
}

// The place of the sky in the table of lights, if it is one of them.
uint sky_light() {
    LightGroups groups = scene_parameters().lights;
    return groups.placed + groups.suns;
}

// Random bits below 2 * half_width, stretched to all 32 bits; half_width is in [1, 2^31]. No randomness is lost, as it
// would be through a float, and each light's probability is right within 2^-21 of itself.
uint light_stretch(uint bits, uint half_width) {
    int shift = 30 - findMSB(half_width - 1u);
    float scale = 2147483648.0 / float(half_width << shift);  // In [1, 2).
    bits <<= shift;
    uint more, low;
    umulExtended(bits, uint(clamp(scale - 1.0, 0.0, 1.0 - 1.0 / 16777216.0) * 4294967296.0), more, low);
    return bits + min(more, ~bits);
}

// A light chosen by 32 random bits: the sky, a sun, or a light with a place, each by its power.
// Ref: Walker 1977, An Efficient Method for Generating Discrete Random Variables with General Distributions.
uint light_choose_by_power(uint bits) {
    LightGroups groups = scene_parameters().lights;
    uint sky = SKY_IS_LIGHT ? groups.sky_fraction : 0u;
    uint suns = HAS_SUNS ? groups.sun_fraction : 0u;
    bool is_sky = bits >> 1u < sky;
    bool is_sun = HAS_SUNS && !is_sky && (bits >> 1u) - sky < suns;
    uint first = is_sun ? groups.placed : 0u;
    uint count = is_sun ? groups.suns : groups.placed;
    if (LIGHTS_AFAR) {
        // The unused randomness of the choice among groups is uniform.
        uint rest = bits - 2u * (is_sun ? sky : sky + suns);
        bits = light_stretch(rest, max(is_sun ? suns : 2147483648u - sky - suns, 1u));
    }
    uvec2 column = warp_alias_column(bits, count);
    uint i = first + warp_alias_choice(column, scene_light_alias(first + column.x)).i;
    return is_sky ? groups.placed + groups.suns : i;
}

// One of the lights with a place, of which there is at least one, chosen by 32 random bits, by its power.
uint light_choose_placed(uint bits) {
    uvec2 column = warp_alias_column(bits, scene_parameters().lights.placed);
    return warp_alias_choice(column, scene_light_alias(column.x)).i;
}

uint light_count(LightGroups groups) {
    return groups.placed + groups.suns + (SKY_IS_LIGHT ? 1u : 0u);
}

// Estimated irradiance of a lit point by a group of lights far away, without occlusion, in the unit of LightGroups.
float afar_irradiance(vec4 group, LitPoint lit) {
    float along = dot(group.xyz, lit.n);
    if (lit.both_sides) along = abs(along);
    if (lit.any_normal) along = length(group.xyz);
    return max(along + group.w, 0.0);
}

// How the tree, the suns and the sky divide the choice for a lit point: where the parts of the tree and of the suns
// end, in units of 1 / RANGE_PARTS; the sky has the rest. A part is two thirds what the group may send there, and one
// third equal for all that are present, because walls may be in between.
uvec2 light_tree_groups(LitPoint lit) {
    LightGroups groups = scene_parameters().lights;
    vec3 weight = vec3(0.0);
    if (LIGHTS_PLACED) {
        vec4 importance = light_tree_importances(0u, lit);
        weight.x = importance.x + importance.y + importance.z + importance.w;
    }
    if (HAS_SUNS) weight.y = afar_irradiance(groups.sun_flux, lit);
    if (SKY_IS_LIGHT) weight.z = afar_irradiance(groups.sky_flux, lit);
    vec3 present = vec3(LIGHTS_PLACED && groups.placed > 0u, HAS_SUNS && groups.suns > 0u,
                        SKY_IS_LIGHT && groups.sky_fraction > 0u);
    float alike = 1.0 / max(present.x + present.y + present.z, 1.0);
    weight = min(weight, vec3(1e30));
    precise vec3 part = weight / max(weight.x + weight.y + weight.z, 1e-30) + 0.5 * alike * present;
    precise vec3 ends = vec3(part.x, part.x + part.y, part.x + part.y + part.z);
    precise vec2 parts = ends.xy * (float(RANGE_PARTS) / ends.z) + 0.5;
    return uvec2(min(parts, vec2(float(RANGE_PARTS))));
}

// Must run for a lit point before a light is chosen for it.
void light_set_groups(inout LitPoint lit) {
    if (LIGHT_SAMPLER != LIGHT_SAMPLER_TREE || !LIGHTS_AFAR || ONE_LIGHT) return;
    uvec2 ends = light_tree_groups(lit);
    lit.groups = ends.x | ends.y << 16u;
}

// Where these parts end: the tree by strength, the tree by importance, the suns, the sky.
uvec4 light_groups_at(LitPoint lit) {
    uvec2 ends = LIGHTS_AFAR ? uvec2(lit.groups & 0xFFFFu, lit.groups >> 16u) : uvec2(RANGE_PARTS);
    return uvec4(ends.x / LIGHT_TREE_WAYS, ends, RANGE_PARTS);
}

// The probability of a sun among the suns.
float sun_share(uint i, LightGroups groups) {
    return scene_light(i).pmf * 2147483648.0 / float(groups.sun_fraction);
}

// Whether the table of lights has a lamp there.
bool light_is_lamp(uint i) {
    return HAS_LAMPS && light_at(i).kind == LIGHT_LAMP;
}

// A light from the tree, a sun or the sky.
LightChoice light_choose_by_tree(LitPoint lit, uvec2 bits) {
    RandomRange random = range_begin(bits);
    uvec4 groups = light_groups_at(lit);
    uint group = range_choose(random, groups);
    LightChoice choice = LightChoice(0u, NO_LIGHT, 1.0);
    if (LIGHTS_PLACED && group < 2u) {
        LightTreeWay way = light_tree_begin(group < 2u ? 0u : LIGHT_TREE_LEAF_BIT);
        light_tree_choose(way, lit, random, group == 0u);
        choice.i = way.at & ~LIGHT_TREE_LEAF_BIT;
        if (light_is_lamp(choice.i)) {
            choice.lamp = choice.i;
            LampRecord lamp = scene_lamp(choice.lamp);
            way.at = lamp.root;
            light_tree_choose(way, lit_in_lamp(lit, lamp), random, group == 0u);
            choice.i = lamp.first + (way.at & ~LIGHT_TREE_LEAF_BIT);
        }
        choice.pmf = light_tree_pmf(way, groups);
    }
    if (HAS_SUNS && group == 2u) {
        LightGroups table = scene_parameters().lights;
        uvec2 column = warp_alias_column(light_stretch(2u * random.u, random.size), table.suns);
        choice.i = table.placed + warp_alias_choice(column, scene_light_alias(table.placed + column.x)).i;
        choice.pmf = range_part(groups, 2u) * sun_share(choice.i, table);
    }
    if (SKY_IS_LIGHT && group == 3u) choice = LightChoice(sky_light(), NO_LIGHT, range_part(groups, 3u));
    return choice;
}

// Goes on from a lamp to one of its lights, by their power or uniformly.
void light_choose_of_lamp(inout LightChoice choice, uint bits) {
    choice.lamp = choice.i;
    LampRecord lamp = scene_lamp(choice.lamp);
    uvec2 column = warp_alias_column(bits, lamp.count);
    if (LIGHT_SAMPLER == LIGHT_SAMPLER_UNIFORM) {
        choice.i = lamp.first + column.x;
        choice.pmf /= float(lamp.count);
    } else {
        choice.i = lamp.first + warp_alias_choice(column, scene_light_alias(lamp.alias + column.x)).i;
        choice.pmf *= light_at(choice.i).pmf;
    }
}

// A light chosen by 2 x 32 random bits, those of x first. The scene has at least one light.
LightChoice light_choose(LitPoint lit, uvec2 bits) {
    if (ONE_LIGHT) return LightChoice(0u, NO_LIGHT, 1.0);
    if (LIGHT_SAMPLER == LIGHT_SAMPLER_TREE) return light_choose_by_tree(lit, bits);
    LightChoice choice;
    choice.lamp = NO_LIGHT;
    if (LIGHT_SAMPLER == LIGHT_SAMPLER_UNIFORM) {
        uint n = light_count(scene_parameters().lights);
        choice.i = warp_alias_column(bits.x, n).x;
        choice.pmf = 1.0 / float(n);
    } else {
        choice.i = light_choose_by_power(bits.x);
        choice.pmf = light_at(choice.i).pmf;
    }
    if (light_is_lamp(choice.i)) light_choose_of_lamp(choice, bits.y);
    return choice;
}

// Probability of the way to a light in the tree, or to that of a lamp.
float light_tree_pmf(uint i, uint lamp, LitPoint lit) {
    LightTreeWay way = light_tree_begin(0u);
    light_tree_follow(way, lit, scene_light_trail(is_lamp(lamp) ? lamp : i));
    if (is_lamp(lamp)) {
        LampRecord record = scene_lamp(lamp);
        way.at = record.root;
        light_tree_follow(way, lit_in_lamp(lit, record), scene_light_trail(i));
    }
    return light_tree_pmf(way, light_groups_at(lit));
}

// Probability with which light_choose chooses light i of a lamp, or of none (NO_LIGHT), for that point; only of lights
// with a place in the scene.
float light_pmf(uint i, uint lamp, LitPoint lit) {
    if (ONE_LIGHT) return 1.0;
    if (LIGHT_SAMPLER == LIGHT_SAMPLER_TREE) return light_tree_pmf(i, lamp, lit);
    if (LIGHT_SAMPLER == LIGHT_SAMPLER_UNIFORM) {
        float pmf = 1.0 / float(light_count(scene_parameters().lights));
        return is_lamp(lamp) ? pmf / float(scene_lamp(lamp).count) : pmf;
    }
    float pmf = light_at(i).pmf;
    return is_lamp(lamp) ? light_at(lamp).pmf * pmf : pmf;
}

// The same of a sun.
float sun_pmf(uint i, LitPoint lit) {
    if (LIGHT_SAMPLER == LIGHT_SAMPLER_TREE && !ONE_LIGHT) {
        return range_part(light_groups_at(lit), 2u) * sun_share(i, scene_parameters().lights);
    }
    return light_pmf(i, NO_LIGHT, lit);
}

// The same of the sky, which is one of the lights.
float sky_pmf(LitPoint lit) {
    if (LIGHT_SAMPLER == LIGHT_SAMPLER_TREE && !ONE_LIGHT) return range_part(light_groups_at(lit), 3u);
    return light_pmf(sky_light(), NO_LIGHT, lit);
}

#endif
