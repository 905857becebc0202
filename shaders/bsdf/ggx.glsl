// The GGX distribution of microfacets with a roughness along x and one along y, and Smith's masking. Local frame, z on
// the viewer's side of the surface.
// Ref: Heitz 2014, Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs, equations 72, 85 and 99;
// Walter et al. 2007, Microfacet Models for Refraction through Rough Surfaces.
#ifndef BSDF_GGX_GLSL
#define BSDF_GGX_GLSL

#include "base/math.glsl"

// Below the least cosine, floats cannot tell on which side of the surface a direction is.
const float MIN_FACET_COSINE = 1e-6;

// Density of facets with the normal h, per area of surface [1/sr]; alpha in (0, 1], h.z > 0.
float ggx_d(vec2 alpha, vec3 h) {
    vec2 slope = h.xy / alpha;
    return 1.0 / (PI * alpha.x * alpha.y * square(dot(slope, slope) + square(h.z)));
}

// Smith's Lambda(w) is (ggx_reach / |w.z| - 1) / 2; unlike Lambda, it has no pole at grazing angles.
float ggx_reach(vec2 alpha, vec3 w) {
    vec2 stretched = alpha * w.xy;
    return sqrt(square(w.z) + dot(stretched, stretched));
}

// G2 / (4 cos(theta_o) cos(theta_i)) of reflection, height-correlated; reaches of both directions.
float ggx_visibility(float cos_o, float cos_i, float reach_o, float reach_i) {
    return 0.5 / (cos_i * reach_o + cos_o * reach_i);
}

// Density of directions reflected by facets sampled by visible area [1/sr]: G1 D / (4 cos_o).
// Ref: Heitz 2018, Sampling the GGX Distribution of Visible Normals, equations 3 and 19.
float ggx_reflected_pdf(float d, float cos_o, float reach_o) {
    return 0.5 * d / (cos_o + reach_o);
}

#endif
