// The environment: radiance from infinitely far away, constant over the texels of a latitude-longitude map, sampled in
// proportion to solid angle times what its luminance has above the mean.
#ifndef LIGHT_ENVIRONMENT_GLSL
#define LIGHT_ENVIRONMENT_GLSL

#include "base/warp.glsl"
#include "light/sample.glsl"
#include "scene/scene_data.glsl"

// The texel in the unit direction w of world space.
EnvironmentTexel environment_texel(vec3 w) {
    if (EVEN_SKY) return scene_environment_texel(0u);
    Parameters parameters = scene_parameters();
    vec2 turn = parameters.environment_turn;
    vec3 m = vec3(turn.x * w.x - turn.y * w.z, w.y, turn.y * w.x + turn.x * w.z);  // In the map's axes.
    vec2 uv = vec2(fract(angle_turn(m.x, -m.z) + 0.5), 2.0 * angle_turn(length(m.xz), m.y));
    uvec2 size = parameters.environment_size;
    uvec2 texel = min(uvec2(uv * vec2(size)), size - 1u);
    return scene_environment_texel(texel.y * size.x + texel.x);
}

// Direction in world space through a point of a texel (x, y); `within` in [0,1)^2 is uniform over its solid angle.
vec3 environment_direction(uvec2 texel, vec2 within) {
    Parameters parameters = scene_parameters();
    uvec2 size = parameters.environment_size;
    // Rows are counted from the nearer pole, where 1 - cos(theta) = 2 sin(theta/2)^2 keeps its digits.
    uint row = min(texel.y, size.y - 1u - texel.y);
    float row_turn = 0.25 / float(size.y);  // A row, in turns of theta / 2.
    float s0 = square(cos_sin_turn(float(row) * row_turn).y);
    float s1 = square(cos_sin_turn(float(row + 1u) * row_turn).y);
    float h = 2.0 * mix(s0, s1, within.y);
    float longitude = fract((float(texel.x) + within.x) / float(size.x) + 0.5);  // In turns from -Z to +X.
    vec3 d = direction_at(h, longitude);
    vec3 m = vec3(d.y, row == texel.y ? d.z : -d.z, -d.x);
    vec2 turn = parameters.environment_turn;
    return vec3(turn.x * m.x + turn.y * m.z, m.y, turn.x * m.z - turn.y * m.x);
}

// A place that random bits chose, and what the choice leaves of them, uniform in [0, 1).
struct EnvironmentChoice {
    uint i;
    float rest;
};

// One of n places by 32 random bits, by the table that begins at entry `first`. Neighbouring bits choose neighbouring
// places, so that the choice keeps the order of a low-discrepancy sequence. The entry of the bits' own part of the
// table says between which places to look, by bisection.
// Ref: Chen and Asau 1974, On Generating Random Variates from an Empirical Distribution.
EnvironmentChoice environment_choose(uint first, uint n, uint bits) {
    uint part, unused;
    umulExtended(bits, n, part, unused);
    uint range = scene_environment_cdf(first + part).range;
    uint lo = range & CDF_MAX_PLACES - 1u, more = range >> CDF_PLACE_BITS;
    uint hi = more < CDF_MANY_MORE ? lo + more : n - 1u;
    while (lo < hi) {
        uint middle = (lo + hi) / 2u;
        bool beyond = bits > scene_environment_cdf(first + middle).last_word;
        lo = beyond ? middle + 1u : lo;
        hi = beyond ? hi : middle;
    }
    uint begin = lo == 0u ? 0u : scene_environment_cdf(first + lo - 1u).last_word + 1u;
    uint last = scene_environment_cdf(first + lo).last_word;
    float rest = (float(bits - begin) + 0.5) / (float(last - begin) + 1.0);
    return EnvironmentChoice(lo, min(rest, 1.0 - 1.0 / 16777216.0));
}

// A direction towards the sky, from 2 x 32 random bits.
LightSample environment_light_sample_li(uvec2 u) {
    uvec2 size = scene_parameters().environment_size;
    EnvironmentChoice row = environment_choose(size.x * size.y, size.y, u.y);
    EnvironmentChoice column = environment_choose(row.i * size.x, size.x, u.x);
    EnvironmentTexel texel = scene_environment_texel(row.i * size.x + column.i);
    LightSample s;
    s.wi = environment_direction(uvec2(column.i, row.i), vec2(column.rest, row.rest));
    s.Li = texel.radiance;
    s.pdf = texel.pdf;
    s.delta = false;
    s.shadow = s.wi;
    s.t_max = FLOAT_MAX;
    return s;
}

#endif
