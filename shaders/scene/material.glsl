// What textures and the colours of vertices make of materials and lights at a point.
#ifndef SCENE_MATERIAL_GLSL
#define SCENE_MATERIAL_GLSL

#include "scene/attributes.glsl"
#include "scene/texture.glsl"

// What texture t says at a point.
vec4 texture_value(TextureRecord t, Attributes at) {
    return texture_at(t, has_trait(t.traits, TEXTURE_UV1, TEXTURE_UV_SETS) ? at.uv1 : at.uv0);
}

// The colour of texture `i`; white if that is TEXTURE_NONE.
vec3 texture_color(uint i, Attributes at) {
    if (i == TEXTURE_NONE) return vec3(1.0);
    return texture_value(scene_texture(i), at).rgb;
}

// The number of texture `i`; 1 if that is TEXTURE_NONE.
float texture_number(uint i, Attributes at) {
    if (i == TEXTURE_NONE) return 1.0;
    TextureRecord t = scene_texture(i);
    return texture_number(t, texture_value(t, at));
}

MaterialRecord material_at(uint i, Attributes at) {
    MaterialRecord m = scene_material(i);
    if ((TEXTURED & TEXTURED_MATERIALS) == 0u) return m;
    MaterialTextures textures = scene_material_textures(i);
    if ((TEXTURED & TEXTURED_BASE) != 0u) m.base *= texture_color(textures.base, at);
    if ((TEXTURED & TEXTURED_VERTEX_COLORS) != 0u && textures.vertex_colors != 0u) m.base *= at.color.rgb;
    m.base = min(m.base, 1.0);
    if ((TEXTURED & TEXTURED_SPECULAR) != 0u) m.specular = min(m.specular * texture_color(textures.specular, at), 1.0);
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
