// Textures of the scene. shared/texture.h has the layouts of texels.
#ifndef SCENE_TEXTURE_GLSL
#define SCENE_TEXTURE_GLSL

#include "scene/scene_data.glsl"
#include "texture/filter.glsl"

// The texel (x, y) of texture t: linear red, green, blue and alpha.
vec4 texel_at(TextureRecord t, uvec2 p) {
    uint tile = (p.y >> 2u) * (t.size.x + 3u >> 2u) + (p.x >> 2u);
    uvec2 within = p & 3u;
    vec4 code;
    if (has_trait(t.traits, TEXEL_R8, TEXEL_FORMATS)) {
        uint row = component(scene_texels(t.first + tile), within.y);
        precise float grey = float(row >> 8u * within.x & 255u) * (1.0 / 255.0);
        code = vec4(vec3(grey), 1.0);
    } else if (has_trait(t.traits, TEXEL_RGBA8, TEXEL_FORMATS)) {
        uint texel = component(scene_texels(t.first + 4u * tile + within.y), within.x);
        precise vec4 rgba = vec4(uvec4(texel, texel >> 8u, texel >> 16u, texel >> 24u) & 255u) * (1.0 / 255.0);
        code = rgba;
    } else {
        uvec4 two = scene_texels(t.first + 8u * tile + 2u * within.y + (within.x >> 1u));
        uvec2 texel = (within.x & 1u) == 0u ? two.xy : two.zw;
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
