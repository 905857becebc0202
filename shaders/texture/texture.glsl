// Look-up of textures: wrap, filter and decoding by arithmetic that has one result on every device (`precise`: no
// multiplication is fused with an addition). Hardware filters round as they like, to 8 bits on software Vulkan.
#ifndef TEXTURE_TEXTURE_GLSL
#define TEXTURE_TEXTURE_GLSL

#include "scene/scene_data.glsl"
#include "texture/texel.glsl"

// Where one axis of an image is looked up: the texels on either side, and the weight of the second.
struct AxisPlace {
    uint first;
    uint second;
    float weight;  // In [0, 1].
};

// The place t along an axis of n texels; `wrap` is one of the bits TEXTURE_WRAPS of `traits`.
AxisPlace axis_place(float t, uint n, uint traits, const uint group_shift) {
    bool clamped = has_trait(traits, TEXTURE_CLAMP << group_shift, TEXTURE_WRAPS << group_shift);
    bool mirrored = has_trait(traits, TEXTURE_MIRROR << group_shift, TEXTURE_WRAPS << group_shift);
    precise float at = t - floor(t);
    if (mirrored) {
        precise float half_t = 0.5 * t;
        at = 2.0 * (half_t - floor(half_t));
        at = at > 1.0 ? 2.0 - at : at;
    }
    if (clamped) at = clamp(t, 0.0, 1.0);
    precise float scaled = at * float(n);
    if (has_trait(traits, TEXTURE_NEAREST, TEXTURE_FILTERS)) {
        uint i = min(uint(scaled), n - 1u);
        return AxisPlace(i, i, 0.0);
    }
    precise float x = scaled - 0.5;
    float below = floor(x);
    int i = int(below);
    int last = int(n) - 1;
    bool repeats = !mirrored && !clamped;
    uint first = uint(i < 0 ? (repeats ? last : 0) : i);
    uint second = uint(i >= last ? (repeats ? 0 : last) : i + 1);
    return AxisPlace(first, second, x - below);
}

vec4 lerp(vec4 a, vec4 b, float t) {
    precise vec4 x = a + t * (b - a);
    return x;
}

// The image of texture t at (u, v) of its set: linear red, green, blue and alpha.
vec4 texture_at(TextureRecord t, vec2 uv) {
    precise float x = t.row_u.x * uv.x + t.row_u.y * uv.y + t.row_u.z;
    precise float y = t.row_v.x * uv.x + t.row_v.y * uv.y + t.row_v.z;
    AxisPlace u = axis_place(x, t.size.x, t.traits, 0u);
    AxisPlace v = axis_place(y, t.size.y, t.traits, TEXTURE_WRAP_V);
    vec4 a = texel_at(t, uvec2(u.first, v.first));
    if (has_trait(t.traits, TEXTURE_NEAREST, TEXTURE_FILTERS)) return a;
    vec4 b = texel_at(t, uvec2(u.second, v.first));
    vec4 c = texel_at(t, uvec2(u.first, v.second));
    vec4 d = texel_at(t, uvec2(u.second, v.second));
    return lerp(lerp(a, b, u.weight), lerp(c, d, u.weight), v.weight);
}

// The number that texture t takes from its channel.
float texture_number(TextureRecord t, vec4 value) {
    uint channel = t.traits >> TEXTURE_CHANNEL_SHIFT & 3u;
    vec2 pair = channel < 2u ? value.xy : value.zw;
    return (channel & 1u) == 0u ? pair.x : pair.y;
}

#endif
