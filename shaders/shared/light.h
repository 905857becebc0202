// Records of a light or a lamp (4 words of uvec4), of the groups of lights (3 words), of a texel of the
// environment (1 word), and of the entries of tables that choose (two to a word).
//
//   LightRecord                   EnvironmentTexel                 AliasEntry
//     0: p.xyz, kind | spread       0: radiance.rgb, pdf             0: entry 2i: threshold, alias;
//     1: e1.xyz, error |                                                entry 2i + 1: threshold, alias
//     2: e2.xyz, pmf                                               CdfEntry
//     3: radiance.rgb, pdf_area                                      0: entry 2i: last_word, range;
//                                                                       entry 2i + 1: last_word, range
//
//   LightGroups                                          LampRecord
//     0: placed, suns, sun_fraction, sky_fraction          0: node, root, first, kind
//     1: sun_flux                                          1: count, alias, area, mirrored
//     2: sky_flux                                          2: 0, 0, 0, pmf
//                                                          3: 0, 0, 0, 0
#ifndef SHARED_LIGHT_H
#define SHARED_LIGHT_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint LIGHT_WORDS = 4u;
const uint LIGHT_GROUPS_WORDS = 3u;
const uint ENVIRONMENT_TEXEL_WORDS = 1u;
const uint ALIAS_WORDS = 1u;  // Words of two entries.
const uint CDF_WORDS = 1u;    // Words of two entries.

const uint LIGHT_TRIANGLE = 0u;       // p + b1 e1 + b2 e2 with b1, b2 >= 0, b1 + b2 <= 1.
const uint LIGHT_PARALLELOGRAM = 1u;  // p + b1 e1 + b2 e2 with b1, b2 in [0, 1].
const uint LIGHT_DISK = 2u;           // p + b1 e1 + b2 e2 with b1^2 + b2^2 <= 1.
const uint LIGHT_SPHERE = 3u;         // Centre p, radius e1.x.
const uint LIGHT_ENVIRONMENT = 4u;    // All around, infinitely far away; its texels are in tables of their own.
const uint LIGHT_POINT = 5u;          // At p, equal in all directions.
const uint LIGHT_SPOT = 6u;           // At p, around the unit axis e1. For a direction of which 1 - cos of the angle
                                      // to the axis is h, its intensity has the factor saturate((e2.x - h) e2.y)^2.
const uint LIGHT_DIRECTIONAL = 7u;    // Infinitely far away in the unit direction e1.

const uint LIGHT_SUN = 9u;  // A disk infinitely far away, around the unit direction e1; 1 - cos of the angle from there
                            // to its edge is e2.x.

const uint LIGHT_LAMP = 8u;  // An instance of a mesh that emits: a LampRecord.

// A sphere that emits in a cone. Centre p, radius e1.x, axis (e1.y, e1.z, e2.z) of unit length. In a direction of which
// 1 - cos of the angle to the axis is h, its radiance has the factor t^2 with t = saturate((e2.x - h) |e2.y|), or
// smoothstep of the same number if e2.y is below 0.
const uint LIGHT_BEAM = 10u;

const uint LIGHT_KINDS = 31u;   // The bits of a record's word that hold the kind; the others are those of its spread.
const uint LIGHT_SPREAD = 31u;  // No kind: that bit of LIGHTS is set if some light has a spread other than 0.

// An emitter. The front of a flat one is the side that cross(e1, e2) points to, that of a sphere is outside.
// No ray hits points, spots and directional lights; rays that leave the scene hit suns. In the frame of the scene, or
// in the space of a lamp's mesh.
struct LightRecord {
    uint kind;  // LIGHT_*
    vec3 p;
    vec3 e1;
    vec3 e2;         // Of a spot: 1 - cos of its outer angle, one over the range of cosines in which it falls off, and
                     // 0 if by the square, 1 if by smoothstep.
    vec3 radiance;   // [W/(m^2 sr)], constant over the surface; of a point or spot light its intensity [W/sr], of a
                     // directional one the irradiance across it [W/m^2].
    float spread;    // At the angle a to the normal, the radiance of a surface has the factor
                     // max(0, 1 - spread tan(a)); >= 0. Its lowest bits, LIGHT_KINDS, are 0.
    uint two_sided;  // 1: emits from the back as well.
    float pdf_area;  // Density of a point on it, chosen uniformly by area [1/m^2]; 0 if it has no surface.
    float pmf;       // Probability of choosing the light among all.
    float error;     // Distance from its points, along the normal, at which rays towards it must end; >= 0.
};

// A lamp, in the place of a light's record. Its lights are triangles of a mesh, in the mesh's space. All lamps that
// show the mesh share them, the tree over them, and the table that chooses one by its power.
struct LampRecord {
    uint node;      // Of the record of its instance, which is a similarity.
    uint root;      // Of the tree over its lights, among all nodes of light trees.
    uint first;     // The first of its lights in the table of lights,
    uint count;     // and their number.
    uint alias;     // First entry of their alias table.
    uint mirrored;  // 1: the instance is.
    float area;     // An area in the frame of the scene, divided by the same in the mesh's space.
    float pmf;      // Probability of choosing the lamp among all lights.
};

// The division of the choice among lights. Their table has first the lights with a place in the scene, lamps among
// them, then the suns, which directional lights are, too, then the sky, if it is a light; and then the lights of lamps,
// whose pmf is that of the choice within a lamp. Each of the first two groups has its own alias table; the suns' table
// comes second, and those of lamps follow.
struct LightGroups {
    uint placed;
    uint suns;
    uint sun_fraction;  // Probability of choosing some sun, in units of 2^-31.
    uint sky_fraction;  // Probability of choosing the sky. The others have the rest.
    // The estimated irradiance of a surface with the normal n by all suns is max(0, dot(n, xyz) + w); divided by
    // the strength of the tree over the others, if there are any.
    vec4 sun_flux;
    vec4 sky_flux;  // The same for the sky.
};

// A piece of the sky in latitude and longitude.
struct EnvironmentTexel {
    vec3 radiance;  // [W/(m^2 sr)], constant over the texel.
    float pdf;      // Of sampling a direction in it, in proportion to luminance [1/sr]; 0 if the environment is
                    // not a light.
};

// Entry i of an alias table of n: column i is kept with probability threshold / 2^32, otherwise the sample is
// `alias`.
struct AliasEntry {
    uint threshold;
    uint alias;
};

const uint CDF_PLACE_BITS = 20u;
const uint CDF_MAX_PLACES = 1u << CDF_PLACE_BITS;
const uint CDF_MANY_MORE = 4095u;  // Or beyond.

// Entry i of a table by which random words choose one of n places in their order: those up to last_word, and
// beyond that of the entry before, choose place i. (Places before the first that can be chosen have 2^32 - 1.)
// The words in the i-th of n equal parts choose the first place in the lowest CDF_PLACE_BITS of `range` or one
// of the next few; the other bits say how many.
struct CdfEntry {
    uint last_word;
    uint range;
};

#ifdef __cplusplus

inline std::array<uvec4, LIGHT_WORDS> pack(const LightRecord& l) {
    return {word(l.p, l.kind | (floatBitsToUint(l.spread) & ~LIGHT_KINDS)),
            word(l.e1, floatBitsToUint(l.error) | l.two_sided << 31), word(l.e2, floatBitsToUint(l.pmf)),
            word(l.radiance, floatBitsToUint(l.pdf_area))};
}

inline std::array<uvec4, LIGHT_WORDS> pack(const LampRecord& l) {
    return {uvec4(l.node, l.root, l.first, LIGHT_LAMP), uvec4(l.count, l.alias, floatBitsToUint(l.area), l.mirrored),
            uvec4(0, 0, 0, floatBitsToUint(l.pmf)), uvec4(0)};
}

inline std::array<uvec4, LIGHT_GROUPS_WORDS> pack(const LightGroups& g) {
    return {uvec4(g.placed, g.suns, g.sun_fraction, g.sky_fraction), std::bit_cast<uvec4>(g.sun_flux),
            std::bit_cast<uvec4>(g.sky_flux)};
}

inline std::array<uvec4, ENVIRONMENT_TEXEL_WORDS> pack(const EnvironmentTexel& t) {
    return {word(t.radiance, floatBitsToUint(t.pdf))};
}

inline std::array<uvec4, ALIAS_WORDS> pack(const AliasEntry& even, const AliasEntry& odd) {
    return {uvec4(even.threshold, even.alias, odd.threshold, odd.alias)};
}

inline std::array<uvec4, CDF_WORDS> pack(const CdfEntry& even, const CdfEntry& odd) {
    return {uvec4(even.last_word, even.range, odd.last_word, odd.range)};
}

}  // namespace candela
#else

// spread: whether some light may have a spread other than 0.
LightRecord light_unpack(uvec4 a, uvec4 b, uvec4 c, uvec4 d, bool spread) {
    LightRecord l;
    l.p = uintBitsToFloat(a.xyz);
    l.kind = spread ? a.w & LIGHT_KINDS : a.w;
    l.spread = spread ? uintBitsToFloat(a.w & ~LIGHT_KINDS) : 0.0;
    l.e1 = uintBitsToFloat(b.xyz);
    l.two_sided = b.w >> 31u;
    l.error = uintBitsToFloat(b.w & 0x7FFFFFFFu);
    l.e2 = uintBitsToFloat(c.xyz);
    l.pmf = uintBitsToFloat(c.w);
    l.radiance = uintBitsToFloat(d.xyz);
    l.pdf_area = uintBitsToFloat(d.w);
    return l;
}

LampRecord lamp_unpack(uvec4 a, uvec4 b, uvec4 c) {
    LampRecord l;
    l.node = a.x;
    l.root = a.y;
    l.first = a.z;
    l.count = b.x;
    l.alias = b.y;
    l.area = uintBitsToFloat(b.z);
    l.mirrored = b.w;
    l.pmf = uintBitsToFloat(c.w);
    return l;
}

LightGroups light_groups_unpack(uvec4 a, uvec4 b, uvec4 c) {
    return LightGroups(a.x, a.y, a.z, a.w, uintBitsToFloat(b), uintBitsToFloat(c));
}

EnvironmentTexel environment_texel_unpack(uvec4 a) {
    EnvironmentTexel t;
    t.radiance = uintBitsToFloat(a.xyz);
    t.pdf = uintBitsToFloat(a.w);
    return t;
}

// Entry i, out of word i / 2.
AliasEntry alias_unpack(uvec4 a, uint i) {
    return (i & 1u) == 0u ? AliasEntry(a.x, a.y) : AliasEntry(a.z, a.w);
}

CdfEntry cdf_unpack(uvec4 a, uint i) {
    return (i & 1u) == 0u ? CdfEntry(a.x, a.y) : CdfEntry(a.z, a.w);
}

#endif

#endif
