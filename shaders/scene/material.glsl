// What textures and the colours of vertices make of materials and lights at a point.
#ifndef SCENE_MATERIAL_GLSL
#define SCENE_MATERIAL_GLSL

#include "base/hash.glsl"
#include "base/ray.glsl"
#include "base/sampler.glsl"
#include "scene/attributes.glsl"
#include "scene/texture.glsl"

// The coordinates at which texture t is looked up.
vec2 texture_uv(TextureRecord t, Attributes at) {
    return has_trait(t.traits, TEXTURE_UV1, TEXTURE_UV_SETS) ? at.uv1 : at.uv0;
}

// The colour of texture `i`; white if that is TEXTURE_NONE.
vec3 texture_color(uint i, Attributes at) {
    if (i == TEXTURE_NONE) return vec3(1.0);
    TextureRecord t = scene_texture(i);
    return texture_at(t, texture_uv(t, at)).rgb;
}

// A random colour whose expected value is texture_color(); `random` as for texture_tap().
vec3 texture_color_tap(uint i, Attributes at, vec2 random) {
    if (i == TEXTURE_NONE) return vec3(1.0);
    TextureRecord t = scene_texture(i);
    return texture_tap(t, texture_uv(t, at), random).rgb;
}

// The number of texture `i`; 1 if that is TEXTURE_NONE.
float texture_number(uint i, Attributes at) {
    if (i == TEXTURE_NONE) return 1.0;
    TextureRecord t = scene_texture(i);
    return texture_number(t, texture_uv(t, at));
}

// Two random numbers in [0, 1) for the hit of a ray: a hash of its bits, so that scenes with textures take the same
// numbers from the sampler as those without.
vec2 texture_random(Ray ray) {
    uvec4 v = hash_pcg4d(uvec4(floatBitsToUint(ray.d), floatBitsToUint(ray.o.x)));
    return unit_float(hash_pcg4d(v ^ uvec4(floatBitsToUint(ray.o.y), floatBitsToUint(ray.o.z), 0u, 0u)).xy);
}

// The material of index i, seen by that ray. The radiance of all models is linear in their colours: these may be one
// texel chosen at random. Other numbers are filtered.
MaterialRecord material_at(uint i, Attributes at, Ray ray) {
    MaterialRecord m = scene_material(i);
    if ((TEXTURED & TEXTURED_MATERIALS) == 0u) return m;
    MaterialTextures textures = scene_material_textures(i);
    vec2 random = vec2(0.0);
    if ((TEXTURED & (TEXTURED_BASE | TEXTURED_SPECULAR)) != 0u) random = texture_random(ray);
    if ((TEXTURED & TEXTURED_BASE) != 0u) m.base *= texture_color_tap(textures.base, at, random);
    if ((TEXTURED & TEXTURED_VERTEX_COLORS) != 0u && textures.vertex_colors != 0u) m.base *= at.color.rgb;
    m.base = min(m.base, 1.0);
    if ((TEXTURED & TEXTURED_SPECULAR) != 0u) {
        m.specular = min(m.specular * texture_color_tap(textures.specular, at, random), 1.0);
    }
    if ((TEXTURED & TEXTURED_PARAMETER) != 0u) {
        m.parameter *= texture_number(textures.parameter, at);
        if (m.model == MATERIAL_CONDUCTOR) m.parameter = clamp(m.parameter, LEAST_ALPHA, 1.0);
        if (m.model == MATERIAL_PHONG) m.parameter = min(m.parameter, GREATEST_EXPONENT);
    }
    return m;
}

// The probability that a ray does not pass the surface.
float material_opacity(uint i, Attributes at) {
    MaterialTextures textures = scene_material_textures(i);
    float opacity = textures.opacity * texture_number(textures.opacity_texture, at);
    if ((TEXTURED & TEXTURED_VERTEX_COLORS) != 0u && textures.vertex_colors != 0u) opacity *= at.color.a;
    if (textures.cutoff >= 0.0) return opacity >= textures.cutoff ? 1.0 : 0.0;
    return opacity;
}

// Factor of the radiance of light `i`.
vec3 light_texture(uint i, Attributes at) {
    if ((TEXTURED & TEXTURED_EMISSION) == 0u) return vec3(1.0);
    return texture_color(scene_light_textures(i).emission, at);
}

#endif
