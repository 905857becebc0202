// What a path, its estimate and its shadow rays are between two of its vertices, and how they begin.
#ifndef INTEGRATOR_PATH_STATE_GLSL
#define INTEGRATOR_PATH_STATE_GLSL

#include "base/ray.glsl"
#include "integrator/guides.glsl"
#include "integrator/surface.glsl"
#include "light/lit_point.glsl"
#include "medium/medium.glsl"
#include "scene/camera.glsl"

// Whether the picture stands before a background, which is seen through ideal transmission.
const bool BEFORE_BACKGROUND = (ENVIRONMENT & ENVIRONMENT_BEHIND_GLASS) != 0u;
const bool HAS_SKY = (ENVIRONMENT & ~ENVIRONMENT_BEHIND_GLASS) != ENVIRONMENT_NONE;

// The state of a path.
struct Path {
    Ray ray;          // The next segment.
    vec3 beta;        // Throughput: the factor of the radiance along `ray` in L.
    float eta_scale;  // Product of the squared relative indices of refraction, by which beta was divided.
    float pdf_bsdf;   // Density with which `ray` was sampled [1/sr].
    bool delta;       // Light samples could not have found `ray`: the camera sent it, or scattering was ideal.
    LitPoint lit;     // The last vertex: see path_lit_point.
    uvec2 media;      // Around `ray`: see medium/medium.glsl.
    uint depth;       // Scattering vertices so far.
    bool clear;       // Nothing but ideal transmission so far; only if BEFORE_BACKGROUND.
    bool alone;       // Only catchers, sky and lights are there; only if HAS_CATCHERS.
    uint crossed;     // Interfaces passed so far; only if VOLUMETRIC.
    bool sealed;      // No light sample comes to where `ray` is; only if WALKS.
    uint iterations;  // Of its rays so far: see ITERATION_LIMIT; only if VOLUMETRIC.
};

// The estimate of a path so far.
struct Estimate {
    vec3 L;        // Radiance along the camera ray [W/(m^2 sr)].
    bool visible;  // The camera ray hit a surface or, if it may see it, the sky.
    vec3 albedo;   // Albedo of the surface that the camera ray hit; 0 if none.
    vec3 normal;   // Its shading normal, world space; 0 if none.
    bool cut;      // The path was cut, since it had too many vertices.
    // Luminance of the throughput with which the path reached the sky by ideal transmission alone, without the factors
    // by which refraction scales radiance; 0 for all other paths. Only if BEFORE_BACKGROUND.
    float transmission;
    // The rest only if HAS_CATCHERS, and the camera ray hit a catcher. `with` is its light with everything there;
    // then L is its light without the rest of the scene. If it reflects, `with` is only what has not met the rest, and
    // `reflected` what has.
    uint catcher;  // CATCHER_*
    vec3 with;
    vec3 reflected;
    bool strayed;   // The path from a catcher that reflects has met the rest of the scene.
    Guides guides;  // Only if HAS_GUIDES.
};

// A ray towards a light sample, which may be blocked.
struct ShadowRay {
    Ray ray;
    float t_max;  // In lengths of ray.d; 0 if there is none to trace.
    vec3 Ld;      // Added to L if the ray is not blocked.
    // Only if VOLUMETRIC; Ld then lacks the transmittance of what is still to be traced.
    uvec2 media;   // Around `ray`.
    uint crossed;  // Interfaces passed so far.
};

// A path that begins with a camera ray within these media, and an empty estimate.
Path path_begin(Ray ray, uvec2 media) {
    return Path(ray, vec3(1.0), 1.0, 0.0, true, lit_anywhere(ray.o), NESTED_MEDIA ? media : MEDIA_NONE, 0u, true, false,
                0u, false, 0u);
}

// Whether the path is as long as it may be.
bool path_is_long(Path path) {
    return path.depth == DEPTH_SAFETY_LIMIT || VOLUMETRIC && path.iterations > ITERATION_LIMIT;
}

// Whether the path begins where the camera does not see anything: its throughput is then 0.
bool path_is_blind(Path path) {
    return IS_FISHEYE && path.depth == 0u && path.beta == vec3(0.0);
}

Estimate estimate_begin() {
    return Estimate(vec3(0.0), false, vec3(0.0), vec3(0.0), false, 0.0, CATCHER_NONE, vec3(0.0), vec3(0.0), false,
                    guides_begin());
}

// Notes that the path's first hit is a catcher, if it is one. Returns whether it is a holdout, with which the path ends
// as if nothing were there.
bool estimate_catch(inout Estimate estimate, inout Path path, ShadedSurface x) {
    if (is_in_medium(x)) return false;
    uint catcher = scene_material_textures(x.s.material).catcher;
    if (catcher == CATCHER_HOLDOUT) {
        estimate.visible = false;
        estimate.transmission = 1.0;
        return true;
    }
    estimate.catcher = catcher;
    if (catcher != CATCHER_NONE) path.clear = false;
    return false;
}

// Keeps what the estimate holds as light that has not met the rest of the scene, if the path meets it first at x.
void estimate_stray(inout Estimate estimate, ShadedSurface x) {
    if (estimate.catcher != CATCHER_REFLECTIONS || estimate.strayed) return;
    if (x.s.light != NO_LIGHT) return;
    if (!is_in_medium(x) && scene_material_textures(x.s.material).catcher != CATCHER_NONE) return;
    estimate.strayed = true;
    estimate.with = estimate.L;
    estimate.L = vec3(0.0);
}

// Makes the estimate of a path from a catcher ready for the path without the rest of the scene.
void estimate_turn(inout Estimate estimate) {
    if (estimate.strayed) {
        estimate.reflected = estimate.L;
    } else {
        estimate.with = estimate.L;
    }
    estimate.strayed = false;
    estimate.L = vec3(0.0);
}

ShadowRay shadow_none() {
    return ShadowRay(Ray(vec3(0.0), vec3(0.0)), 0.0, vec3(0.0), MEDIA_NONE, 0u);
}

#endif
