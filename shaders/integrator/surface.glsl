// The surface at the hit of a path's ray, resolved once: its material at that point, the media on both sides, and its
// shading normal. The integrator uses materials only through this.
#ifndef INTEGRATOR_SURFACE_GLSL
#define INTEGRATOR_SURFACE_GLSL

#include "base/frame.glsl"
#include "bsdf/bsdf.glsl"
#include "integrator/bent_normal.glsl"
#include "integrator/layers.glsl"
#include "medium/medium.glsl"
#include "scene/interaction.glsl"
#include "scene/material.glsl"

// surface_at() fills all members except horizon and frame, which surface_turn() sets, and wo, which
// surface_add_layers() sets.
struct ShadedSurface {
    Interaction s;  // Its shading normal may come from a normal map or a bump map.
    MaterialRecord material;
    Bsdf bsdf;
    vec3 unbent;   // The shading normal of the shape itself.
    vec3 horizon;  // The normal that decides on which side of the surface a direction is.
    bool bent;     // Shaded by integrator/bent_normal.glsl.
    Frame frame;   // Around the shading normal.
    vec3 wo;       // Towards the viewer, in that frame.
};

// The ratio of the indices of refraction if media nest. A boundary within one medium is treated as glass between equal
// indices, regardless of its material.
void surface_nest(inout ShadedSurface x, uvec2 media) {
    if (!NESTED_MEDIA || !bsdf_refracts(x.material)) return;
    bool principled = is_principled(x.material);
    uvec2 beyond = media_beyond(media, x.material.medium, x.s.front);
    x.bsdf.parameter = media_eta(media, beyond, !principled && x.material.specular.x != 0.0, x.bsdf.parameter);
    if (principled && media_first(media) == media_first(beyond)) {
        x.material.model = x.bsdf.model = MATERIAL_DIELECTRIC_EXACT;
    }
}

// The surface that the ray hit, from within these media; is_hit(hit) must hold.
ShadedSurface surface_at(Ray ray, Hit hit, uvec2 media) {
    ShadedSurface x;
    x.s = interaction_at(ray, hit);
    x.material = material_at(x.s.material, x.s.attributes, ray);
    x.bsdf = bsdf_at(x.material, x.s.front);
    if (material_transmits(x.material)) x.s.lift = vec3(0.0);
    x.unbent = x.s.ns;
    x.bent = bend_normal(x.s, hit);
    surface_nest(x, media);
    return x;
}

// The same without what only light that is scattered there needs: enough for surface_is_interface.
ShadedSurface boundary_at(Ray ray, Hit hit, uvec2 media) {
    ShadedSurface x;
    x.s = interaction_at(ray, hit);
    x.material = scene_material(x.s.material);
    x.bsdf = bsdf_at(x.material, x.s.front);
    surface_nest(x, media);
    return x;
}

// A point within the medium m at the distance t on the ray, as if it were a surface: its normals point to the viewer,
// and the medium is on both sides.
ShadedSurface surface_in_medium(Ray ray, float t, MediumRecord m) {
    ShadedSurface x;
    x.s.p = ray.o + t * ray.d;
    x.s.wo = x.s.n = x.s.ns = x.unbent = -ray.d;
    x.s.front = true;
    x.s.error = 0.0;
    x.s.lift = vec3(0.0);
    x.s.material = 0u;
    x.s.light = NO_LIGHT;
    x.s.lamp = NO_LIGHT;
    x.material =
        MaterialRecord(MATERIAL_PHASE, MEDIUM_SAME, m.scattering / max(medium_extinction(m), 1e-37), vec3(0.0), m.g);
    x.bsdf = bsdf_at(x.material, true);
    x.bent = false;
    return x;
}

// A point within a medium, not on a surface.
bool is_in_medium(ShadedSurface x) {
    return VOLUMETRIC && is_model(x.bsdf, 1u << MATERIAL_PHASE);
}

// A boundary that light passes as if nothing were there but another medium.
bool surface_is_interface(ShadedSurface x) {
    return VOLUMETRIC && x.s.light == NO_LIGHT && is_model(x.bsdf, MATERIALS_DIELECTRIC) && x.bsdf.parameter == 1.0;
}

// The shading normal that images and denoisers get.
vec3 normal_seen(ShadedSurface x) {
    return is_in_medium(x) ? vec3(0.0) : x.s.ns;
}

// Turns the shading normals towards the viewer where necessary, and puts the frame around the resulting one.
//
// The horizon is perpendicular to the geometric normal or, if SMOOTH, to the shape's shading normal: light that
// scatters above it but below the triangle's plane begins above the plane, and hits the surface again unless the lift
// is large enough.
void surface_turn(inout ShadedSurface x) {
    x.horizon = x.s.n;
    if (SMOOTH) {
        x.unbent = facing_normal(x.s.wo, x.s.n, x.unbent);
        x.horizon = x.unbent;
        if (!x.bent) x.s.ns = x.unbent;
    }
    // Rays go straight through a boundary between equal indices, regardless of its shading normal.
    if (is_model(x.bsdf, MATERIALS_DIELECTRIC) && x.bsdf.parameter == 1.0) {
        x.s.ns = x.horizon = x.s.n;
        x.bent = false;
    }
    x.bent = x.bent || has_coat_map(x.material);
    if (x.bent) x.s.ns = consistent_normal(x.s.wo, x.horizon, x.s.ns);
    x.frame = frame_from_z(x.s.ns);
}

// Adds the lobes of a principled material, for a path with that throughput.
void surface_add_layers(inout ShadedSurface x, Ray ray, vec3 beta) {
    add_layers(x.bsdf, x.material, x.frame, x.s, x.unbent, x.horizon, ray, beta);
    x.wo = frame_to_local(x.frame, x.s.wo);
}

// Whether scattering into wi, whose cosine to the shading normal is cos_i, stays on the viewer's side.
bool surface_reflects(ShadedSurface x, vec3 wi, float cos_i) {
    return x.bent ? dot(wi, x.horizon) > 0.0 : cos_i > 0.0;
}

// Value and density for a direction wi of the scene. The value lacks the factor `cosine`.
BsdfValue surface_evaluate(ShadedSurface x, vec3 wi, out float cosine) {
    vec3 local = frame_to_local(x.frame, wi);
    cosine = 1.0;
    if (x.bent) return bent_evaluate(x.bsdf, x.wo, local, frame_to_local(x.frame, x.horizon));
    cosine = is_in_medium(x) ? 1.0 : abs(local.z);
    return bsdf_evaluate(x.bsdf, x.wo, local);
}

// A direction in the frame of the surface, from u in [0, 1)^2; uc in [0, 1) chooses a lobe.
BsdfSample surface_sample_f(ShadedSurface x, float uc, vec2 u) {
    BsdfSample scattered = bsdf_sample_f(x.bsdf, x.wo, uc, u);
    if (x.bent) bend_sample(scattered, x.bsdf, x.wo, frame_to_local(x.frame, x.horizon));
    return scattered;
}

#endif
