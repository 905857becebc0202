// The path integrator: estimates the rendering equation along one path. This is what it does:
//
//     L = 0, beta = 1, ray = camera ray
//     for (depth = 0;; ++depth)
//         find the nearest hit along the ray
//         if there is none: L += beta * weight * radiance of the sky; stop
//         beta *= transmittance of the medium up to the hit
//         L += beta * weight * radiance that the surface emits
//         if depth = max_depth: stop
//         sample a point on a light; if nothing is in between: L += beta * weight * f cos Li / pdf
//         sample a direction of the BSDF: beta *= f cos / pdf, ray = from the hit in that direction
//         if depth >= rr_depth: stop with the probability 1 - q, else beta /= q
//
// path_step is one turn without the search for the hit: the kernel traces the rays of many paths side by side. It does so
// for the light sample's ray of one turn together with the next turn's ray.
//
// Ref: Kajiya 1986, The Rendering Equation; Veach 1997, Robust Monte Carlo Methods for Light Transport Simulation,
// chapters 8 to 10.
#ifndef INTEGRATOR_PATH_GLSL
#define INTEGRATOR_PATH_GLSL

#include "base/sampler.glsl"
#include "bsdf/bsdf.glsl"
#include "light/light_sampler.glsl"
#include "scene/interaction.glsl"

// Survival is never more likely than this, so that every path ends.
const float RR_MAX_SURVIVAL = 0.99;

// A path on its way.
struct Path {
    Ray ray;          // The next segment.
    vec3 beta;        // Throughput: what the radiance along `ray` counts in L.
    float eta_scale;  // Product of the squared relative indices of refraction, by which beta was divided.
    float pdf_bsdf;   // Density with which `ray` was sampled [1/sr].
    bool delta;       // Light samples could not have found `ray`: the camera sent it, or scattering was ideal.
    vec3 ns;          // Shading normal where `ray` begins.
    vec3 absorption;  // Of the medium around `ray` [1/m].
    uint depth;       // Scattering vertices so far.
};

// What a path has gathered.
struct Estimate {
    vec3 L;        // Radiance along the camera ray [W/(m^2 sr)].
    bool visible;  // The camera ray met a surface, or the sky that it may see.
    vec3 albedo;   // Of the surface that it met,
    vec3 normal;   // and its shading normal, world space; both 0 if it met none.
    bool cut;      // The path ended by DEPTH_SAFETY_LIMIT.
};

// A ray towards a light sample, which may meet something on the way.
struct ShadowRay {
    Ray ray;
    float t_max;  // In lengths of ray.d; 0 if there is none to trace.
    vec3 Ld;      // What L gains if nothing is in the way.
};

// The path that begins with a camera ray, and an estimate of nothing so far.
Path path_begin(Ray ray) {
    return Path(ray, vec3(1.0), 1.0, 0.0, true, vec3(0.0), vec3(0.0), 0u);
}

Estimate estimate_begin() {
    return Estimate(vec3(0.0), false, vec3(0.0), vec3(0.0), false);
}

ShadowRay shadow_none() {
    return ShadowRay(Ray(vec3(0.0), vec3(0.0)), 0.0, vec3(0.0));
}

// The path's last vertex, as it was lit.
LitPoint path_lit_point(Path path) {
    return LitPoint(path.ray.o, path.ns);
}

// Weight of the light that the path met, and that a light sample finds with the density pdf_light [1/sr].
float emission_weight(Path path, float pdf_light) {
    if (path.delta || ESTIMATOR == ESTIMATOR_BSDF) return 1.0;
    if (ESTIMATOR == ESTIMATOR_LIGHT) return pdf_light > 0.0 ? 0.0 : 1.0;
    return power_heuristic(path.pdf_bsdf, pdf_light);
}

// The path's ray left the scene: adds the sky.
void add_environment(Path path, inout Estimate estimate) {
    if (path.depth == 0u && ENVIRONMENT != ENVIRONMENT_VISIBLE) return;
    EnvironmentTexel texel = environment_texel(path.ray.d);
    float pdf_light = environment_pdf_li(texel, path_lit_point(path));
    estimate.L += emission_weight(path, pdf_light) * path.beta * texel.radiance;
    if (path.depth == 0u) estimate.visible = true;
}

// The path's ray met light s.light at s, `t` metres away: adds what it emits.
void add_emission(Path path, inout Estimate estimate, Interaction s, float t) {
    float pdf_light = light_pdf_li(s.light, path_lit_point(path), square(t), dot(s.wo, s.n));
    estimate.L += emission_weight(path, pdf_light) * path.beta * area_light_le(light_at(s.light), s.front);
}

// Share of the light that the medium around the path's ray lets through over that distance [m], which may be infinite:
// then it is cut to a finite one, lest infinity be multiplied by 0. (Compilers that take all numbers for finite may
// leave a min with FLOAT_MAX out.) Ref: Beer and Lambert's law.
vec3 path_transmittance(Path path, float distance) {
    const float far = 1e30;
    if ((MATERIALS & MATERIALS_DIELECTRIC) == 0u) return vec3(1.0);
    return exp(-min(distance, far) * path.absorption);
}

// The ray from s towards a point on a light, and the radiance that this point sends through s to the path's beginning,
// divided by its density, weighted.
ShadowRay direct_light(Path path, Interaction s, Frame frame, vec3 wo, MaterialRecord material, uvec2 u, uint fill) {
    vec3 from = interaction_spawn_origin(s, true);
    LightSample light = light_sample_li(LitPoint(from, s.ns), u, fill);
    vec3 wi = frame_to_local(frame, light.wi);
    vec3 Ld = path.beta * bsdf_f(material, wo, wi) * abs(wi.z) * light.Li;
    // The light is in the medium through which the path came to s.
    Ld *= path_transmittance(path, light.t_max * length(light.shadow));
    bool dark = light.pdf == 0.0 || dot(light.wi, s.n) <= 0.0 || Ld == vec3(0.0);
    float weight = 1.0;
    if (ESTIMATOR == ESTIMATOR_MIS && !light.delta) weight = power_heuristic(light.pdf, bsdf_pdf(material, wo, wi));
    return ShadowRay(Ray(from, light.shadow), dark ? 0.0 : light.t_max, weight * Ld / light.pdf);
}

// Sends the path on in a direction that its last surface was sampled for; returns whether it goes on. `material` is
// that of the front side. A direction on the other side of the geometric surface than of the shading one carries
// nothing.
bool path_scatter(inout Path path, Interaction s, Frame frame, MaterialRecord material, BsdfSample scattered) {
    vec3 wi = frame_to_world(frame, scattered.wi);
    path.beta *= scattered.weight;
    bool viewers_side = scattered.wi.z > 0.0;
    if (scattered.pdf == 0.0 || max_component(path.beta) == 0.0) return false;
    if (viewers_side ? dot(wi, s.n) <= 0.0 : dot(wi, s.n) >= 0.0) return false;
    path.eta_scale *= square(scattered.eta);
    path.pdf_bsdf = scattered.pdf;
    path.delta = scattered.delta;
    path.ns = s.ns;
    if (!viewers_side) path.absorption = s.front ? material.base : vec3(0.0);
    path.ray = Ray(interaction_spawn_origin(s, viewers_side), wi);
    return true;
}

// Takes the path past what its ray has met, or not; returns whether it goes on. `shadow` is the ray to be traced for
// direct light there.
bool path_step(inout Path path, inout Estimate estimate, out ShadowRay shadow, Hit hit, Sampler random,
               Parameters parameters) {
    shadow = shadow_none();
    if (!is_hit(hit)) {
        if (ENVIRONMENT != ENVIRONMENT_NONE) add_environment(path, estimate);
        return false;
    }
    Interaction s = interaction_at(path.ray, hit);
    MaterialRecord material = scene_material(s.material);
    if (path.depth == 0u) {
        estimate.visible = true;
        estimate.albedo = bsdf_albedo(material);
        estimate.normal = s.ns;
    }

    // Lose what the medium on the way absorbs.
    path.beta *= path_transmittance(path, hit.t);

    // Add what the surface emits; light samples of the vertex before may already account for a part.
    if (s.light != NO_LIGHT) add_emission(path, estimate, s, hit.t);

    // End at the last scattering vertex.
    if (path.depth == parameters.max_depth) {
        estimate.cut = path.depth == DEPTH_SAFETY_LIMIT;
        return false;
    }
    Frame frame = frame_from_z(s.ns);
    vec3 wo = frame_to_local(frame, s.wo);
    MaterialRecord seen = bsdf_from_side(material, s.front);
    uint pair = PAIR_FIRST_BOUNCE + path.depth * PAIRS_PER_BOUNCE;
    uvec2 choice = sampler_pair(random, pair + PAIR_CHOICE);

    // Add direct light.
    if (ESTIMATOR != ESTIMATOR_BSDF) {
        shadow = direct_light(path, s, frame, wo, seen, sampler_pair(random, pair + PAIR_LIGHT), choice.x);
    }

    // Scatter.
    vec2 u = unit_float(sampler_pair(random, pair + PAIR_BSDF));
    if (!path_scatter(path, s, frame, material, bsdf_sample_f(seen, wo, unit_float(choice.y), u))) return false;

    // Russian roulette: paths that carry little end early, the others carry their share. The root makes them end a vertex
    // or two later, which costs fewer rays than it saves noise. After ideal scattering nothing but this path can find
    // what it leads to, often a light, and it goes on.
    // Ref: Arvo and Kirk 1990, Particle Transport and Image Synthesis.
    if (path.depth >= parameters.rr_depth) {
        float survival = RR_MAX_SURVIVAL;
        if (!path.delta) survival = min(survival, sqrt(max_component(path.beta) * path.eta_scale));
        if (unit_float(choice.x) >= survival) return false;
        path.beta /= survival;
    }
    ++path.depth;
    return true;
}

#endif
