// Media between surfaces, and those that a path is in.
//
// Solids may nest and overlap. If several media are at one point, the one of the highest priority fills it; if
// priorities are equal, the one that the path entered last. Ref: Schmidt and Budge 2002, Simple Nested Dielectrics in
// Ray Traced Images, which leaves equal priorities open.
#ifndef MEDIUM_MEDIUM_GLSL
#define MEDIUM_MEDIUM_GLSL

#include "medium/distance.glsl"
#include "scene/scene_data.glsl"

// The media around a point, MEDIUM_BITS each, the one that fills it first, MEDIUM_NONE after the last. If media do not
// nest, only the first is used.
const uvec2 MEDIA_NONE = uvec2(MEDIUM_NONE);

uvec4 media_unpack(uvec2 media) {
    return uvec4(media.x & 0xFFFFu, media.x >> MEDIUM_BITS, media.y & 0xFFFFu, media.y >> MEDIUM_BITS);
}

uvec2 media_pack(uvec4 m) {
    return uvec2(m.x | m.y << MEDIUM_BITS, m.z | m.w << MEDIUM_BITS);
}

// The medium that fills the point.
uint media_first(uvec2 media) {
    return NESTED_MEDIA ? media.x & 0xFFFFu : media.x;
}

// The media after entering `medium`; if they are more than MEDIA_AT_ONCE, the last is lost.
uvec2 media_entered(uvec2 media, uint medium) {
    uvec4 m = media_unpack(media);
    bvec4 after = lessThanEqual(m >> MEDIUM_INDEX_BITS, uvec4(medium >> MEDIUM_INDEX_BITS));
    return media_pack(uvec4(after.x ? medium : m.x, after.x ? m.x : (after.y ? medium : m.y),
                            after.y ? m.y : (after.z ? medium : m.z), after.z ? m.z : (after.w ? medium : m.w)));
}

// The media after leaving `medium`; the same if it is not one of them.
uvec2 media_left(uvec2 media, uint medium) {
    uvec4 m = media_unpack(media);
    bvec4 here = equal(m, uvec4(medium));
    bool second = here.x || here.y;
    bool third = second || here.z;
    return media_pack(
        uvec4(here.x ? m.y : m.x, second ? m.z : m.y, third ? m.w : m.z, third || here.w ? MEDIUM_NONE : m.w));
}

// The media beyond a surface that is reached through `here` and has `behind` at its back.
uvec2 media_beyond(uvec2 here, uint behind, bool front) {
    if (behind == MEDIUM_SAME) return here;
    if (!NESTED_MEDIA) return uvec2(front ? behind : MEDIUM_NONE, 0u);
    return front ? media_entered(here, behind) : media_left(here, behind);
}

// Fraction of the light that the medium transmits over that distance. Ref: Beer and Lambert's law.
vec3 media_transmittance(uvec2 media, float distance) {
    if (!HAS_MEDIA) return vec3(1.0);
    return exp(-min(distance, FAR) * medium_extinction(scene_medium(media_first(media))));
}

// The index of refraction beyond a boundary over that before it; 1, exactly, if the indices are equal, or the same
// medium fills both sides, as when one is entered within another of a higher priority. With `own_eta`, the surface's
// own ratio `eta` is used.
float media_eta(uvec2 here, uvec2 beyond, bool own_eta, float eta) {
    uint from = media_first(here);
    uint to = media_first(beyond);
    if (from == to) return 1.0;
    float above = scene_medium(to).ior, below = scene_medium(from).ior;
    return own_eta ? eta : above == below ? 1.0 : above / below;  // Division may be off by a little.
}

#endif
