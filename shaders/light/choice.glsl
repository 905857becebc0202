// The choice of a light for a point that is lit, and its probability: the whole sampler of lights. A path that hits a
// light asks for the probability with which it would have been chosen for the previous point, so choice and probability
// may depend on the point.
#ifndef LIGHT_CHOICE_GLSL
#define LIGHT_CHOICE_GLSL

#include "base/warp.glsl"
#include "scene/scene_data.glsl"

const bool HAS_SUNS = (LIGHTS & 1u << LIGHT_DIRECTIONAL) != 0u;
const bool SKY_IS_LIGHT = (LIGHTS & 1u << LIGHT_ENVIRONMENT) != 0u;

// A point that is lit: the inputs of the choice of a light. In the frame of the scene.
struct LitPoint {
    vec3 p;           // Where rays to the lights begin.
    vec3 n;           // Unit normal on the viewer's side: lights below its horizon do not light that side.
    bool both_sides;  // Light from either side of n is scattered.
    bool any_normal;  // Light from all directions is scattered equally, and n is 0.
};

// A point on a surface with that horizon.
LitPoint lit_on_surface(vec3 p, vec3 horizon, bool both_sides) {
    return LitPoint(p, horizon, both_sides, false);
}

// A point without a normal, as within a medium.
LitPoint lit_anywhere(vec3 p) {
    return LitPoint(p, vec3(0.0), true, true);
}

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

// The place of a light, chosen by 32 random bits: the sky, a sun, or a light with a place, each by its power. The scene
// has at least one light.
// Ref: Walker 1977, An Efficient Method for Generating Discrete Random Variables with General Distributions.
uint light_choose(LitPoint lit, uint bits) {
    if (ONE_LIGHT) return 0u;
    LightGroups groups = scene_parameters().lights;
    uint sky = SKY_IS_LIGHT ? groups.sky_fraction : 0u;
    uint suns = HAS_SUNS ? groups.sun_fraction : 0u;
    bool is_sky = bits >> 1u < sky;
    bool is_sun = HAS_SUNS && !is_sky && (bits >> 1u) - sky < suns;
    uint first = is_sun ? groups.placed : 0u;
    uint count = is_sun ? groups.suns : groups.placed;
    if (SKY_IS_LIGHT || HAS_SUNS) {
        // The unused randomness of the choice among groups is uniform.
        uint rest = bits - 2u * (is_sun ? sky : sky + suns);
        bits = light_stretch(rest, max(is_sun ? suns : 2147483648u - sky - suns, 1u));
    }
    uvec2 column = warp_alias_column(bits, count);
    uint i = first + warp_alias_choice(column, scene_light_alias(first + column.x)).i;
    return is_sky ? groups.placed + groups.suns : i;
}

// Probability with which light_choose chooses light i for that point.
float light_pmf(uint i, LitPoint lit) {
    return ONE_LIGHT ? 1.0 : light_at(i).pmf;
}

#endif
