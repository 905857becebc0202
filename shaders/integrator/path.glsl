// The path integrator: estimates the rendering equation along one path, a vertex per call.
//
// Ref: Kajiya 1986, The Rendering Equation; Veach 1997, Robust Monte Carlo Methods for Light Transport Simulation,
// chapters 8 to 10.
#ifndef INTEGRATOR_PATH_GLSL
#define INTEGRATOR_PATH_GLSL

#include "base/sampler.glsl"
#include "bsdf/bsdf.glsl"
#include "light/light_sampler.glsl"
#include "scene/interaction.glsl"

// How direct light is found. A scene without lights must use ESTIMATOR_BSDF: asking the parameters instead would make
// lavapipe 22.3 compile the kernel anew at every dispatch, as it does wherever a branch depends on uniforms alone.
layout(constant_id = CONSTANT_ESTIMATOR) const uint ESTIMATOR = ESTIMATOR_MIS;

// Survival is never more likely than this, so that every path ends.
const float RR_MAX_SURVIVAL = 0.95;

// A path on its way, and what it has gathered.
struct Path {
    Ray ray;          // The next segment.
    vec3 beta;        // Throughput: what the radiance along `ray` counts in L.
    float eta_scale;  // Removes the squares of relative indices from beta; no BSDF refracts yet.
    float pdf_bsdf;   // Density with which `ray` was sampled [1/sr].
    uint depth;       // Scattering vertices so far.

    vec3 L;        // Radiance along the camera ray [W/(m^2 sr)].
    bool visible;  // The camera ray met a surface ...
    vec3 albedo;   // ... of this albedo ...
    vec3 normal;   // ... and shading normal, world space; both 0 if it met none.
    uint rays;     // Rays traced.
    bool cut;      // Ended by DEPTH_SAFETY_LIMIT.
};

// The path that begins with a camera ray.
Path path_begin(Ray ray) {
    return Path(ray, vec3(1.0), 1.0, 0.0, 0u, vec3(0.0), false, vec3(0.0), vec3(0.0), 0u, false);
}

// Weight of the emission of light l that the path's ray met at s, `t` metres away.
float emission_weight(Path path, Light l, Interaction s, float t) {
    if (path.depth == 0u || ESTIMATOR == ESTIMATOR_BSDF) return 1.0;  // Light samples cannot reach the camera.
    if (ESTIMATOR == ESTIMATOR_LIGHT) return 0.0;
    return power_heuristic(path.pdf_bsdf, area_light_pdf_li(l, square(t), dot(s.wo, s.n)));
}

// Radiance that a point on a light sends through s to the path's beginning, divided by its density, weighted.
vec3 direct_light(inout Path path, Interaction s, Frame frame, vec3 wo, MaterialRecord material, uint uc, vec2 u) {
    LightSample light = light_sample_li(s.p, uc, u);
    vec3 wi = frame_to_local(frame, light.wi);
    vec3 Ld = path.beta * bsdf_f(material, wo, wi) * abs(wi.z) * light.Li;
    if (light.pdf == 0.0 || dot(light.wi, s.n) <= 0.0 || Ld == vec3(0.0)) return vec3(0.0);
    vec3 from = offset_origin(s.p, s.n);
    vec3 to = offset_origin(light.p, light.n);
    ++path.rays;
    if (bvh_occluded(Ray(from, to - from), 1.0)) return vec3(0.0);
    float weight = ESTIMATOR == ESTIMATOR_MIS ? power_heuristic(light.pdf, bsdf_pdf(material, wo, wi)) : 1.0;
    return weight * Ld / light.pdf;
}

// Takes the path to its next vertex and scatters it there; returns whether it goes on.
bool path_step(inout Path path, Sampler random, Parameters parameters) {
    // Find the nearest surface.
    Hit hit = bvh_intersect(path.ray);
    ++path.rays;
    if (hit.t == FLOAT_MAX) return false;
    Interaction s = interaction_at(path.ray, hit);
    MaterialRecord material = scene_material(s.material);
    if (path.depth == 0u) {
        path.visible = true;
        path.albedo = bsdf_albedo(material);
        path.normal = s.ns;
    }

    // Add what it emits; light samples of the vertex before may already account for a part.
    if (s.light != NO_LIGHT) {
        Light l = scene_light(s.light);
        path.L += emission_weight(path, l, s, hit.t) * path.beta * area_light_le(l, s.front);
    }

    // End at the last scattering vertex.
    if (path.depth == parameters.max_depth) {
        path.cut = path.depth == DEPTH_SAFETY_LIMIT;
        return false;
    }
    Frame frame = frame_from_z(s.ns);
    vec3 wo = frame_to_local(frame, s.wo);
    uint pair = PAIR_FIRST_BOUNCE + path.depth * PAIRS_PER_BOUNCE;
    uvec2 choice = sampler_pair(random, pair + PAIR_CHOICE);

    // Add direct light.
    if (ESTIMATOR != ESTIMATOR_BSDF) {
        vec2 u = unit_float(sampler_pair(random, pair + PAIR_LIGHT));
        path.L += direct_light(path, s, frame, wo, material, choice.x, u);
    }

    // Scatter. A direction below the geometric surface carries nothing.
    BsdfSample scattered = bsdf_sample_f(material, wo, choice.y, unit_float(sampler_pair(random, pair + PAIR_BSDF)));
    vec3 wi = frame_to_world(frame, scattered.wi);
    path.beta *= scattered.weight;
    if (scattered.pdf == 0.0 || max_component(path.beta) == 0.0 || dot(wi, s.n) <= 0.0) return false;
    path.pdf_bsdf = scattered.pdf;
    path.ray = interaction_spawn_ray(s, wi);

    // Russian roulette: paths that carry little end early, the others carry their share.
    // Ref: Arvo and Kirk 1990, Particle Transport and Image Synthesis.
    if (path.depth >= parameters.rr_depth) {
        float survival = min(RR_MAX_SURVIVAL, max_component(path.beta) * path.eta_scale);
        if (unit_float(sampler_pair(random, pair + PAIR_ROULETTE).x) >= survival) return false;
        path.beta /= survival;
    }
    ++path.depth;
    return true;
}

#endif
