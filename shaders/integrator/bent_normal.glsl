// Shading with a normal from a normal map.
//
// The hemisphere around such a normal reaches below the surface, and the viewer may be outside of it. Light that would
// be lost there is kept: a direction on the wrong side of the surface is mirrored at the surface, as if by another
// facet that stands at a right angle to the first one's slope; and a viewer below the shading normal's horizon sees the
// facet as one above it by the same angle does. So a surface that reflects all light does so under any map, and no
// facet is black. Reciprocity is given up.
// Ref: Schuessler, Heitz, Hanika and Dachsbacher 2017, Microfacet-based Normal Mapping for Robust Monte Carlo Path
// Tracing, of which this keeps the idea of a second facet that is a mirror.
#ifndef INTEGRATOR_BENT_NORMAL_GLSL
#define INTEGRATOR_BENT_NORMAL_GLSL

#include "bsdf/bsdf.glsl"
#include "scene/interaction.glsl"
#include "scene/material.glsl"

const bool HAS_NORMAL_MAPS = (TEXTURED & TEXTURED_NORMAL) != 0u;

// Bends the shading normal if the material has a normal map; returns whether it has one.
bool bend_normal(inout Interaction s) {
    if (!HAS_NORMAL_MAPS) return false;
    MaterialTextures textures = scene_material_textures(s.material);
    if (textures.normal == TEXTURE_NONE) return false;
    vec3 m = 2.0 * texture_color(textures.normal, s.attributes) - 1.0;
    m.xy *= textures.normal_scale;
    // The map is that of the front.
    vec3 ns = s.front ? s.ns : -s.ns;
    vec3 t = s.attributes.tangent.xyz;
    vec3 n = m.x * t + m.y * s.attributes.tangent.w * cross(ns, t) + m.z * ns;
    float length_squared = dot(n, n);
    if (length_squared > 0.0) s.ns = (s.front ? 1.0 : -1.0) * inversesqrt(length_squared) * n;
    return true;
}

// wo, in the frame of a bent normal, as the facet is seen.
vec3 bent_wo(vec3 wo) {
    return vec3(wo.xy, max(abs(wo.z), 1e-6));
}

// w mirrored at the plane with the unit normal n.
vec3 mirrored(vec3 w, vec3 n) {
    return w - 2.0 * dot(w, n) * n;
}

// The value times |cos| and the density of scattering into wi: what goes there, and what is mirrored there. n is the
// geometric normal in the local frame.
BsdfValue bent_evaluate(Bsdf bsdf, vec3 wo, vec3 wi, vec3 n) {
    bool above = dot(wi, n) > 0.0;
    BsdfValue sum = bsdf_zero();
    vec3 w = wi;
    for (int i = 0; i < 2; ++i) {
        if ((w.z > 0.0) == above) {
            BsdfValue value = bsdf_evaluate(bsdf, wo, w);
            sum.f += value.f * abs(w.z);
            sum.pdf += value.pdf;
        }
        w = mirrored(wi, n);
    }
    return sum;
}

// Mirrors a scattered direction that is on the wrong side of the surface.
void bend_sample(inout BsdfSample scattered, Bsdf bsdf, vec3 wo, vec3 n) {
    if (scattered.pdf == 0.0) return;
    bool above = scattered.wi.z > 0.0;
    if ((dot(scattered.wi, n) > 0.0) != above) scattered.wi = mirrored(scattered.wi, n);
    if (!scattered.delta) scattered.pdf = bent_evaluate(bsdf, wo, scattered.wi, n).pdf;
}

#endif
