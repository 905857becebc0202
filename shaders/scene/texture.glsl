// Textures of the scene. shared/texture.h has the layouts of texels.
#ifndef SCENE_TEXTURE_GLSL
#define SCENE_TEXTURE_GLSL

#include "scene/scene_data.glsl"
#include "texture/filter.glsl"

// The bits of texel (x, y) of texture t; 16-bit channels need two words.
uvec2 texel_bits(TextureRecord t, uvec2 p) {
    uint tile = (p.y >> 2u) * (t.size.x + 3u >> 2u) + (p.x >> 2u);
    uvec2 within = p & 3u;
    if (has_trait(t.traits, TEXEL_R8, TEXEL_FORMATS)) {
        return uvec2(component(scene_texels(t.first + tile), within.y) >> 8u * within.x & 255u, 0u);
    }
    if (has_trait(t.traits, TEXEL_RGBA8, TEXEL_FORMATS)) {
        return uvec2(component(scene_texels(t.first + 4u * tile + within.y), within.x), 0u);
    }
    uvec4 two = scene_texels(t.first + 8u * tile + 2u * within.y + (within.x >> 1u));
    return (within.x & 1u) == 0u ? two.xy : two.zw;
}

// The texel (x, y) of texture t: linear red, green, blue and alpha.
vec4 texel_at(TextureRecord t, uvec2 p) {
    uvec2 texel = texel_bits(t, p);
    vec4 code;
    if (has_trait(t.traits, TEXEL_R8, TEXEL_FORMATS)) {
        precise float grey = float(texel.x) * (1.0 / 255.0);
        code = vec4(vec3(grey), 1.0);
    } else if (has_trait(t.traits, TEXEL_RGBA8, TEXEL_FORMATS)) {
        precise vec4 rgba = vec4(uvec4(texel.x, texel.x >> 8u, texel.x >> 16u, texel.x >> 24u) & 255u) * (1.0 / 255.0);
        code = rgba;
    } else {
        uvec4 halves = uvec4(texel.x & 0xFFFFu, texel.x >> 16u, texel.y & 0xFFFFu, texel.y >> 16u);
        if (has_trait(t.traits, TEXEL_RGBA16F, TEXEL_FORMATS)) {
            return vec4(half_decode(halves.x), half_decode(halves.y), half_decode(halves.z), half_decode(halves.w));
        }
        precise vec4 rgba = vec4(halves) * (1.0 / 65535.0);
        code = rgba;
    }
    if (has_trait(t.traits, TEXTURE_SRGB, TEXTURE_ENCODINGS)) code.rgb = srgb_decode(code.rgb);
    return code;
}

// The texture's channel of texel_at().
float texel_number(TextureRecord t, uvec2 p) {
    uint channel = t.traits >> TEXTURE_CHANNEL_SHIFT & 3u;
    bool alpha = channel == 3u;
    uvec2 texel = texel_bits(t, p);
    precise float number;
    if (has_trait(t.traits, TEXEL_R8, TEXEL_FORMATS)) {
        number = alpha ? 1.0 : float(texel.x) * (1.0 / 255.0);
    } else if (has_trait(t.traits, TEXEL_RGBA8, TEXEL_FORMATS)) {
        number = float(texel.x >> 8u * channel & 255u) * (1.0 / 255.0);
    } else {
        uint bits = (channel < 2u ? texel.x : texel.y) >> 16u * (channel & 1u) & 0xFFFFu;
        bool half_float = has_trait(t.traits, TEXEL_RGBA16F, TEXEL_FORMATS);
        number = half_float ? half_decode(bits) : float(bits) * (1.0 / 65535.0);
    }
    bool srgb = has_trait(t.traits, TEXTURE_SRGB, TEXTURE_ENCODINGS) && !alpha;
    return srgb ? srgb_decode(vec3(number)).x : number;
}

// The place in texture t for (u, v) of its set; it repeats with a period of 1.
vec2 texture_point(TextureRecord t, vec2 uv) {
    precise float x = t.row_u.x * uv.x + t.row_u.y * uv.y + t.row_u.z;
    precise float y = t.row_v.x * uv.x + t.row_v.y * uv.y + t.row_v.z;
    return vec2(x, y);
}

// The texels that are interpolated there.
struct TexturePlace {
    AxisPlace u;
    AxisPlace v;
};

TexturePlace texture_place(TextureRecord t, vec2 uv) {
    vec2 point = texture_point(t, uv);
    return TexturePlace(axis_place(point.x, t.size.x, t.traits, 0u),
                        axis_place(point.y, t.size.y, t.traits, TEXTURE_WRAP_V));
}

// Texel i of the four that are interpolated there.
uvec2 texture_corner(TexturePlace at, int i) {
    return uvec2((i & 1) == 0 ? at.u.first : at.u.second, i < 2 ? at.v.first : at.v.second);
}

// The image of texture t at (u, v) of its set: linear red, green, blue and alpha. (A loop: some compilers inline each
// call, and need minutes for four.)
vec4 texture_at(TextureRecord t, vec2 uv) {
    TexturePlace at = texture_place(t, uv);
    vec4 texels[4];
    for (int i = 0; i < 4; ++i) {
        texels[i] = texel_at(t, texture_corner(at, i));
    }
    return lerp(lerp(texels[0], texels[1], at.u.weight), lerp(texels[2], texels[3], at.u.weight), at.v.weight);
}

// The texture's channel of texture_at().
float texture_number(TextureRecord t, vec2 uv) {
    TexturePlace at = texture_place(t, uv);
    vec4 numbers;
    for (int i = 0; i < 4; ++i) {
        numbers[i] = texel_number(t, texture_corner(at, i));
    }
    return lerp(lerp(numbers.x, numbers.y, at.u.weight), lerp(numbers.z, numbers.w, at.u.weight), at.v.weight);
}

// One texel of the image, each with the probability of its bilinear weight: its expected value is texture_at(), for a
// quarter of the look-ups. `random`: two uniform numbers in [0, 1).
// Ref: Pharr, Wronski, Salvi and Fajardo 2024, Filtering After Shading with Stochastic Texture Filtering.
vec4 texture_tap(TextureRecord t, vec2 uv, vec2 random) {
    TexturePlace at = texture_place(t, uv);
    return texel_at(
        t, uvec2(random.x < at.u.weight ? at.u.second : at.u.first, random.y < at.v.weight ? at.v.second : at.v.first));
}

// The derivatives of the texture's channel with u and v, for texels interpolated by a quadratic B-spline.
vec2 texture_slope(TextureRecord t, vec2 uv) {
    vec2 place = texture_point(t, uv);
    AxisSlope u = axis_slope(place.x, t.size.x, t.traits, 0u);
    AxisSlope v = axis_slope(place.y, t.size.y, t.traits, TEXTURE_WRAP_V);
    vec2 slope = vec2(0.0);
    for (int row = 0; row < 3; ++row) {
        vec3 numbers;
        for (int column = 0; column < 3; ++column) {
            numbers[column] = texel_number(t, uvec2(u.texels[column], v.texels[row]));
        }
        slope += vec2(v.weights[row] * dot(u.slopes, numbers), v.slopes[row] * dot(u.weights, numbers));
    }
    return slope.x * t.row_u.xy + slope.y * t.row_v.xy;
}

#endif
