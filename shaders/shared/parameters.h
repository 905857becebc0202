// Record of everything that stays the same while an image is rendered, 6 words of uvec4 in a uniform buffer;
// and the push constants of one dispatch.
//
//   0: position.xyz, seed             3: forward.xyz, light_count
//   1: right.xyz,    max_depth        4: full_size.xy, crop.xy
//   2: up.xyz,       rr_depth         5: first words in the tables buffer: normals, materials, lights, alias
#ifndef SHARED_PARAMETERS_H
#define SHARED_PARAMETERS_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint PARAMETERS_WORDS = 6u;

struct Parameters {
    // The pinhole ray through film position s in [-1, 1]^2 (x to the right, y up) has the direction
    // forward + s.x right + s.y up: `right` and `up` are scaled by the tangents of half the field of view.
    vec3 position;
    vec3 right;
    vec3 up;
    vec3 forward;
    uvec2 full_size;  // Pixels of the whole picture.
    uvec2 crop;       // Top left pixel of the accumulation image in the whole picture.
    uint seed;
    uint max_depth;  // Scattering vertices at most, <= DEPTH_SAFETY_LIMIT.
    uint rr_depth;   // Bounces that always survive.
    uint light_count;
    uvec4
        tables;  // Where each table begins in the tables buffer, in words: normals, materials, lights, alias.
};

// One dispatch: a rectangle of the accumulation image whose pixels are brought to `target_samples` samples
// each.
struct Tile {
    uvec2 origin;
    uvec2 size;
    uint target_samples;
};

#ifdef __cplusplus

inline std::array<uvec4, PARAMETERS_WORDS> pack(const Parameters& p) {
    return {words(p.position, p.seed),
            words(p.right, p.max_depth),
            words(p.up, p.rr_depth),
            words(p.forward, p.light_count),
            uvec4(p.full_size.x, p.full_size.y, p.crop.x, p.crop.y),
            p.tables};
}

}  // namespace candela
#else

Parameters parameters_unpack(uvec4 w[PARAMETERS_WORDS]) {
    return Parameters(uintBitsToFloat(w[0].xyz), uintBitsToFloat(w[1].xyz), uintBitsToFloat(w[2].xyz),
                      uintBitsToFloat(w[3].xyz), w[4].xy, w[4].zw, w[0].w, w[1].w, w[2].w, w[3].w, w[5]);
}

#endif

#endif
