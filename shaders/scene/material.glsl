// Materials and lights at a point, with their textures and the colours of vertices.
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

// Random bits for the hit of a ray: a hash of its bits, so that scenes with textures use the same numbers from the
// sampler as scenes without.
uvec4 hit_random(Ray ray) {
    uvec4 v = hash_pcg4d(uvec4(floatBitsToUint(ray.d), floatBitsToUint(ray.o.x)));
    return hash_pcg4d(v ^ uvec4(floatBitsToUint(ray.o.y), floatBitsToUint(ray.o.z), 0u, 0u));
}

// The material of index i, seen by that ray. The radiance of all models is linear in their colours, so a colour may be
// one texel chosen at random. Other numbers are filtered.
MaterialRecord material_at(uint i, Attributes at, Ray ray) {
    MaterialRecord m = scene_material(i);
    if ((TEXTURED & TEXTURED_MATERIALS) == 0u) return m;
    MaterialTextures textures = scene_material_textures(i);
    vec2 random = vec2(0.0);
    if ((TEXTURED & (TEXTURED_BASE | TEXTURED_SPECULAR)) != 0u) random = unit_float(hit_random(ray).xy);
    if ((TEXTURED & TEXTURED_BASE) != 0u) m.base *= texture_color_tap(textures.base, at, random);
    if ((TEXTURED & TEXTURED_VERTEX_COLORS) != 0u && textures.vertex_colors != 0u) m.base *= at.color.rgb;
    m.base = min(m.base, 1.0);
    if ((TEXTURED & TEXTURED_SPECULAR) != 0u) {
        m.specular = min(m.specular * texture_color_tap(textures.specular, at, random), 1.0);
    }
    if ((TEXTURED & TEXTURED_PARAMETER) != 0u) {
        m.parameter *= texture_number(textures.parameter, at);
        if (m.model == MATERIAL_CONDUCTOR) m.parameter = clamp(m.parameter, MIN_FACET_ALPHA, 1.0);
        if (m.model == MATERIAL_PHONG) m.parameter = min(m.parameter, GREATEST_EXPONENT);
    }
    return m;
}

bool principled_gives(uint values, const uint value) {
    return (values & 1u << value) != 0u;
}

// The factor of a number from an image: its channel, or 1.
float principled_number(vec4 texel, PrincipledImage image, const uint value) {
    if (!principled_gives(image.values, value)) return 1.0;
    uint channel = (value < 16u ? image.channels.x >> 2u * value : image.channels.y >> 2u * (value - 16u)) & 3u;
    return channel < 2u ? (channel == 0u ? texel.r : texel.g) : (channel == 2u ? texel.b : texel.a);
}

// Multiplies the values of a principled material, and its base colour, by an image's values.
void principled_apply(inout PrincipledRecord p, inout vec3 base_color, PrincipledImage image, Attributes at) {
    TextureRecord t = scene_texture(image.texture);
    vec4 texel = texture_at(t, texture_uv(t, at));
    if (principled_gives(image.values, PRINCIPLED_BASE_COLOR)) base_color *= texel.rgb;
    if (principled_gives(image.values, PRINCIPLED_ANISOTROPY_MAP)) {
        vec2 d = 2.0 * texel.rg - 1.0;
        float length_squared = dot(d, d);
        if (length_squared > 0.0) d *= inversesqrt(length_squared);
        p.rotation = vec2(d.x * p.rotation.x - d.y * p.rotation.y, d.x * p.rotation.y + d.y * p.rotation.x);
        p.anisotropy *= texel.b;
    }
    p.thickness_range *= principled_number(texel, image, PRINCIPLED_THICKNESS);
#define COLOR(bit, name, word) \
    if (principled_gives(image.values, bit)) p.name *= texel.rgb;
#define WEIGHT(bit, name, word, place) p.name *= principled_number(texel, image, bit);
#include "shared/principled_record.inc"
}

// Colours and weights of half-float images may exceed 1.
void principled_clamp(inout PrincipledRecord p) {
#define COLOR(bit, name, word) p.name = min(p.name, 1.0);
#define WEIGHT(bit, name, word, place) p.name = min(p.name, 1.0);
#include "shared/principled_record.inc"
}

// The values of the principled material m at a point; its base colour is multiplied by images, too.
PrincipledRecord principled_at(inout MaterialRecord m, Attributes at) {
    uint first = principled_first(m.specular.x);
    PrincipledRecord p = scene_principled(first);
    if ((PRINCIPLED & PRINCIPLED_HAS_IMAGES) == 0u) return p;
    for (uint i = 0u; i < p.images; ++i) {
        principled_apply(p, m.base, scene_principled_image(first + PRINCIPLED_WORDS + i), at);
    }
    m.base = min(m.base, 1.0);
    principled_clamp(p);
    return p;
}

// The probability that a ray does not pass the surface.
float material_opacity(uint i, Attributes at) {
    MaterialTextures textures = scene_material_textures(i);
    float opacity = textures.opacity * texture_number(textures.opacity_texture, at);
    if ((TEXTURED & TEXTURED_VERTEX_COLORS) != 0u && textures.vertex_colors != 0u) opacity *= at.color.a;
    if (textures.cutoff >= 0.0) return opacity >= textures.cutoff ? 1.0 : 0.0;
    return min(opacity, 1.0);  // Images of floats may exceed it.
}

// Factor of the radiance of light `i`.
vec3 light_texture(uint i, Attributes at) {
    if ((TEXTURED & TEXTURED_EMISSION) == 0u) return vec3(1.0);
    return texture_color(scene_light_textures(i).emission, at);
}

#endif
