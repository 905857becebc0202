// Record of the constants of an image, 13 words of uvec4 in a uniform buffer; and the push constants of one
// dispatch.
//
//   0: position.xyz, seed         6: lens_y.xyz, blades
//   1: right.xyz, max_depth       7: environment_size.xy, environment_turn.xy
//   2: up.xyz, rr_depth           8: camera_media.xy, fisheye_edge
//   3: forward.xyz, first_sample  9: principal_point.xy
//   4: full_size.xy, crop.xy      10 to 12: lights
//   5: lens_x.xyz, focal_distance
#ifndef SHARED_PARAMETERS_H
#define SHARED_PARAMETERS_H

#include "shared/light.h"
#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint PARAMETERS_WORDS = 13u;

struct Parameters {
    // The pinhole ray through film position s has the direction forward + s.x right + s.y up, where s is the
    // distance from the principal point, x to the right and y up, in halves of the picture's width and height:
    // `right` and `up` are scaled by the tangents of half the field of view. If the camera is orthographic, the
    // ray has the direction forward and begins at position + s.x right + s.y up. If it is equirectangular, both
    // are unit vectors; of a fisheye, s.x right + s.y up has length 1 at the edge of its circle.
    vec3 position;
    vec3 right;
    vec3 up;
    vec3 forward;
    uvec2 full_size;       // Pixels of the whole picture.
    vec2 principal_point;  // From its top left corner, in halves of its width and height; (1, 1): in the middle.
    uvec2 crop;            // Top left pixel of the accumulation image in the whole picture.
    uint seed;
    uint max_depth;  // The most scattering vertices, <= DEPTH_SAFETY_LIMIT.
    uint rr_depth;   // Bounces without Russian roulette.
    LightGroups lights;
    uvec2 environment_size;  // Texels.
    vec2 environment_turn;   // Cosine and sine of the environment's rotation about +Y.
    vec3 lens_x;             // The point (x, y) of an aperture of radius 1 is position + x lens_x + y lens_y.
    vec3 lens_y;
    float focal_distance;  // Along `forward`.
    uint blades;           // Corners of a polygonal aperture.
    uint first_sample;     // Index of the first sample of every pixel.
    uvec2 camera_media;    // Around the camera: see medium/medium.glsl.
    // What the edge of a fisheye's circle shows: its angle to the axis in turns, or, if it is equisolid, the sine of
    // half of it; in (0, 0.5] and (0, 1].
    float fisheye_edge;
};

// Neighbouring invocations that a device may compute side by side, in loops that end for all at once.
const uint LANES = 8u;

// One dispatch: a rectangle of the accumulation image whose pixels are brought to `target_samples` samples
// each.
struct Tile {
    uvec2 origin;
    uvec2 size;
    uvec2 stride;  // Group i of the dispatch has place i * stride modulo the number of groups, on each axis.
    uint target_samples;
    uint lane;  // Only invocations with this number in their group, modulo LANES, render; LANES: all do.
};

#ifdef __cplusplus

inline std::array<uvec4, PARAMETERS_WORDS> pack(const Parameters& p) {
    const auto lights = pack(p.lights);
    return {
        word(p.position, p.seed),
        word(p.right, p.max_depth),
        word(p.up, p.rr_depth),
        word(p.forward, p.first_sample),
        uvec4(p.full_size.x, p.full_size.y, p.crop.x, p.crop.y),
        word(p.lens_x, floatBitsToUint(p.focal_distance)),
        word(p.lens_y, p.blades),
        uvec4(p.environment_size.x, p.environment_size.y, floatBitsToUint(p.environment_turn.x),
              floatBitsToUint(p.environment_turn.y)),
        uvec4(p.camera_media.x, p.camera_media.y, floatBitsToUint(p.fisheye_edge), 0),
        uvec4(floatBitsToUint(p.principal_point.x), floatBitsToUint(p.principal_point.y), 0, 0),
        lights[0],
        lights[1],
        lights[2],
    };
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
    p.first_sample = w[3].w;
    p.full_size = w[4].xy;
    p.crop = w[4].zw;
    p.lens_x = uintBitsToFloat(w[5].xyz);
    p.focal_distance = uintBitsToFloat(w[5].w);
    p.lens_y = uintBitsToFloat(w[6].xyz);
    p.blades = w[6].w;
    p.environment_size = w[7].xy;
    p.environment_turn = uintBitsToFloat(w[7].zw);
    p.camera_media = w[8].xy;
    p.fisheye_edge = uintBitsToFloat(w[8].z);
    p.principal_point = uintBitsToFloat(w[9].xy);
    p.lights = light_groups_unpack(w[10], w[11], w[12]);
    return p;
}

#endif

#endif
