// A principled material at a point, and the facets of its base: the light that they reflect, transmit and lose.
// bsdf/principled.glsl has the whole on one page.
#ifndef BSDF_PRINCIPLED_FACETS_GLSL
#define BSDF_PRINCIPLED_FACETS_GLSL

#include "base/warp.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"
#include "shared/kernel_constants.h"
#include "shared/material.h"
#include "shared/principled.h"

bool principled_has(const uint part) {
    return (PRINCIPLED & part) != 0u;
}

const bool PRINCIPLED_TRANSMITS = (PRINCIPLED & (PRINCIPLED_HAS_THIN | PRINCIPLED_HAS_VOLUME)) != 0u;

// The values of a principled material at a point.
struct PrincipledSurface {
    PrincipledRecord record;
    vec3 base_color;
    float eta;      // Index of refraction on the other side over that on the viewer's.
    vec3 spread;    // Factor of eta for red, green and blue.
    bool encloses;  // The surface encloses a medium and refracts light. Otherwise it is a thin wall.
    bool inside;    // The viewer is in that medium.
    vec3 coat_n;    // Normal of the coat, in the local frame.
    vec3 hue;       // Probabilities of the colours in the choice of a direction; they add up to 1.
    vec4 random;    // Uniform in [0, 1), for two lattices.
};

// The lobes of such a point, seen from wo.
struct Principled {
    // Facets of the base reflect r_0 + r_edge t + r_schlick S of the light at the cosine c between wo and the facet's
    // normal, and transmit transmit (t_0 - t_edge t) of it: S is schlick_weight(c), t rises from 0 to 1 as Fresnel's
    // equations do.
    vec2 alpha;
    bool ideal;  // The surface itself is the only facet.
    bool refracts;
    vec3 eta;  // For red, green and blue.
    vec3 r_0;
    vec3 r_edge;
    vec3 r_schlick;
    float r_total;  // Added if reflection is total, so that the transmitting fraction does not lose light.
    vec3 transmit;
    vec3 t_0;
    vec3 t_edge;

    vec3 base_color;  // Colour of the diffuse base.
    float roughness;
    vec3 diffuse;       // Weight of the diffuse base.
    vec3 multiscatter;  // Reflectance of Lambert's lobe for light that facets scatter more than once.
    vec3 through;       // Transmittance of that lobe and of the diffuse base.
    vec3 sheen;
    float sheen_alpha;
    vec3 fuzz;        // Reflectance of the fuzz.
    vec2 fuzz_shape;  // Its lobe: the transform of directions.
    float fuzz_pmf;

    float coat;
    float coat_f0;
    float coat_ior;
    float coat_alpha;
    bool coat_ideal;
    vec3 coat_n;

    vec3 hue;
    // Probabilities of choosing: coat, base facets, diffuse reflection and sheen, diffuse transmission. If all are 0,
    // and fuzz_pmf, too: black.
    vec4 pmf;
};

// Beyond this relative index, boundaries reflect nearly all light, and floats cannot represent the rest.
const float GREATEST_ETA = 100.0;

// Facets that are measured: a power of two of at most 4, see lattice_point().
const uint FACETS = 4u;

// Factors of an index of refraction for red, green and blue; dispersion is 20 / Abbe number. No index falls closer to 1
// than MIN_FACET_ALPHA: wo and wi are then so nearly opposite that rounding decides which facet lies between them.
// Ref: KHR_materials_dispersion, where the limit is 1 itself.
vec3 dispersion_spread(float ior, float dispersion) {
    float h = (ior - 1.0) * 0.025 * dispersion;
    return vec3(max(ior - h, min(ior, 1.0 + MIN_FACET_ALPHA)), ior, ior + h) / ior;
}

// The material m at a point where it has the values of `record`, seen from its front or from its back; its coat does
// not have its own normal yet. eta, hue and random are as in PrincipledSurface.
PrincipledSurface principled_surface(MaterialRecord m, PrincipledRecord record, bool front, float eta, vec3 hue,
                                     vec4 random) {
    PrincipledSurface s;
    s.record = record;
    s.base_color = m.base;
    s.eta = eta;
    s.encloses = m.medium != MEDIUM_SAME;
    s.inside = s.encloses && !front;
    s.spread = vec3(1.0);
    if (principled_has(PRINCIPLED_HAS_DISPERSION)) {
        s.spread = dispersion_spread(m.parameter, record.dispersion);
        if (s.inside) s.spread = 1.0 / s.spread;
    }
    s.coat_n = vec3(0.0, 0.0, 1.0);
    s.hue = hue;
    s.random = random;
    return s;
}

// (F - F(1)) / (1 - F(1)), where F is Fresnel's reflectance of a dielectric at a cosine, and F(1) at normal incidence:
// in [0, 1], and 1 if reflection is total.
float fresnel_edge(float eta, float cos_o) {
    if (eta > GREATEST_ETA) return schlick_weight(cos_o);
    float cos_t = refracted_cosine(1.0 - square(cos_o), eta);
    float f0 = square((eta - 1.0) / (eta + 1.0));
    return clamp((fresnel_dielectric_exact(cos_o, cos_t, eta) - f0) / (1.0 - f0), 0.0, 1.0);
}

vec3 principled_edge(Principled p, float cos_o) {
    float green = fresnel_edge(p.eta.y, cos_o);
    if (!principled_has(PRINCIPLED_HAS_DISPERSION)) return vec3(green);
    return vec3(fresnel_edge(p.eta.x, cos_o), green, fresnel_edge(p.eta.z, cos_o));
}

// The light that facets at that cosine to wo reflect, and transmit, per colour.
void principled_facet(Principled p, float cos_o, out vec3 reflected, out vec3 transmitted) {
    vec3 edge = principled_edge(p, cos_o);
    reflected = p.r_0 + p.r_edge * edge;
    transmitted = vec3(0.0);
    if (PRINCIPLED_TRANSMITS) {
        bvec3 total = bvec3(false);
        if (p.refracts) total = lessThanEqual(vec3(square(cos_o)), 1.0 - p.eta * p.eta);
        transmitted = mix(p.transmit * max(p.t_0 - p.t_edge * edge, 0.0), vec3(0.0), total);
        if (principled_has(PRINCIPLED_HAS_SPECULAR)) reflected += p.r_total * vec3(total);
    }
    if (principled_has(PRINCIPLED_HAS_METAL)) reflected += p.r_schlick * schlick_weight(cos_o);
}

// The probability of transmission by facets that reflect and transmit this much.
float principled_transmitted_fraction(Principled p, vec3 reflected, vec3 transmitted) {
    float r = dot(p.hue, reflected), t = dot(p.hue, transmitted);
    return t > 0.0 ? t / (r + t) : 0.0;
}

// The lobes that a roughness makes ideal.
bool is_ideal(float alpha) {
    return alpha < MIN_FACET_ALPHA;
}

// Point i of a lattice of FACETS points in the unit square, moved by `shift` in [0, 1)^2.
vec2 lattice_point(uint i, vec2 shift) {
    return fract(vec2(float(i), float(i >> 1u | (i & 1u) << 1u)) / float(FACETS) + shift);
}

// Fraction of the light reflected by a facet to wi that is lost: it is shadowed, or wi is below the surface. Given that
// wo sees the facet: 1 - G2 / G1.
float facet_shadowed(vec2 alpha, vec3 wo, vec3 wi, float reach_o) {
    if (wi.z <= 0.0) return 1.0;
    float both = wi.z * reach_o + wo.z * ggx_reach(alpha, wi);
    return max(1.0 - wi.z * (wo.z + reach_o) / both, 0.0);
}

// Means over the facets that wo sees.
struct FacetMeans {
    vec3 edge;            // Mean of t: see Principled.
    float schlick;        // Mean of S: see Principled.
    float max_reflected;  // The greatest channel of the dielectric's reflection.
    float max_lost;       // The part of `max_reflected` that is shadowed.
    float lost;           // The light shadowed if all is reflected.
    vec3 glass_lost;      // The light that the dielectric loses in reflection and transmission, per colour.
};

// Fraction of the light that a dielectric facet with the normal h loses, for one relative index: neither its
// reflection, of which the fraction `shadowed` is lost, nor its refraction. Its reflectance is F = d_0 + d_edge t.
float glass_lost(Principled p, float eta, float d_0, float d_edge, float shadowed, vec3 wo, vec3 h) {
    float cos_o = dot(wo, h);
    float reflected = min(d_0 + d_edge * fresnel_edge(eta, cos_o), 1.0);
    if (!p.refracts) return shadowed;
    float cos_t = refracted_cosine(1.0 - square(cos_o), eta);
    if (cos_t == 0.0) return shadowed;
    vec3 wi = (cos_o / eta - cos_t) * h - wo / eta;
    float hidden = wi.z < 0.0 ? max(1.0 + 2.0 * wi.z / (ggx_reach(p.alpha, wi) - wi.z), 0.0) : 1.0;
    return mix(hidden, shadowed, reflected);
}

// For facets whose dielectric reflects d_0 + d_edge t, with the indices of refraction of red, of green and of blue
// light.
FacetMeans principled_measure(Principled p, vec3 d_0, vec3 d_edge, vec3 wo, vec2 shift) {
    FacetMeans sum = FacetMeans(vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0));
    float reach_o = ggx_reach(p.alpha, wo);
    for (uint i = 0u; i < FACETS; ++i) {
        vec3 h = warp_ggx_visible_normal(lattice_point(i, shift), p.alpha, wo);
        float cos_o = dot(wo, h);
        float shadowed = facet_shadowed(p.alpha, wo, 2.0 * cos_o * h - wo, reach_o);
        vec3 edge = principled_edge(p, cos_o);
        float max_reflected = min(d_0.y + d_edge.y * edge.y, 1.0);
        sum.edge += edge;
        sum.schlick += schlick_weight(cos_o);
        sum.max_reflected += max_reflected;
        sum.max_lost += max_reflected * shadowed;
        sum.lost += shadowed;
        if (!PRINCIPLED_TRANSMITS) continue;
        float green = glass_lost(p, p.eta.y, d_0.y, d_edge.y, shadowed, wo, h);
        vec3 lost = vec3(green);
        if (principled_has(PRINCIPLED_HAS_DISPERSION)) {
            lost.x = glass_lost(p, p.eta.x, d_0.x, d_edge.x, shadowed, wo, h);
            lost.z = glass_lost(p, p.eta.z, d_0.z, d_edge.z, shadowed, wo, h);
        }
        sum.glass_lost += lost;
    }
    const float EACH = 1.0 / float(FACETS);
    return FacetMeans(EACH * sum.edge, EACH * sum.schlick, EACH * sum.max_reflected, EACH * sum.max_lost,
                      EACH * sum.lost, EACH * sum.glass_lost);
}

// Colour of light that metal facets scatter more than once, m_0 + m_edge S each time: after each time except the first
// it stays with the same probability. This probability and the mean of S are fits to random walks among facets of one
// roughness, within 0.001 of the albedo; the energy does not depend on them. Ref: Heitz et al. 2016,
// Multiple-Scattering Microfacet BSDFs with the Smith Model, on the walks; Kulla and Conty 2017, on the sum over all
// times.
vec3 metal_multiscatter(vec3 m_0, vec3 m_edge, vec2 alpha) {
    float a = sqrt(0.5 * dot(alpha, alpha));
    float stays = 0.397 * a;
    vec3 mean = m_0 + m_edge * (0.0378 / (a + 0.0459));
    return mean * mean * ((1.0 - stays) / (1.0 - mean * stays));
}

// Fraction of light from all sides that a dielectric boundary reflects: multiply scattered light goes to that side.
float diffuse_reflectance(float eta) {
    float f0 = square((eta - 1.0) / (eta + 1.0));
    float outside = mix(f0, 1.0, 1.0 / 21.0);
    return eta >= 1.0 ? outside : 1.0 - (1.0 - outside) * square(eta);
}

#endif
