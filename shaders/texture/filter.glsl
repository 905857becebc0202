// The places where an image is looked up, by arithmetic that has one result on every device (`precise`: no
// multiplication is fused with an addition). Hardware filters round as they like, to 8 bits on software Vulkan.
#ifndef TEXTURE_FILTER_GLSL
#define TEXTURE_FILTER_GLSL

#include "texture/decode.glsl"

// The look-up along one axis of an image: the texels on either side, and the weight of the second.
struct AxisPlace {
    uint first;
    uint second;
    float weight;  // In [0, 1].
};

// The continuation of an axis beyond the image.
struct AxisWrap {
    bool clamped;   // The edge continues.
    bool mirrored;  // It alternates; without either, the image repeats.
};

// By the bits TEXTURE_WRAPS << group_shift of `traits`.
AxisWrap axis_wrap(uint traits, const uint group_shift) {
    return AxisWrap(has_trait(traits, TEXTURE_CLAMP << group_shift, TEXTURE_WRAPS << group_shift),
                    has_trait(traits, TEXTURE_MIRROR << group_shift, TEXTURE_WRAPS << group_shift));
}

// The place t along an axis, wrapped into [0, 1]; `turned` if it decreases as t grows.
float axis_wrapped(float t, AxisWrap wrap, out bool turned) {
    turned = false;
    precise float at = t - floor(t);
    if (wrap.mirrored) {
        precise float half_t = 0.5 * t;
        at = 2.0 * (half_t - floor(half_t));
        turned = at > 1.0;
        at = turned ? 2.0 - at : at;
    }
    if (wrap.clamped) at = clamp(t, 0.0, 1.0);
    return at;
}

// The place t along an axis of n texels; `wrap` is one of the bits TEXTURE_WRAPS of `traits`.
AxisPlace axis_place(float t, uint n, uint traits, const uint group_shift) {
    AxisWrap wrap = axis_wrap(traits, group_shift);
    bool turned;
    precise float scaled = axis_wrapped(t, wrap, turned) * float(n);
    if (has_trait(traits, TEXTURE_NEAREST, TEXTURE_FILTERS)) {
        uint i = min(uint(scaled), n - 1u);
        return AxisPlace(i, i, 0.0);
    }
    precise float x = scaled - 0.5;
    float below = floor(x);
    int last = int(n) - 1;
    int i = clamp(int(below), -1, last);  // In range, even for NaN.
    bool repeats = !wrap.mirrored && !wrap.clamped;
    uint first = uint(i < 0 ? (repeats ? last : 0) : i);
    uint second = uint(i >= last ? (repeats ? 0 : last) : i + 1);
    return AxisPlace(first, second, x - below);
}

// The three texels around a place along an axis; their weights in a quadratic B-spline, and the derivatives of these
// with t. With linear interpolation between texels, the slope would jump at each.
struct AxisSlope {
    uvec3 texels;
    vec3 weights;
    vec3 slopes;
};

AxisSlope axis_slope(float t, uint n, uint traits, const uint group_shift) {
    AxisWrap wrap = axis_wrap(traits, group_shift);
    bool turned;
    float scaled = axis_wrapped(t, wrap, turned) * float(n);
    uint last = n - 1u;
    uint i = min(uint(scaled), last);
    float x = scaled - float(i) - 0.5;
    bool repeats = !wrap.mirrored && !wrap.clamped;
    uint before = i > 0u ? i - 1u : (repeats ? last : 0u);
    uint after = i < last ? i + 1u : (repeats ? 0u : last);
    vec3 weights = vec3(0.5 * (0.5 - x) * (0.5 - x), 0.75 - x * x, 0.5 * (0.5 + x) * (0.5 + x));
    vec3 slopes = vec3(x - 0.5, -2.0 * x, x + 0.5);
    return AxisSlope(uvec3(before, i, after), weights, (turned ? -float(n) : float(n)) * slopes);
}

float lerp(float a, float b, float t) {
    precise float x = a + t * (b - a);
    return x;
}

vec4 lerp(vec4 a, vec4 b, float t) {
    precise vec4 x = a + t * (b - a);
    return x;
}

#endif
