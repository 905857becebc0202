// Shading with a normal from a normal map or a bump map.
//
// The viewer may be below the horizon of such a normal, and the hemisphere around it reaches below the surface. So the
// normal is turned towards the viewer until its mirror direction is above the surface: facets that slope away are less
// visible. And a direction on the wrong side of the surface is mirrored at the surface, as if by a second facet
// perpendicular to the slope of the first. A surface that reflects all light does so under any map, and no facet is
// black. Both measures give up reciprocity: they depend on which of the two directions is the viewer's.
// Ref: Keller et al. 2017, The Iray Light Transport Simulation and Rendering System, on consistent normals; Schuessler,
// Heitz, Hanika and Dachsbacher 2017, Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing, from which
// the idea of a second, mirroring facet is taken.
#ifndef INTEGRATOR_BENT_NORMAL_GLSL
#define INTEGRATOR_BENT_NORMAL_GLSL

#include "bsdf/bsdf.glsl"
#include "scene/bump.glsl"
#include "scene/interaction.glsl"
#include "scene/material.glsl"

const bool HAS_NORMAL_MAPS = (TEXTURED & TEXTURED_NORMAL) != 0u;
const bool HAS_BUMP_MAPS = (TEXTURED & TEXTURED_BUMP) != 0u;

// The shading normal on the front side that the normal map in that texture gives, with a factor for its x and y.
vec3 mapped_normal(uint texture_index, float scale, Interaction s) {
    vec3 m = 2.0 * texture_color(texture_index, s.attributes) - 1.0;
    m.xy *= scale;
    vec3 ns = s.front ? s.ns : -s.ns;
    vec3 t = s.attributes.tangent.xyz;
    vec3 n = m.x * t + m.y * s.attributes.tangent.w * cross(ns, t) + m.z * ns;
    float length_squared = dot(n, n);
    return length_squared > 0.0 ? inversesqrt(length_squared) * n : ns;
}

// Bends the shading normal if the material has a normal or bump map; returns whether it has one.
bool bend_normal(inout Interaction s, Hit hit) {
    if (!HAS_NORMAL_MAPS && !HAS_BUMP_MAPS) return false;
    MaterialTextures textures = scene_material_textures(s.material);
    if (textures.normal == TEXTURE_NONE) return false;
    vec3 n;
    if (HAS_BUMP_MAPS && (!HAS_NORMAL_MAPS || textures.bump != 0u)) {
        n = bumped_normal(scene_texture(textures.normal), textures.normal_scale, hit, s);
    } else {
        n = mapped_normal(textures.normal, textures.normal_scale, s);
    }
    s.ns = s.front ? n : -n;
    return true;
}

// The bent normal ns, turned so that it mirrors wo to a direction above the surface with the normal n. wo is not below
// the surface.
vec3 consistent_normal(vec3 wo, vec3 n, vec3 ns) {
    const float MIN_SINE = 0.01;  // Of the mirror direction's elevation; rounding is far smaller.
    vec3 mirror = 2.0 * dot(wo, ns) * ns - wo;
    float up = dot(mirror, n);
    if (up >= MIN_SINE) return dot(wo, ns) < 0.0 ? -ns : ns;
    vec3 along = mirror - up * n;
    float length_squared = dot(along, along);
    if (length_squared == 0.0) return n;
    return normalize(wo + sqrt((1.0 - MIN_SINE * MIN_SINE) / length_squared) * along + MIN_SINE * n);
}

// The interpolated normal ns if wo sees its front, otherwise turned as a bent normal is. wo is not below the surface
// with the normal n. A mirror may reflect light to below that surface. There it meets the surface once more, from
// behind ns, and the turned normal reflects it away.
vec3 facing_normal(vec3 wo, vec3 n, vec3 ns) {
    const float MIN_COSINE = 0.01;  // Unless n itself has a smaller one.
    return dot(wo, ns) < min(MIN_COSINE, dot(wo, n)) ? consistent_normal(wo, n, ns) : ns;
}

// w mirrored at the plane with the unit normal n.
vec3 mirrored(vec3 w, vec3 n) {
    return w - 2.0 * dot(w, n) * n;
}

// The value times |cos| and the density of scattering into wi: directly, and mirrored into it. n is the geometric
// normal in the local frame.
BsdfValue bent_evaluate(Bsdf bsdf, vec3 wo, vec3 wi, vec3 n) {
    bool above = dot(wi, n) > 0.0;
    BsdfValue sum = bsdf_zero();
    vec3 w = wi;
    for (int i = 0; i < 2; ++i) {
        if ((w.z > 0.0) == above) {
            BsdfValue value = bsdf_evaluate(bsdf, wo, w);
            sum.f += value.f * abs(w.z);
            sum.pdf += value.pdf;
        } else if (above) {
            BsdfValue coat = bsdf_evaluate_coat(bsdf, wo, w);
            sum.f += coat.f;
            sum.pdf += coat.pdf;
        }
        w = mirrored(wi, n);
    }
    return sum;
}

// Mirrors a scattered direction that is on the wrong side of the surface.
void bend_sample(inout BsdfSample scattered, Bsdf bsdf, vec3 wo, vec3 n) {
    if (scattered.pdf == 0.0) return;
    if ((dot(scattered.wi, n) > 0.0) != scattered.above) scattered.wi = mirrored(scattered.wi, n);
    if (!scattered.delta) scattered.pdf = bent_evaluate(bsdf, wo, scattered.wi, n).pdf;
}

#endif
