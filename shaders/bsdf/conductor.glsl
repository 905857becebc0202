// Metal with microfacets: the GGX distribution of normals, Smith's height-correlated shadowing, Schlick's Fresnel term.
// Light that is scattered more than once among the facets is lost. Local frame, z on the viewer's side of the surface.
// Ref: Walter et al. 2007, Microfacet Models for Refraction through Rough Surfaces; Heitz 2014, Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs, equations 72 and 99.
#ifndef BSDF_CONDUCTOR_GLSL
#define BSDF_CONDUCTOR_GLSL

#include "base/warp.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/sample.glsl"

// Density of facets with the normal h, per area of surface [1/sr]; alpha in (0, 1], h.z > 0. This form keeps all digits
// for a small alpha.
float ggx_d(float alpha, vec3 h) {
    float stretched = dot(h.xy, h.xy) / square(alpha) + square(h.z);
    return 1.0 / (PI * square(alpha * stretched));
}

// sqrt(cos^2 + alpha^2 sin^2) of w's angle to the normal. Smith's Lambda is (reach / w.z - 1) / 2; unlike Lambda, reach
// has no pole at grazing angles.
float ggx_reach(float alpha, vec3 w) {
    return sqrt(square(w.z) + square(alpha) * dot(w.xy, w.xy));
}

// True for directions that see the surface. Below the least cosine, floats cannot tell on which side a direction is.
bool conductor_sees(vec3 w) {
    const float min_cosine = 1e-6;
    return w.z > min_cosine;
}

// Zero unless both directions see the surface. The density is G1 D / (4 cos(theta_o)): the density of the facets that
// wo sees, times the Jacobian of reflection. Ref: Heitz 2018, Sampling the GGX Distribution of Visible Normals,
// equations 3 and 19.
BsdfValue conductor_evaluate(vec3 reflectance, float alpha, vec3 wo, vec3 wi) {
    if (!conductor_sees(wo) || !conductor_sees(wi)) return bsdf_zero();
    vec3 sum = wo + wi;
    float cos_facet = 0.5 * length(sum);  // Cosine of either direction to the facet's normal.
    float d = ggx_d(alpha, normalize(sum));
    float reach_o = ggx_reach(alpha, wo);
    // G2 / (4 cos(theta_o) cos(theta_i))
    float visibility = 0.5 / (wi.z * reach_o + wo.z * ggx_reach(alpha, wi));
    return BsdfValue(fresnel_conductor_schlick(reflectance, cos_facet) * (d * visibility), 0.5 * d / (wo.z + reach_o));
}

// wi by reflection on a facet that wo sees, from u in [0,1)^2; the weight is the Fresnel term times G2 / G1. A sample
// below the surface fails: it would hit another facet.
BsdfSample conductor_sample_f(vec3 reflectance, float alpha, vec3 wo, vec2 u) {
    if (!conductor_sees(wo)) return bsdf_sample_failed();
    vec3 h = warp_ggx_visible_normal(u, alpha, wo);
    vec3 wi = normalize(2.0 * dot(wo, h) * h - wo);
    if (!conductor_sees(wi)) return bsdf_sample_failed();
    float reach_o = ggx_reach(alpha, wo);
    float g2_over_g1 = wi.z * (wo.z + reach_o) / (wi.z * reach_o + wo.z * ggx_reach(alpha, wi));
    vec3 weight = fresnel_conductor_schlick(reflectance, dot(wi, h)) * g2_over_g1;
    return bsdf_sample(wi, weight, conductor_evaluate(reflectance, alpha, wo, wi).pdf);
}

#endif
