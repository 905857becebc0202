// Where an image is looked up, by arithmetic that has one result on every device (`precise`: no multiplication is fused
// with an addition). Hardware filters round as they like, to 8 bits on software Vulkan.
#ifndef TEXTURE_FILTER_GLSL
#define TEXTURE_FILTER_GLSL

#include "texture/decode.glsl"

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

#endif
