// The path integrator: estimates the rendering equation along one path. This is what it does:
//
//     L = 0, beta = 1, ray = camera ray
//     for (depth = 0;; ++depth)
//         find the nearest hit along the ray
//         if there is none: L += beta * weight * radiance of the sky; stop
//         beta *= transmittance of the medium up to the hit; or the path scatters in the medium before it, by its
//                 phase function instead of a BSDF
//         L += beta * weight * radiance that the surface emits
//         if depth = max_depth: stop
//         sample a point on a light; if nothing is in between: L += beta * weight * f cos Li / pdf
//         sample a direction of the BSDF: beta *= f cos / pdf, ray = from the hit in that direction
//         if depth >= rr_depth: stop with the probability 1 - q, else beta /= q
//
// If the camera ray hits a catcher, the kernel traces a second path by the same random numbers, for which only
// catchers, sky and lights are there: see docs/catcher.md.
//
// path_step is one iteration without the search for the hit: the kernel traces the rays of many paths side by side, and
// traces the shadow ray of one iteration together with the ray of the next.
//
// Ref: Kajiya 1986, The Rendering Equation; Veach 1997, Robust Monte Carlo Methods for Light Transport Simulation,
// chapters 8 to 10.
#ifndef INTEGRATOR_PATH_GLSL
#define INTEGRATOR_PATH_GLSL

#include "base/sampler.glsl"
#include "integrator/path_state.glsl"
#include "integrator/surface.glsl"
#include "light/light_sampler.glsl"
#include "medium/medium.glsl"
#include "scene/camera.glsl"
#include "scene/interaction.glsl"

// Survival is never more likely than this, so that every path ends.
const float RR_MAX_SURVIVAL = 0.99;

// The point of a surface for which lights are sampled. Rays begin at an offset from the surface, on the side to which
// they leave. If some surface is lit from both sides, this is the point of the surface itself, since the side is only
// known after the light is sampled. Otherwise it is the origin of the path's next ray, so that no second point is kept.
LitPoint lit_point(ShadedSurface x) {
    Vertex v = interaction_vertex(x.s);
    vec3 p = LIT_FROM_BEHIND ? v.p + v.lift : vertex_spawn_origin(v, true);
    return lit_on_surface(p, x.horizon, LIT_FROM_BEHIND && material_transmits(x.material));
}

// The lit point of the path's last vertex.
LitPoint path_lit_point(Path path) {
    LitPoint lit = path.lit;
    if (!LIT_FROM_BEHIND) lit.p = path.ray.o;
    return lit;
}

// Weight of the emission that the path's ray has hit, which the BSDF found with the density pdf_bsdf [1/sr], and which
// a light sample would find with pdf_light.
float emission_weight(Path path, float pdf_bsdf, float pdf_light) {
    if (path.delta || ESTIMATOR == ESTIMATOR_BSDF) return 1.0;
    if (ESTIMATOR == ESTIMATOR_LIGHT) return pdf_light > 0.0 ? 0.0 : 1.0;
    return power_heuristic(pdf_bsdf, pdf_light);
}

// What a contribution adds to L that comes to the camera by that many bounces. With a limit, light that has bounced
// more than once is scaled down to it, as the mean of its channels: this removes fireflies, and some of the light.
vec3 clamp_indirect(vec3 L, uint bounces) {
    if (CLAMP_INDIRECT == 0u || bounces < 2u) return L;
    float limit = uintBitsToFloat(CLAMP_INDIRECT), mean = dot(L, vec3(1.0 / 3.0));
    return mean > limit ? L * (limit / mean) : L;
}

// Whether the path is still to find what guides a denoiser.
bool seeks_guides(Path path, Estimate estimate) {
    return HAS_GUIDES && !estimate.guides.found && !(HAS_CATCHERS && path.alone);
}

// Adds the radiance of the sky, for a path whose ray left the scene.
void add_environment(Path path, inout Estimate estimate) {
    if (path.depth == 0u && ENVIRONMENT != ENVIRONMENT_VISIBLE) return;
    EnvironmentTexel texel = environment_texel(path.ray.d);
    float pdf_light = environment_pdf_li(texel, path_lit_point(path));
    float weight = emission_weight(path, path.pdf_bsdf, pdf_light);
    if (seeks_guides(path, estimate)) guides_meet(estimate.guides, vec3(0.0), texel.radiance, vec3(0.0));
    estimate.L += clamp_indirect(weight * path.beta * texel.radiance, path.depth);
    if (path.depth == 0u) estimate.visible = true;
}

// Adds the radiance of the suns that have a disk there, for a path whose ray left the scene. The camera does not see
// them.
void add_suns(Path path, inout Estimate estimate) {
    if (path.depth == 0u) return;
    LightGroups groups = scene_parameters().lights;
    for (uint i = groups.placed; i < groups.placed + groups.suns; ++i) {
        LightRecord sun = light_at(i);
        if (!is_light(sun, LIGHT_SUN) || !sun_light_covers(sun, path.ray.d)) continue;
        float weight = emission_weight(path, path.pdf_bsdf, sun_pdf_li(i, sun, path_lit_point(path)));
        estimate.L += clamp_indirect(weight * path.beta * sun.radiance, path.depth);
    }
}

// The radiance that light s.light emits at s.
vec3 surface_le(Interaction s) {
    return area_light_le(light_at(s.light), s.front, dot(s.wo, s.n), s.wo) * light_texture(s.light, s.attributes);
}

// Adds the emission of light s.light, which the path's ray hit at s, at that `t`.
void add_emission(Path path, inout Estimate estimate, Interaction s, float t) {
    LitPoint lit = path_lit_point(path);
    float distance_squared = LIT_FROM_BEHIND ? dot(s.p - lit.p, s.p - lit.p) : square(t);
    float pdf_light = light_pdf_li(s.light, s.lamp, lit, distance_squared, dot(s.wo, s.n), s.front);
    float fraction = 1.0;
    if (HAS_COATED_EMISSION) {
        fraction = emitted_fraction(s.material, s.attributes, dot(s.wo, s.n), unit_float(hit_random(path.ray).xy));
    }
    vec3 L = emission_weight(path, path.pdf_bsdf, pdf_light) * fraction * path.beta * surface_le(s);
    estimate.L += clamp_indirect(L, path.depth);
}

// A sample of a light for the surface, as lit; layers above the emitter pass a fraction of its radiance.
LightSample sample_light(LitPoint lit, Sampler random, uint pair) {
    LightSample light = light_sample_li(lit, sampler_triple(random, pair + PAIR_LIGHT));
    if (HAS_COATED_EMISSION) light.Li *= emitted_fraction(light, lit);
    return light;
}

// The shadow ray from a surface, as lit, towards the sample of a light, and what it adds to L if it is not blocked:
// beta f cos Li / pdf, weighted and attenuated.
ShadowRay direct_light(Path path, ShadedSurface x, LitPoint lit, LightSample light) {
    Ray ray = Ray(lit.p, light.shadow);
    uvec2 media = path.media;
    bool viewers_side = true;
    if (LIT_FROM_BEHIND) {
        viewers_side = dot(light.wi, x.horizon) > 0.0;
        ray.o = vertex_spawn_origin(interaction_vertex(x.s), viewers_side);
        if (light.t_max < FLOAT_MAX) ray.d += lit.p - ray.o;
        if (!viewers_side) media = media_beyond(path.media, x.material.medium, x.s.front);
    }
    float cosine;
    BsdfValue value = surface_evaluate(x, light.wi, cosine);
    vec3 Ld = path.beta * value.f * cosine * light.Li;
    if (!VOLUMETRIC) Ld *= media_transmittance(media, light.t_max * length(ray.d));
    // A light is not seen if the horizon and the shading normal disagree about its side.
    bool sides_differ = LIT_FROM_BEHIND ? surface_reflects(x, light.wi, dot(light.wi, x.frame.z)) != viewers_side
                                        : dot(light.wi, x.horizon) <= 0.0;
    bool dark = light.pdf == 0.0 || sides_differ || Ld == vec3(0.0);
    float weight = 1.0;
    if (ESTIMATOR == ESTIMATOR_MIS && !light.delta) weight = power_heuristic(light.pdf, value.pdf);
    return ShadowRay(ray, dark ? 0.0 : light.t_max, clamp_indirect(weight * Ld / light.pdf, path.depth + 1u), media,
                     0u);
}

// Takes a shadow ray through the medium to what it hit, or to its end, and beyond an interface; returns whether it is
// to be traced from there. It goes on towards the same point of the light.
bool shadow_goes_on(inout ShadowRay shadow, Hit hit) {
    if (shadow.t_max == 0.0) return false;
    shadow.Ld *= media_transmittance(shadow.media, hit.t * length(shadow.ray.d));
    if (!is_hit(hit) || max_component(shadow.Ld) == 0.0 || shadow.crossed == DEPTH_SAFETY_LIMIT) return false;
    ShadedSurface x = boundary_at(shadow.ray, hit, shadow.media);
    if (!surface_is_interface(x)) return false;
    vec3 o = vertex_spawn_origin(interaction_vertex(x.s), false);
    if (shadow.t_max < FLOAT_MAX) shadow.ray.d += shadow.ray.o - o;
    shadow.ray.o = o;
    shadow.media = media_beyond(shadow.media, x.material.medium, x.s.front);
    ++shadow.crossed;
    return true;
}

// Continues the path in the direction that the BSDF sampled; returns whether the path goes on. A direction carries no
// light if the horizon and the shading normal disagree about its side.
bool path_scatter(inout Path path, ShadedSurface x, LitPoint lit, BsdfSample scattered) {
    vec3 wi = frame_to_world(x.frame, scattered.wi);
    path.beta *= scattered.weight;
    bool viewers_side = surface_reflects(x, wi, scattered.wi.z);
    if (scattered.pdf == 0.0 || max_component(path.beta) == 0.0) return false;
    if (viewers_side ? dot(wi, x.horizon) <= 0.0 : dot(wi, x.horizon) >= 0.0) return false;
    path.eta_scale *= square(scattered.eta);
    path.pdf_bsdf = scattered.pdf;
    path.delta = scattered.delta;
    if (BEFORE_BACKGROUND) path.clear = path.clear && scattered.delta && !viewers_side;
    path.lit = lit;
    if (!viewers_side) path.media = media_beyond(path.media, x.material.medium, x.s.front);
    if (WALKS && !viewers_side && x.material.medium != MEDIUM_SAME) path.sealed = x.s.front;
    path.ray = Ray(vertex_spawn_origin(interaction_vertex(x.s), viewers_side), wi);
    return true;
}

// Russian roulette: paths with a low throughput end early, and the survivors are weighted up. The square root lets them
// end a vertex or two later, which reduces the noise by more than its rays cost. After ideal scattering the throughput
// is ignored: only this path can find what lies ahead, which is often a light.
// Ref: Arvo and Kirk 1990, Particle Transport and Image Synthesis.
//
// Within a medium, paths with all of their throughput go on for certain: light comes out of wax after hundreds of
// vertices. In one without an end they would wander away: beyond the distance `reach` from the scene, they survive less
// often by its inverse square, as light samples are dimmer. (As often as diffusing light comes back, by the inverse,
// took eight times as long for the same noise.)
bool path_survives(inout Path path, bool in_medium, float u, Parameters parameters) {
    float reach = max(1.0, length(parameters.position));  // The scene lies within 1 of the frame's origin.
    float survival = in_medium ? 1.0 : RR_MAX_SURVIVAL;
    float importance = in_medium ? min(1.0, square(reach) / dot(path.ray.o, path.ray.o)) : 1.0;
    if (!path.delta) survival = min(survival, sqrt(max_component(path.beta) * path.eta_scale * importance));
    if (u >= survival) return false;
    path.beta /= survival;
    return true;
}

// A light near the path's ray in that medium, chosen by its power from those that have a place. The denser the medium
// on the way to it, the fewer paths scatter for it: at most 0.7 of them, which has little more noise than the best
// share in thin media, and the least in others.
Focus path_focus(Path path, MediumRecord medium, float t_max, uint bits) {
    LightGroups groups = scene_parameters().lights;
    if (ESTIMATOR == ESTIMATOR_BSDF || !LIGHTS_PLACED || groups.placed == 0u) return focus_none();
    LightRecord l = light_at(light_choose_placed(bits));
    if (is_light(l, LIGHT_LAMP)) return focus_none();
    vec3 to_light = light_middle(l) - path.ray.o;
    float along = dot(to_light, path.ray.d);
    float nearest = length(to_light - along * path.ray.d);
    float depth =
        dot(path.beta, medium_extinction(medium)) / dot(path.beta, vec3(1.0)) * (clamp(along, 0.0, t_max) + nearest);
    vec2 lit = is_light(l, LIGHT_SPOT) ? spot_light_chord(l, path.ray) : vec2(0.0, FLOAT_MAX);
    return Focus(along, max(max(nearest, light_size(l)), 1e-6), 0.5 * exp(-depth), lit);
}

// What the path meets on its way to a hit at t_max, or to infinity; only if VOLUMETRIC.
MediumSample path_medium_sample(Path path, float t_max, Sampler random) {
    uint pair = PAIR_FIRST_DISTANCE + path.depth | path.crossed << PAIR_CROSSED_SHIFT;
    MediumRecord medium = scene_medium(media_first(path.media));
    uvec3 u = sampler_triple(random, pair);
    uvec3 more = hash_pcg3d(u);
    Focus focus = focus_none();
    if (!(WALKS && path.sealed)) focus = path_focus(path, medium, t_max, more.x);
    return medium_sample(medium, path.beta, t_max, focus, uvec4(u, more.y));
}

// Lets the path pass an interface at x; returns whether it goes on.
bool path_cross(inout Path path, inout Estimate estimate, ShadedSurface x) {
    estimate.cut = path.crossed == DEPTH_SAFETY_LIMIT;
    path.media = media_beyond(path.media, x.material.medium, x.s.front);
    if (WALKS && !x.s.front) path.sealed = false;
    path.ray.o = vertex_spawn_origin(interaction_vertex(x.s), false);
    ++path.crossed;
    return !estimate.cut;
}

// Advances the path past the hit of its ray, or past its miss; returns whether the path continues. `shadow` is the ray
// to trace for direct light at the hit.
bool path_step(inout Path path, inout Estimate estimate, out ShadowRay shadow, Hit hit, Sampler random,
               Parameters parameters) {
    shadow = shadow_none();
    if (path_is_blind(path)) {
        estimate.transmission = 1.0;
        return false;
    }
    MediumSample way;
    bool scattered_before = false;  // The hit.
    if (VOLUMETRIC) {
        way = path_medium_sample(path, hit.t, random);
        scattered_before = way.scattered;
    }
    if (!is_hit(hit) && !scattered_before) {
        if (seeks_guides(path, estimate)) guides_meet(estimate.guides, vec3(0.0), vec3(0.0), vec3(0.0));
        // Through a medium without an end.
        path.beta *= VOLUMETRIC ? way.weight : media_transmittance(path.media, FLOAT_MAX);
        if (BEFORE_BACKGROUND && path.clear) {
            estimate.transmission = path.eta_scale * dot(path.beta, LUMINANCE);
        } else {
            if (HAS_SKY) add_environment(path, estimate);
            if (HAS_SUN_DISKS) add_suns(path, estimate);
        }
        return false;
    }
    ShadedSurface x;
    if (scattered_before) {
        x = surface_in_medium(path.ray, way.t, scene_medium(media_first(path.media)));
    } else {
        x = surface_at(path.ray, hit, path.media);
    }
    vec3 passed = VOLUMETRIC ? way.weight : media_transmittance(path.media, hit.t);
    if (surface_is_interface(x)) {
        path.beta *= passed;
        if (seeks_guides(path, estimate)) estimate.guides.tint *= min(passed, 1.0);
        return path_cross(path, estimate, x);
    }
    if (path.depth == 0u) {
        estimate.visible = true;
        estimate.albedo = bsdf_albedo(x.bsdf);
        estimate.normal = normal_seen(x);
    }
    if (HAS_CATCHERS && !path.alone) {
        if (path.depth > 0u) {
            estimate_stray(estimate, x);
        } else if (estimate_catch(estimate, path, x)) {
            if (seeks_guides(path, estimate)) guides_meet(estimate.guides, vec3(0.0), vec3(0.0), vec3(0.0));
            return false;
        }
    }

    // Attenuate by the medium on the way.
    path.beta *= passed;
    if (seeks_guides(path, estimate)) {
        estimate.guides.tint *= min(passed, 1.0);
        guides_meet(estimate.guides, bsdf_albedo(x.bsdf), x.s.light == NO_LIGHT ? vec3(0.0) : surface_le(x.s),
                    normal_seen(x));
    }

    // Add what the surface emits; light samples of the previous vertex may already account for a part.
    if (x.s.light != NO_LIGHT) add_emission(path, estimate, x.s, hit.t);
    if (is_model(x.bsdf, 1u << MATERIAL_UNLIT)) {
        estimate.L += clamp_indirect(path.beta * x.bsdf.base, path.depth);
        return false;
    }

    // End at the last scattering vertex.
    if (path.depth == parameters.max_depth || VOLUMETRIC && path_is_long(path)) {
        estimate.cut = path_is_long(path);
        return false;
    }
    surface_turn(x);
    uint pair = PAIR_FIRST_BOUNCE + path.depth * PAIRS_PER_BOUNCE;

    // Choose a point on a light, before the lobes of a principled material need registers.
    LitPoint lit = is_in_medium(x) ? lit_anywhere(x.s.p) : lit_point(x);
    LightSample light;
    if (ESTIMATOR != ESTIMATOR_BSDF) light_set_groups(lit);
    if (ESTIMATOR != ESTIMATOR_BSDF) light = sample_light(lit, random, pair);
    surface_add_layers(x, path.ray, path.beta);
    if (path.depth == 0u && is_principled(x.material)) estimate.albedo = bsdf_albedo(x.bsdf);
    if (seeks_guides(path, estimate)) {
        guides_meet(estimate.guides, bsdf_albedo(x.bsdf), x.s.light == NO_LIGHT ? vec3(0.0) : surface_le(x.s),
                    normal_seen(x));
    }

    // Add direct light.
    if (ESTIMATOR != ESTIMATOR_BSDF) shadow = direct_light(path, x, lit, light);

    // Scatter.
    uvec3 u = sampler_triple(random, pair + PAIR_BSDF);
    BsdfSample scattered = surface_sample_f(x, unit_float(u.z), unit_float(u.xy));
    if (seeks_guides(path, estimate)) guides_scatter(estimate.guides, x, unit_float(u.z), scattered);
    if (!path_scatter(path, x, lit, scattered)) return false;
    if (path.depth >= parameters.rr_depth) {
        float u_survival = unit_float(sampler_pair(random, pair + PAIR_SURVIVAL).x);
        if (!path_survives(path, is_in_medium(x), u_survival, parameters)) return false;
    }
    ++path.depth;
    return true;
}

#endif
