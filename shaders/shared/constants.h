// Numbers that the host and the shaders must agree on.
#ifndef SHARED_CONSTANTS_H
#define SHARED_CONSTANTS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace candela {
#endif

// Work group of every image kernel, 8 x 8: software Vulkan runs eight lanes, and narrower groups waste them.
const uint WORKGROUP_SIZE = 8u;

// A path that would scatter more often than this is cut off, counted and reported.
const uint DEPTH_SAFETY_LIMIT = 4096u;
// Where media scatter, so is one whose rays have taken more iterations of loops than this, as Mesa's software driver
// ends all loops of an invocation after 65 535. A vertex outside of walks (integrator/walk.glsl) counts as some more.
const uint ITERATION_LIMIT = 30000u;
const uint ITERATIONS_PER_VERTEX = 32u;

// No light, in Primitive::light.
const uint NO_LIGHT = 0xFFFFFFFFu;

// Estimators of direct light.
const uint ESTIMATOR_BSDF = 0u;   // Emission is only found by BSDF samples.
const uint ESTIMATOR_LIGHT = 1u;  // Emission is only found by light samples (except where they cannot find it).
const uint ESTIMATOR_MIS = 2u;    // Both, weighted by the power heuristic.

// Samplers.
const uint SAMPLER_INDEPENDENT = 0u;
const uint SAMPLER_STRATIFIED = 1u;
const uint SAMPLER_SOBOL = 2u;

// Samplers of lights.
const uint LIGHT_SAMPLER_UNIFORM = 0u;  // All alike.
const uint LIGHT_SAMPLER_POWER = 1u;    // By power, wherever the lit point is.
const uint LIGHT_SAMPLER_TREE = 2u;     // By what they may send to the lit point.

// Dimensions are handed out in pairs. A sample uses PAIR_PIXEL and PAIR_LENS once, then PAIRS_PER_BOUNCE
// pairs at every scattering vertex, starting at PAIR_FIRST_BOUNCE.
const uint PAIR_PIXEL = 0u;
const uint PAIR_LENS = 1u;
const uint PAIR_FIRST_BOUNCE = 2u;
const uint PAIR_LIGHT = 0u;     // The point on a light; its third word: which light.
const uint PAIR_BSDF = 1u;      // Scattered direction; its third word: which lobe of the BSDF.
const uint PAIR_SURVIVAL = 2u;  // Its first word.
const uint PAIRS_PER_BOUNCE = 3u;
// In media that scatter, one more for each of the ray's segments on the way to vertex k: this + k, and the number of
// interfaces passed in the bits from PAIR_CROSSED_SHIFT on.
const uint PAIR_FIRST_DISTANCE = 1u << 14u;
const uint PAIR_CROSSED_SHIFT = 16u;

// Layers of the accumulation image (rgba32f). The value of a sum is sum - compensation (Kahan).
const uint LAYER_L = 0u;                    // rgb: sum of L; a: camera rays that hit something visible.
const uint LAYER_L_COMPENSATION = 1u;       // rgb; a: the pixel's number of samples.
const uint LAYER_SQUARE = 2u;               // rgb: sum of L^2; a: the pixel's limit, see below.
const uint LAYER_SQUARE_COMPENSATION = 3u;  // rgb; a: rays of the pixel's samples, MAX_RAYS at most.
const uint LAYER_ALBEDO = 4u;               // rgb: sum of the first hit's albedo; a: of the transmission.
const uint LAYER_ALBEDO_COMPENSATION = 5u;  // rgb; a.
const uint LAYER_NORMAL = 6u;               // rgb: sum of the first hit's shading normal, world space.
const uint LAYER_NORMAL_COMPENSATION = 7u;  // rgb.
// Of catchers: see Estimate in integrator/path_state.glsl.
const uint LAYER_WITH = 8u;                   // rgb: sum of `with`; a: camera rays that hit a catcher.
const uint LAYER_WITH_COMPENSATION = 9u;      // rgb.
const uint LAYER_WITHOUT = 10u;               // rgb: sum of `without`; a: camera rays that hit one that reflects.
const uint LAYER_WITHOUT_COMPENSATION = 11u;  // rgb.
const uint LAYER_COUNT_COLOUR = 4u;           // Layers of an image without AOVs.
const uint LAYER_COUNT_AOVS = 8u;             // Layers of an image with AOVs.
const uint LAYER_COUNT_CATCHERS = 12u;        // The same with catchers.
// Of what guides denoisers: these follow whatever other layers the image has.
// See integrator/guides.glsl.
const uint GUIDE_ALBEDO = 0u;  // rgb: sum of Guides::albedo; a: sum of its squared length.
const uint GUIDE_ALBEDO_COMPENSATION = 1u;
const uint GUIDE_NORMAL = 2u;               // rgb: sum of Guides::normal.
const uint GUIDE_NORMAL_COMPENSATION = 3u;  // rgb.
const uint LAYER_COUNT_GUIDES = 4u;

// Floats represent every whole number up to this, so sums do not depend on how they are split.
const float MAX_RAYS = 16777216.0;

// A pixel's limit is 0 if there is none, otherwise the most samples that it gets, plus one.

// Words of the counter buffer, for one submission.
const uint COUNTER_RAYS_LOW = 0u;  // Rays of the samples folded, 64 bits in two words.
const uint COUNTER_RAYS_HIGH = 1u;
const uint COUNTER_NONFINITE = 2u;    // Samples that were not finite and added nothing.
const uint COUNTER_DEPTH_LIMIT = 3u;  // Paths cut off at DEPTH_SAFETY_LIMIT.
const uint COUNTER_SAMPLES = 4u;      // Samples folded.
const uint COUNTER_UNFINISHED = 5u;   // Pixels whose loop the driver ended before they had all samples.
const uint COUNTER_COUNT = 6u;

// Descriptor bindings of every kernel that reads the scene. Array i of the scene is texel buffer i; all
// storage buffers are elements of one binding.
const uint BINDING_STORAGE = 16u;
const uint BINDING_PARAMETERS = 17u;
const uint BINDING_IMAGE = 18u;
const uint BINDING_COUNTERS = 19u;
const uint BINDING_ITEMS = 20u;  // Items of probes.
const uint BINDING_RESULTS = 21u;

// Kinds of camera.
const uint CAMERA_PINHOLE = 0u;
const uint CAMERA_DISK = 1u;          // A thin lens with a round aperture,
const uint CAMERA_POLYGON = 2u;       // or with a polygonal one.
const uint CAMERA_ORTHOGRAPHIC = 3u;  // Parallel rays.
const uint CAMERA_EQUIRECTANGULAR = 4u;
const uint CAMERA_FISHEYE = 5u;    // Equidistant.
const uint CAMERA_EQUISOLID = 6u;  // A fisheye that keeps the ratio of solid angles.

// Filters of pixels.
const uint PIXEL_FILTER_SQUARE = 0u;  // The pixel itself.
const uint PIXEL_FILTER_BOX = 1u;     // Of another width.
const uint PIXEL_FILTER_TENT = 2u;
const uint PIXEL_FILTER_GAUSSIAN = 3u;
const uint PIXEL_FILTER_BLACKMAN_HARRIS = 4u;

// Whether surfaces are catchers: see integrator/path_state.glsl.
const uint CATCHERS_NONE = 0u;
const uint CATCHERS_SHOWN = 1u;  // As other surfaces.
const uint CATCHERS_SEEN = 2u;   // As such. Only with LAYER_COUNT_CATCHERS.

// Kinds of environment that a kernel distinguishes.
const uint ENVIRONMENT_NONE = 0u;
const uint ENVIRONMENT_HIDDEN = 1u;  // Camera rays do not see it.
const uint ENVIRONMENT_VISIBLE = 2u;
// Added to one of the first two: camera rays do not see it through ideal transmission either, and the
// throughput with which they reach it is accumulated. Only with LAYER_COUNT_AOVS.
const uint ENVIRONMENT_BEHIND_GLASS = 4u;

#ifdef __cplusplus
}  // namespace candela
#endif

#endif
