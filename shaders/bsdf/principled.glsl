// The principled material: a dielectric or metallic base under sheen and coat, as glTF 2.0 layers them. Reading order:
//
//     coat (its own normal)           coat Fc D G                                      1 - <coat Fc s>
//       over sheen                    sheen_color Charlie                              1 - max(sheen_color) Es
//         over mix(by metalness)
//           metal                     Fm D G
//           dielectric                Fd D G
//             over mix(by transmission)
//               refraction            base_color (1 - max Fd) D G
//               diffuse               base_color, diffuse_transmission_color           1 - <max Fd>
//
// What a layer leaves to those below is the last column, a function of wo alone: what it does not scatter itself. (By
// facets, as glTF's own sample code has it, light would be gained at grazing angles.) Light that is scattered more than
// once among facets is what they lose to shadowing, <1 - s>; it leaves the surface as from a diffuse one.
//
// <x> is the mean of x over the facets that wo sees. A lattice of FACETS of them at random places measures it, without
// bias, since all that is measured counts linearly: there are no tables of albedos, and no fits. So a surface has other
// lobes at each vertex, and the right ones on average. Nothing is gained or lost, whatever the roughness, the indices and
// the film. The whole is not reciprocal; its lobes are, one by one.
// Ref: glTF 2.0, appendix B, and its extensions KHR_materials_*; OpenPBR 1.1; Kulla and Conty 2017, Revisiting Physically
// Based Shading at Imageworks, on lost light; Cranley and Patterson 1976, Randomization of Number Theoretic Methods for
// Multiple Integration, on such lattices.
//
// Local frame, z on the viewer's side, x along the direction that anisotropy makes rougher.
#ifndef BSDF_PRINCIPLED_GLSL
#define BSDF_PRINCIPLED_GLSL

#include "base/color.glsl"
#include "base/frame.glsl"
#include "base/warp.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/iridescence.glsl"
#include "bsdf/mirror.glsl"
#include "bsdf/rough_diffuse.glsl"
#include "bsdf/sample.glsl"
#include "bsdf/sheen.glsl"
#include "bsdf/sheen_albedo.glsl"
#include "shared/kernel_constants.h"
#include "shared/material.h"
#include "shared/principled.h"

bool principled_has(const uint part) {
    return (PRINCIPLED & part) != 0u;
}

const bool PRINCIPLED_TRANSMITS = (PRINCIPLED & (PRINCIPLED_HAS_THIN | PRINCIPLED_HAS_VOLUME)) != 0u;

// What a principled material is made of at a point: the record's values there.
struct PrincipledSurface {
    PrincipledRecord record;
    vec3 base_color;
    float eta;       // Index of refraction on the other side over that on the viewer's.
    vec3 spread;     // Factor of eta for red, green and blue.
    bool encloses;   // A medium: light is refracted. Otherwise the surface is a thin wall.
    bool inside;     // The viewer is in that medium.
    vec3 coat_n;     // Normal of the coat, in the local frame.
    vec3 hue;        // Shares of the colours in the choice of a direction; they add up to 1.
    vec4 random;     // Uniform in [0, 1), for two lattices.
};

// The lobes of such a point, seen from wo.
struct Principled {
    // Facets of the base reflect r_0 + r_edge t + r_schlick S of the light at the cosine c between wo and the facet's
    // normal, and transmit transmit (t_0 - t_edge t) of it: S is schlick_weight(c), t rises from 0 to 1 as Fresnel's
    // equations do.
    vec2 alpha;
    bool ideal;      // There are no facets but the surface itself.
    bool refracts;
    vec3 eta;        // Of red, green and blue.
    vec3 r_0;
    vec3 r_edge;
    vec3 r_schlick;
    float r_total;   // What is added where reflection is total: the transmitting share loses nothing.
    vec3 transmit;
    vec3 t_0;
    vec3 t_edge;

    vec3 base_color;  // Of the diffuse base,
    float roughness;
    vec3 diffuse;     // and its weight.
    vec3 again;       // Reflectance of Lambert's lobe for light that facets scatter more than once,
    vec3 through;     // and transmittance: of that, and of the diffuse base.
    vec3 sheen;
    float sheen_alpha;

    float coat;
    float coat_f0;
    float coat_ior;
    float coat_alpha;
    bool coat_ideal;
    vec3 coat_n;

    vec3 hue;
    vec4 pmf;  // Of choosing: coat, base facets, diffuse reflection and sheen, diffuse transmission. All 0: black.
};

// Beyond this relative index, boundaries reflect almost all light, and floats cannot hold the rest.
const float GREATEST_ETA = 100.0;

// Facets that are measured: a power of two of at most 4, see lattice_point().
const uint FACETS = 4u;

// Factors of an index of refraction for red, green and blue; dispersion is 20 / Abbe number. No index falls below 1.
// Ref: KHR_materials_dispersion.
vec3 dispersion_spread(float ior, float dispersion) {
    float h = (ior - 1.0) * 0.025 * dispersion;
    return vec3(max(ior - h, 1.0), ior, ior + h) / ior;
}

// (F - F(1)) / (1 - F(1)), F being Fresnel's reflectance of a dielectric at a cosine, F(1) that at normal incidence: in
// [0, 1], and 1 if reflection is total.
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

// What facets at that cosine to wo reflect, and transmit, per colour.
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

// The probability that facets which reflect and transmit as much are chosen to transmit.
float principled_transmitted_share(Principled p, vec3 reflected, vec3 transmitted) {
    float r = dot(p.hue, reflected), t = dot(p.hue, transmitted);
    return t > 0.0 ? t / (r + t) : 0.0;
}

// Between the frame and that of the coat.
vec3 to_coat(Principled p, vec3 w) {
    return principled_has(PRINCIPLED_HAS_COAT_NORMAL) ? frame_to_local(frame_from_z(p.coat_n), w) : w;
}

vec3 from_coat(Principled p, vec3 w) {
    return principled_has(PRINCIPLED_HAS_COAT_NORMAL) ? frame_to_world(frame_from_z(p.coat_n), w) : w;
}

// The lobes that a roughness makes ideal.
bool is_ideal(float alpha) {
    return alpha < LEAST_ALPHA;
}

// Point i of a lattice of FACETS points in the unit square, moved by `shift` in [0, 1)^2.
vec2 lattice_point(uint i, vec2 shift) {
    return fract(vec2(float(i), float(i >> 1u | (i & 1u) << 1u)) / float(FACETS) + shift);
}

// Share of light that a facet reflects to wi and that does not get there: it is shadowed, or wi is below the surface.
// Given that wo sees the facet: 1 - G2 / G1.
float facet_shadowed(vec2 alpha, vec3 wo, vec3 wi, float reach_o) {
    if (wi.z <= 0.0) return 1.0;
    float both = wi.z * reach_o + wo.z * ggx_reach(alpha, wi);
    return max(1.0 - wi.z * (wo.z + reach_o) / both, 0.0);
}

float coat_fresnel(Principled p, float cos_o) {
    return mix(fresnel_edge(p.coat_ior, cos_o), 1.0, p.coat_f0);
}

// The coat's lobes; returns what it leaves to the layers below.
float principled_coat(inout Principled p, PrincipledSurface s, vec3 wo) {
    p.coat = 0.0;
    p.coat_ideal = true;
    if (!principled_has(PRINCIPLED_HAS_COAT) || s.inside) return 1.0;
    float cos_o = principled_has(PRINCIPLED_HAS_COAT_NORMAL) ? max(dot(wo, s.coat_n), 0.0) : wo.z;
    p.coat_n = s.coat_n;
    p.coat_ior = s.record.coat_ior;
    p.coat_f0 = square((p.coat_ior - 1.0) / (p.coat_ior + 1.0));
    float alpha = square(s.record.coat_roughness);
    p.coat_ideal = is_ideal(alpha);
    p.coat_alpha = max(alpha, LEAST_ALPHA);
    p.coat = s.record.coat;
    float reflected = coat_fresnel(p, cos_o);
    p.pmf.x = p.coat * reflected;
    if (!p.coat_ideal) {
        vec2 alpha = vec2(p.coat_alpha);
        vec3 o = to_coat(p, wo);
        float reach_o = ggx_reach(alpha, o);
        float scattered = 0.0;
        reflected = 0.0;
        for (uint i = 0u; i < FACETS; ++i) {
            vec3 h = warp_ggx_visible_normal(lattice_point(i, s.random.zw), alpha, o);
            float fresnel = coat_fresnel(p, dot(o, h));
            scattered += fresnel;
            reflected += fresnel * (1.0 - facet_shadowed(alpha, o, 2.0 * dot(o, h) * h - o, reach_o));
        }
        reflected /= float(FACETS);
        p.pmf.x = p.coat * scattered / float(FACETS);
    }
    return max(1.0 - p.coat * reflected, 0.0);
}

// Darkens what the layers under the coat send up: the coat reflects a part of it down again, and what reflects little
// takes that away. `up` is the share that they send up, `roughness` how diffuse that is.
// Ref: OpenPBR 1.1, section on coat darkening.
void principled_darken(inout Principled p, PrincipledSurface s, vec3 wo, vec3 up, float roughness) {
    if (p.coat == 0.0) return;
    float cos_o = principled_has(PRINCIPLED_HAS_COAT_NORMAL) ? max(dot(wo, s.coat_n), 0.0) : wo.z;
    float ideal = coat_fresnel(p, cos_o);
    float down = min(mix(ideal, s.record.coat_internal, roughness), 0.9999);
    vec3 factor = (1.0 - down) / (1.0 - min(up, 1.0) * down);
    factor = mix(vec3(1.0), factor, p.coat * s.record.coat_darkening);
    p.r_0 *= factor;
    p.r_edge *= factor;
    p.r_schlick *= factor;
    p.diffuse *= factor;
    p.again *= factor;
    p.sheen *= factor;
}

// The sheen's lobe under a coat that leaves `above`; returns what sheen and coat leave.
float principled_sheen(inout Principled p, PrincipledSurface s, vec3 wo, float above) {
    p.sheen = vec3(0.0);
    p.sheen_alpha = 1.0;
    if (!principled_has(PRINCIPLED_HAS_SHEEN) || s.inside) return above;
    p.sheen_alpha = sheen_alpha(s.record.sheen_roughness);
    // Charlie's lobe gains light at grazing angles if it is narrow: there it is scaled down to an albedo of 1.
    float albedo = sheen_albedo(p.sheen_alpha, wo.z);
    p.sheen = above / max(albedo, 1.0) * s.record.sheen_color;
    albedo = min(albedo, 1.0);
    p.pmf.z = dot(s.hue, s.record.sheen_color) * (above * albedo);
    return above * (1.0 - max_component(s.record.sheen_color) * albedo);
}

// Means over the facets that wo sees.
struct FacetMeans {
    vec3 edge;        // t,
    float schlick;    // and S: see Principled.
    float most;       // The greatest channel of what the dielectric reflects,
    float most_lost;  // and of that, what is shadowed.
    float lost;       // What is shadowed where all is reflected,
    vec3 glass_lost;  // and where the dielectric reflects and transmits, per colour.
};

// Share of the light that a dielectric facet with the normal h loses, for one relative index: neither its reflection,
// of which `shadowed` is lost, nor its refraction. F = d_0 + d_edge t is what it reflects.
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

// Of facets whose dielectric reflects d_0 + d_edge t, for the index of refraction of red, of green and of blue light.
FacetMeans principled_measure(Principled p, vec3 d_0, vec3 d_edge, vec3 wo, vec2 shift) {
    FacetMeans sum = FacetMeans(vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0));
    float reach_o = ggx_reach(p.alpha, wo);
    for (uint i = 0u; i < FACETS; ++i) {
        vec3 h = warp_ggx_visible_normal(lattice_point(i, shift), p.alpha, wo);
        float cos_o = dot(wo, h);
        float shadowed = facet_shadowed(p.alpha, wo, 2.0 * cos_o * h - wo, reach_o);
        vec3 edge = principled_edge(p, cos_o);
        float most = min(d_0.y + d_edge.y * edge.y, 1.0);
        sum.edge += edge;
        sum.schlick += schlick_weight(cos_o);
        sum.most += most;
        sum.most_lost += most * shadowed;
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
    return FacetMeans(EACH * sum.edge, EACH * sum.schlick, EACH * sum.most, EACH * sum.most_lost, EACH * sum.lost,
                      EACH * sum.glass_lost);
}

// Colour of light that metal facets scatter more than once, m_0 + m_edge S each time.
// Ref: Kulla and Conty 2017. The mean of S is 1/21. How much light is lost on average over all angles is a fit, within
// 0.01: the colour depends on it, the energy does not.
vec3 metal_again(vec3 m_0, vec3 m_edge, vec2 alpha) {
    float a = sqrt(0.5 * dot(alpha, alpha));
    float lost = square(a) / (0.26 + a * (0.92 + 0.51 * a));
    vec3 mean = m_0 + m_edge / 21.0;
    return mean * mean * ((1.0 - lost) / (1.0 - mean * lost));
}

// Share of light from all sides that a dielectric boundary reflects: what a facet scatters again goes to that side.
float diffuse_reflectance(float eta) {
    float f0 = square((eta - 1.0) / (eta + 1.0));
    float outside = mix(f0, 1.0, 1.0 / 21.0);
    return eta >= 1.0 ? outside : 1.0 - (1.0 - outside) * square(eta);
}

// The lobes of the base under layers that leave `above`.
void principled_base(inout Principled p, PrincipledSurface s, vec3 wo, float above) {
    PrincipledRecord r = s.record;
    float metalness = principled_has(PRINCIPLED_HAS_METAL) ? r.metalness : 0.0;
    float transmission = PRINCIPLED_TRANSMITS ? r.transmission : 0.0;

    // Facets.
    float alpha = square(r.roughness);
    p.alpha = vec2(alpha);
    if (principled_has(PRINCIPLED_HAS_ANISOTROPY)) p.alpha.x = mix(alpha, 1.0, square(r.anisotropy));
    p.refracts = principled_has(PRINCIPLED_HAS_VOLUME) && s.encloses;
    // Facets between nearly equal indices turn light by less than LEAST_ALPHA, too.
    bool matched = p.refracts && transmission > 0.0 && abs(s.eta - 1.0) < LEAST_ALPHA;
    p.ideal = is_ideal(p.alpha.x) || matched;
    if (!principled_has(PRINCIPLED_HAS_ROUGH)) p.ideal = true;
    p.alpha = max(p.alpha, LEAST_ALPHA);
    p.eta = vec3(s.eta);
    if (principled_has(PRINCIPLED_HAS_DISPERSION) && p.refracts) p.eta *= s.spread;

    // The reflectance of facets: d_0 + d_edge t of the dielectric, m_0 + m_edge S of the metal.
    vec3 root = (p.eta - 1.0) / (p.eta + 1.0);
    vec3 f0 = root * root;
    vec3 d_0 = f0, d_edge = 1.0 - f0;
    vec3 most_0 = f0;  // The greatest channel, if the index were that of red, of green and of blue light.
    if (principled_has(PRINCIPLED_HAS_SPECULAR)) {
        d_0 = r.specular * min(f0 * r.specular_color, 1.0);
        d_edge = max(r.specular - d_0, 0.0);
        most_0 = r.specular * min(f0 * max_component(r.specular_color), 1.0);
    }
    vec3 most_edge = (principled_has(PRINCIPLED_HAS_SPECULAR) ? r.specular : 1.0) - most_0;
    float smooth_share = max_component(d_0 + d_edge * fresnel_edge(s.eta, wo.z));
    vec3 m_0 = s.base_color, m_edge = 1.0 - s.base_color;
    if (principled_has(PRINCIPLED_HAS_IRIDESCENCE) && !s.inside && r.iridescence > 0.0) {
        float thickness = r.thickness + r.thickness_range;
        vec3 film = fresnel_film(wo.z, r.iridescence_ior, thickness, d_0);
        d_0 = mix(d_0, film, r.iridescence);
        most_0 = mix(most_0, vec3(max_component(film)), r.iridescence);
        most_edge *= 1.0 - r.iridescence;
        d_edge *= 1.0 - r.iridescence;
        if (principled_has(PRINCIPLED_HAS_METAL)) {
            m_0 = mix(m_0, fresnel_film(wo.z, r.iridescence_ior, thickness, m_0), r.iridescence);
            m_edge *= 1.0 - r.iridescence;
        }
    }
    FacetMeans mean = FacetMeans(principled_edge(p, wo.z), schlick_weight(wo.z), 0.0, 0.0, 0.0, vec3(0.0));
    mean.most = min(most_0.y + most_edge.y * mean.edge.y, 1.0);
    if (principled_has(PRINCIPLED_HAS_ROUGH) && !p.ideal) {
        mean = principled_measure(p, most_0, most_edge, wo, s.random.xy);
    }

    // Weights.
    float dielectric = above * (1.0 - metalness);
    float opaque = dielectric * (1.0 - transmission);
    p.r_0 = dielectric * d_0;
    p.r_edge = dielectric * d_edge;
    p.r_schlick = vec3(0.0);
    p.r_total = 0.0;
    if (principled_has(PRINCIPLED_HAS_SPECULAR)) p.r_total = dielectric * transmission * (1.0 - r.specular);
    p.again = opaque * mean.most_lost * d_0;
    if (principled_has(PRINCIPLED_HAS_METAL)) {
        float metal = above * metalness;
        p.r_0 += metal * m_0;
        p.r_schlick = metal * m_edge;
        p.again += metal * mean.lost * metal_again(m_0, m_edge, p.alpha);
    }
    float below = opaque * max(1.0 - mean.most + mean.most_lost * (1.0 - max_component(d_0)), 0.0);
    float diffuse_transmission = principled_has(PRINCIPLED_HAS_DIFFUSE_TRANSMISSION) ? r.diffuse_transmission : 0.0;
    p.base_color = s.base_color;
    p.roughness = r.diffuse_roughness;
    p.diffuse = vec3(below * (1.0 - diffuse_transmission));
    p.through = below * diffuse_transmission * r.diffuse_transmission_color;
    p.t_0 = 1.0 - most_0;
    p.t_edge = most_edge;
    p.transmit = dielectric * transmission * s.base_color;
    if (PRINCIPLED_TRANSMITS) {
        vec3 lost = dielectric * transmission * mean.glass_lost;
        vec3 back = vec3(diffuse_reflectance(p.eta.y));
        if (principled_has(PRINCIPLED_HAS_DISPERSION)) {
            back.xz = vec2(diffuse_reflectance(p.eta.x), diffuse_reflectance(p.eta.z));
        }
        p.again += back * lost;
        p.through += (1.0 - back) * lost * s.base_color;
    }
    if (principled_has(PRINCIPLED_HAS_COAT_DARKENING)) {
        // What the metal and the dielectric send up at normal incidence.
        vec3 up = mix(d_0 + (p.t_0 * (1.0 - transmission) * (1.0 - diffuse_transmission)) * s.base_color, m_0, metalness);
        float roughness = mix(mix(mix(1.0, r.roughness, transmission), r.roughness, smooth_share), r.roughness, metalness);
        principled_darken(p, s, wo, up, roughness);
    }

    // Choices: about the albedo of each. What facets scatter is not 0 where none of those measured does.
    const float UNMEASURED = 1e-3;
    vec3 edge = mean.edge + UNMEASURED;
    vec3 facets = p.r_0 + p.r_edge * edge + p.r_schlick * (mean.schlick + UNMEASURED);
    if (PRINCIPLED_TRANSMITS) facets += p.transmit * max(p.t_0 - p.t_edge * mean.edge, UNMEASURED);
    p.pmf.y = dot(p.hue, facets);
    p.pmf.z += dot(p.hue, p.diffuse * s.base_color + p.again);
    p.pmf.w = dot(p.hue, p.through);
}

// What coat and sheen leave to what lies under them.
float principled_layers(PrincipledSurface s, vec3 wo) {
    Principled p;
    return principled_sheen(p, s, wo, principled_coat(p, s, wo));
}

// The lobes of a surface that is seen from wo, which is above it.
Principled principled_lobes(PrincipledSurface s, vec3 wo) {
    Principled p;
    p.pmf = vec4(0.0);
    p.hue = s.hue;
    float below_coat = principled_coat(p, s, wo);
    float below_sheen = principled_sheen(p, s, wo, below_coat);
    principled_base(p, s, wo, below_sheen);
    float sum = p.pmf.x + p.pmf.y + p.pmf.z + p.pmf.w;
    p.pmf = wo.z > LEAST_COSINE && sum > 0.0 ? p.pmf / sum : vec4(0.0);
    return p;
}

// Value and density of the facets of the base, for wi on the other side of a surface that refracts. Colour by colour,
// since each has facets of its own there.
// Ref: Walter et al. 2007, equations 16 and 17, and 21 over eta^2 for radiance.
BsdfValue principled_refraction(Principled p, vec3 wo, vec3 wi) {
    BsdfValue sum = bsdf_zero();
    float reach_o = ggx_reach(p.alpha, wo), reach_i = ggx_reach(p.alpha, wi);
    for (int i = 0; i < 3; ++i) {
        float eta = p.eta[i];
        vec3 h = normalize(wo + eta * wi);
        if (h.z < 0.0) h = -h;
        float cos_o = dot(wo, h), cos_i = -dot(wi, h);
        float d = ggx_d(p.alpha, h);
        float jacobian = cos_o * cos_i / square(cos_o - eta * cos_i);
        vec3 reflected, transmitted;
        principled_facet(p, cos_o, reflected, transmitted);
        bool exists = cos_o > 0.0 && cos_i > 0.0;
        float f = 4.0 * d * jacobian / ((wo.z + reach_o) * (-wi.z + reach_i));
        float share = principled_transmitted_share(p, reflected, transmitted);
        float pdf = 2.0 * d * jacobian * square(eta) / (wo.z + reach_o) * share;
        vec3 here = principled_has(PRINCIPLED_HAS_DISPERSION) ? vec3(equal(ivec3(i), ivec3(0, 1, 2))) : vec3(1.0);
        if (exists) {
            sum.f += here * transmitted * f;
            sum.pdf += (principled_has(PRINCIPLED_HAS_DISPERSION) ? p.hue[i] : 1.0) * pdf;
        }
        if (!principled_has(PRINCIPLED_HAS_DISPERSION)) break;
    }
    return sum;
}

// Value and density of the facets of the base for wi on the viewer's side, or, for a thin wall, mirrored to it.
BsdfValue principled_reflection(Principled p, vec3 wo, vec3 wi, bool through) {
    vec3 sum = wo + wi;
    float d = ggx_d(p.alpha, normalize(sum));
    float reach_o = ggx_reach(p.alpha, wo);
    float visibility = ggx_visibility(wo.z, wi.z, reach_o, ggx_reach(p.alpha, wi));
    vec3 reflected, transmitted;
    principled_facet(p, 0.5 * length(sum), reflected, transmitted);
    float share = PRINCIPLED_TRANSMITS ? principled_transmitted_share(p, reflected, transmitted) : 0.0;
    return BsdfValue((through ? transmitted : reflected) * (d * visibility),
                     ggx_reflected_pdf(d, wo.z, reach_o) * (through ? share : 1.0 - share));
}

// Value and density of all lobes that are not ideal.
BsdfValue principled_evaluate(Principled p, vec3 wo, vec3 wi) {
    BsdfValue value = bsdf_zero();
    if (wo.z <= LEAST_COSINE || abs(wi.z) <= LEAST_COSINE) return value;
    bool above = wi.z > 0.0;
    float cosine_pdf = warp_cosine_hemisphere_pdf(abs(wi.z));
    if (above) value.f += p.again * INV_PI;
    if (above && principled_has(PRINCIPLED_HAS_DIFFUSE)) {
        if (principled_has(PRINCIPLED_HAS_DIFFUSE_ROUGHNESS)) {
            value.f += p.diffuse * rough_diffuse_f(p.base_color, p.roughness, wo, wi);
        } else {
            value.f += p.base_color * p.diffuse * INV_PI;
        }
    }
    if (above && principled_has(PRINCIPLED_HAS_SHEEN)) value.f += p.sheen * sheen_f(p.sheen_alpha, wo, wi);
    value.pdf = (above ? p.pmf.z : p.pmf.w) * cosine_pdf;
    // Radiance is divided by eta^2, however light gets through.
    if (!above) value.f += p.through * INV_PI / (p.refracts ? p.eta * p.eta : vec3(1.0));
    if (principled_has(PRINCIPLED_HAS_ROUGH) && !p.ideal && p.pmf.y > 0.0) {
        BsdfValue facets = bsdf_zero();
        bool through = PRINCIPLED_TRANSMITS && !above;
        if (through && p.refracts) {
            facets = principled_refraction(p, wo, wi);
        } else if (above || through) {
            facets = principled_reflection(p, wo, vec3(wi.xy, abs(wi.z)), through);
        }
        value.f += facets.f;
        value.pdf += p.pmf.y * facets.pdf;
    }
    if (principled_has(PRINCIPLED_HAS_COAT) && above && !p.coat_ideal && p.pmf.x > 0.0) {
        vec3 o = to_coat(p, wo), i = to_coat(p, wi);
        if (o.z > LEAST_COSINE && i.z > LEAST_COSINE) {
            vec3 sum = o + i;
            float d = ggx_d(vec2(p.coat_alpha), normalize(sum));
            float reach_o = ggx_reach(vec2(p.coat_alpha), o);
            float visibility = ggx_visibility(o.z, i.z, reach_o, ggx_reach(vec2(p.coat_alpha), i));
            float fresnel = coat_fresnel(p, 0.5 * length(sum));
            // The value times the cosine is that in the coat's frame.
            value.f += p.coat * fresnel * d * visibility * (i.z / wi.z);
            value.pdf += p.pmf.x * ggx_reflected_pdf(d, o.z, reach_o);
        }
    }
    return value;
}

// An ideal direction and its weight, where the probability of choosing it is `chosen`.
BsdfSample principled_ideal(vec3 wi, vec3 weight, float chosen, float eta) {
    return bsdf_sample_delta(wi, weight / chosen, chosen, eta);
}

// wi by the facets of the base; `uc` in [0, 1) decides between reflection and transmission.
BsdfSample principled_sample_facets(Principled p, vec3 wo, float uc, vec2 u) {
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (principled_has(PRINCIPLED_HAS_ROUGH) && !p.ideal) h = warp_ggx_visible_normal(u, p.alpha, wo);
    float cos_o = dot(wo, h);
    vec3 reflected, transmitted;
    principled_facet(p, cos_o, reflected, transmitted);
    float share = PRINCIPLED_TRANSMITS ? principled_transmitted_share(p, reflected, transmitted) : 0.0;
    if (!PRINCIPLED_TRANSMITS || uc >= share) {
        vec3 wi = p.ideal ? mirror_direction(wo) : normalize(2.0 * cos_o * h - wo);
        if (wi.z <= 0.0) return bsdf_sample_failed();
        return principled_ideal(wi, reflected, p.pmf.y * (1.0 - share), 1.0);
    }
    if (!p.refracts) {
        vec3 wi = p.ideal ? mirror_direction(wo) : normalize(2.0 * cos_o * h - wo);
        if (wi.z <= 0.0) return bsdf_sample_failed();
        return principled_ideal(vec3(wi.xy, -wi.z), transmitted, p.pmf.y * share, 1.0);
    }
    // One colour decides where the light goes, and takes those along that go there too.
    float eta = p.eta.y;
    float chosen = share;
    if (principled_has(PRINCIPLED_HAS_DISPERSION)) {
        float rest = uc / share;
        eta = rest < p.hue.x ? p.eta.x : rest < p.hue.x + p.hue.y ? p.eta.y : p.eta.z;
        vec3 along = vec3(equal(p.eta, vec3(eta)));
        chosen *= dot(along, p.hue);
        transmitted *= along;
    }
    float cos_t = refracted_cosine(1.0 - square(cos_o), eta);
    vec3 wi = normalize((cos_o / eta - cos_t) * h - wo / eta);
    if (wi.z >= 0.0) return bsdf_sample_failed();
    if (p.ideal) transmitted /= square(eta);
    return principled_ideal(wi, transmitted, p.pmf.y * chosen, eta);
}

// A direction wi from the lobe that uc in [0, 1) chooses, and from u in [0, 1)^2.
BsdfSample principled_sample_f(Principled p, vec3 wo, float uc, vec2 u) {
    BsdfSample s = bsdf_sample_failed();
    bool ideal = false;
    float to_facets = p.pmf.x + p.pmf.y;
    if (uc < p.pmf.x) {
        if (!principled_has(PRINCIPLED_HAS_COAT)) return s;
        vec3 o = to_coat(p, wo);
        ideal = p.coat_ideal;
        vec3 i = mirror_direction(o);
        if (!ideal) {
            vec3 h = warp_ggx_visible_normal(u, vec2(p.coat_alpha), o);
            i = normalize(2.0 * dot(o, h) * h - o);
        }
        float fresnel = coat_fresnel(p, o.z);
        s = principled_ideal(normalize(from_coat(p, i)), vec3(p.coat * fresnel), p.pmf.x, 1.0);
        if (i.z <= LEAST_COSINE || s.wi.z <= LEAST_COSINE) return bsdf_sample_failed();
    } else if (uc < to_facets) {
        ideal = p.ideal;
        s = principled_sample_facets(p, wo, min((uc - p.pmf.x) / p.pmf.y, 0.99999994), u);
        if (s.pdf == 0.0) return s;
    } else if (p.pmf.z + p.pmf.w > 0.0) {
        s.wi = warp_cosine_hemisphere(u);
        if (uc >= to_facets + p.pmf.z) s.wi.z = -s.wi.z;
    }
    if (ideal) return s;
    BsdfValue value = principled_evaluate(p, wo, s.wi);
    if (value.pdf == 0.0) return bsdf_sample_failed();
    float eta = p.refracts && s.wi.z < 0.0 ? p.eta.y : 1.0;
    return BsdfSample(s.wi, value.f * (abs(s.wi.z) / value.pdf), value.pdf, false, eta);
}

#endif
