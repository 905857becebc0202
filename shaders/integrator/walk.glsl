// Walks of paths within solids that scatter light, and that no light sample reaches: wax, skin, milk in a glass.
//
// What happens there from one scattering vertex to the next needs no surface, no material and no light, so that a
// path takes many of these steps while the rays of its neighbours are traced, and none in the code for surfaces. The
// distance is sampled before the ray is traced, and ends it.
#ifndef INTEGRATOR_WALK_GLSL
#define INTEGRATOR_WALK_GLSL

#include "integrator/path.glsl"

// Whether the path's next vertex, if it lies within the medium, is one of a walk.
bool path_walks(Path path, Estimate estimate, Parameters parameters) {
    return WALKS && path.sealed && path.depth < parameters.max_depth && !path_is_long(path) &&
           !seeks_guides(path, estimate);
}

// Scatters the path at a distance that path_medium_sample returned; returns whether it goes on.
bool path_walk(inout Path path, MediumSample way, Sampler random, Parameters parameters) {
    uint pair = PAIR_FIRST_BOUNCE + path.depth * PAIRS_PER_BOUNCE;
    vec2 u = unit_float(sampler_pair(random, pair + PAIR_BSDF));
    BsdfSample scattered = phase_sample_f(scene_medium(media_first(path.media)).g, u);
    path.ray = Ray(path.ray.o + way.t * path.ray.d, frame_to_world(frame_from_z(-path.ray.d), scattered.wi));
    path.beta *= way.weight;
    if (max_component(path.beta) == 0.0) return false;
    path.delta = false;
    bool survives = true;
    if (path.depth >= parameters.rr_depth) {
        float u_survival = unit_float(sampler_pair(random, pair + PAIR_SURVIVAL).x);
        survives = path_survives(path, true, u_survival, parameters);
    }
    path.delta = true;  // Light samples could not have found `ray`.
    path.clear = false;
    ++path.depth;
    return survives;
}

#endif
