// Record of everything that stays the same while an image is rendered, 10 words of uvec4 in a uniform buffer;
// and the push constants of one dispatch.
//
//   0: position.xyz, seed         5: first words in the tables: normals, materials, lights, alias table
//   1: right.xyz, max_depth       6: first words of the environment: texels, alias table; its size.xy
//   2: up.xyz, rr_depth           7: lens_x.xyz, focal_distance
//   3: forward.xyz, light_count   8: lens_y.xyz, blades
//   4: full_size.xy, crop.xy      9: environment_turn.xy, first word of the surfaces, first_sample
#ifndef SHARED_PARAMETERS_H
#define SHARED_PARAMETERS_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint PARAMETERS_WORDS = 10u;

// Where each table begins in the tables buffer, in words.
struct TableStarts {
    uint surfaces;
    uint normals;
    uint materials;
    uint lights;
    uint light_alias;
    uint environment;
    uint environment_alias;
};

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
    TableStarts tables;
    uvec2 environment_size;  // Texels.
    vec2 environment_turn;   // Cosine and sine of the environment's rotation about +Y.
    vec3 lens_x;             // The point (x, y) of an aperture of radius 1 is position + x lens_x + y lens_y.
    vec3 lens_y;
    float focal_distance;  // Along `forward` [m].
    uint blades;           // Corners of a polygonal aperture.
    uint first_sample;     // Index of the first sample of every pixel.
};

// One dispatch: a rectangle of the accumulation image whose pixels are brought to `target_samples` samples
// each.
struct Tile {
    uvec2 origin;
    uvec2 size;
    uvec2 stride;  // Group i of the dispatch is at place i * stride modulo their number, axis by axis.
    uint target_samples;
};

#ifdef __cplusplus

inline std::array<uvec4, PARAMETERS_WORDS> pack(const Parameters& p) {
    return {
        word(p.position, p.seed),
        word(p.right, p.max_depth),
        word(p.up, p.rr_depth),
        word(p.forward, p.light_count),
        uvec4(p.full_size.x, p.full_size.y, p.crop.x, p.crop.y),
        uvec4(p.tables.normals, p.tables.materials, p.tables.lights, p.tables.light_alias),
        uvec4(p.tables.environment, p.tables.environment_alias, p.environment_size.x, p.environment_size.y),
        word(p.lens_x, floatBitsToUint(p.focal_distance)),
        word(p.lens_y, p.blades),
        uvec4(floatBitsToUint(p.environment_turn.x), floatBitsToUint(p.environment_turn.y), p.tables.surfaces,
              p.first_sample)};
}

}  // namespace candela
#else

Parameters parameters_unpack(uvec4 w[PARAMETERS_WORDS]) {
    Parameters p;
    p.position = uintBitsToFloat(w[0].xyz);
    p.seed = w[0].w;
    p.right = uintBitsToFloat(w[1].xyz);
    p.max_depth = w[1].w;
    p.up = uintBitsToFloat(w[2].xyz);
    p.rr_depth = w[2].w;
    p.forward = uintBitsToFloat(w[3].xyz);
    p.light_count = w[3].w;
    p.full_size = w[4].xy;
    p.crop = w[4].zw;
    p.tables.normals = w[5].x;
    p.tables.materials = w[5].y;
    p.tables.lights = w[5].z;
    p.tables.light_alias = w[5].w;
    p.tables.environment = w[6].x;
    p.tables.environment_alias = w[6].y;
    p.environment_size = w[6].zw;
    p.lens_x = uintBitsToFloat(w[7].xyz);
    p.focal_distance = uintBitsToFloat(w[7].w);
    p.lens_y = uintBitsToFloat(w[8].xyz);
    p.blades = w[8].w;
    p.environment_turn = uintBitsToFloat(w[9].xy);
    p.tables.surfaces = w[9].z;
    p.first_sample = w[9].w;
    return p;
}

#endif

#endif
