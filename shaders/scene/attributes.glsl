// Vertex attributes of primitives, interpolated at a point.
#ifndef SCENE_ATTRIBUTES_GLSL
#define SCENE_ATTRIBUTES_GLSL

#include "base/math.glsl"
#include "scene/scene_data.glsl"
#include "texture/decode.glsl"

// The attributes of a surface at a point; 0, or white, if the scene has none.
struct Attributes {
    vec2 uv0;  // Texture coordinates, v upwards.
    vec2 uv1;
    vec4 color;    // Linear red, green, blue, and alpha.
    vec4 tangent;  // x, y, z: the direction in which u grows, about unit length; w: 1, or -1 if v grows along -cross(n,
                   // tangent).
};

// The place of an attribute look-up: the triangle a b c or a c d (second) of the primitive at a position in leaf order,
// at surface coordinates b; on a sphere, n points from its centre to the point, at any length.
struct AttributePlace {
    uint primitive;
    bool second;
    vec2 b;
    bool on_sphere;
    vec3 n;
};

vec2 interpolate(uvec4 ab, uvec4 cd, bool second, vec2 b) {
    vec2 v0 = uintBitsToFloat(ab.xy);
    vec2 v1 = uintBitsToFloat(second ? cd.xy : ab.zw);
    vec2 v2 = uintBitsToFloat(second ? cd.zw : cd.xy);
    return v0 + (b.x * (v1 - v0) + b.y * (v2 - v0));
}

vec4 color_decode(uvec2 rgba) {
    return vec4(half_decode(rgba.x & 0xFFFFu), half_decode(rgba.x >> 16u), half_decode(rgba.y & 0xFFFFu),
                half_decode(rgba.y >> 16u));
}

// On a sphere, u goes around +Y from +X towards -Z, v from 0 at -Y to 1 at +Y.
vec2 sphere_uv(vec3 n) {
    return vec2(angle_turn(-n.z, n.x), 2.0 * angle_turn(length(n.xz), -n.y));
}

Attributes attributes_at(AttributePlace place) {
    Attributes at = Attributes(vec2(0.0), vec2(0.0), vec4(1.0), vec4(0.0));
    uvec4 ab, cd;
    if ((ATTRIBUTES & ATTRIBUTE_UV0) != 0u) {
        scene_attributes(place.primitive, 0u, ab, cd);
        at.uv0 = interpolate(ab, cd, place.second, place.b);
    }
    if ((ATTRIBUTES & ATTRIBUTE_UV1) != 0u) {
        scene_attributes(place.primitive, UV1_WORD, ab, cd);
        at.uv1 = interpolate(ab, cd, place.second, place.b);
    }
    if ((ATTRIBUTES & (ATTRIBUTE_UV0 | ATTRIBUTE_UV1)) != 0u && place.on_sphere) {
        at.uv0 = at.uv1 = sphere_uv(place.n);
    }
    if ((ATTRIBUTES & ATTRIBUTE_COLOR) != 0u) {
        scene_attributes(place.primitive, COLOR_WORD, ab, cd);
        vec4 v0 = color_decode(ab.xy);
        vec4 v1 = color_decode(place.second ? cd.xy : ab.zw);
        vec4 v2 = color_decode(place.second ? cd.zw : cd.xy);
        at.color = v0 + (place.b.x * (v1 - v0) + place.b.y * (v2 - v0));
    }
    if ((ATTRIBUTES & ATTRIBUTE_TANGENT) != 0u) {
        uvec4 t = scene_tangents(place.primitive);
        if (place.second) t.yz = t.zw;
        vec2 b = place.b;
        at.tangent = vec4(
            (1.0 - b.x - b.y) * octahedral_unpack(t.x) + b.x * octahedral_unpack(t.y) + b.y * octahedral_unpack(t.z),
            (t.x & TANGENT_MIRRORED) != 0u ? -1.0 : 1.0);
        if (place.on_sphere) at.tangent = vec4(normalize(vec3(place.n.z, 0.0, -place.n.x)), 1.0);
    }
    return at;
}

#endif
