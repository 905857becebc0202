// The principled material: a dielectric or metallic base under sheen and coat, as glTF 2.0 layers them, and under
// OpenPBR's fuzz. Reading order:
//
//     fuzz                            fuzz fuzz_color Ef Zeltner                       1 - fuzz Ef
//       over coat (its own normal)    coat Fc D G                                      1 - <coat Fc s>
//         over sheen                  sheen_color Charlie                              1 - max(sheen_color) Es
//           over mix(by metalness)
//             metal                   Fm D G
//             dielectric              Fd D G
//               over mix(by transmission)
//                 refraction          base_color (1 - max Fd) D G
//                 diffuse             base_color, diffuse_transmission_color           1 - <max Fd>
//
// Within a solid, light meets the facets of the transmitting part, and the diffuse base of the rest without facets.
//
// The last column is the light that a layer leaves to those below, a function of wo alone: the light that it does not
// scatter itself. (By facets, as in glTF's own sample code, light would be gained at grazing angles.) Light that is
// scattered more than once among facets is the light that they lose to shadowing, <1 - s>; it leaves the surface as
// from a diffuse one.
//
// <x> is the mean of x over the facets that wo sees. A lattice of FACETS facets at random places measures it, without
// bias, since everything measured enters linearly: there are no tables of albedos, and no fits. So a surface has
// different lobes at each vertex, and the right ones on average. No light is gained or lost, at any roughness, indices
// and film. The whole is not reciprocal; each of its lobes is, except fuzz.
// Ref: glTF 2.0, appendix B, and its extensions KHR_materials_*; OpenPBR 1.1; Kulla and Conty 2017, Revisiting
// Physically Based Shading at Imageworks, on lost light; Cranley and Patterson 1976, Randomization of Number Theoretic
// Methods for Multiple Integration, on such lattices.
//
// Local frame, z on the viewer's side, x along the direction that anisotropy makes rougher.
#ifndef BSDF_PRINCIPLED_GLSL
#define BSDF_PRINCIPLED_GLSL

#include "base/warp.glsl"
#include "bsdf/mirror.glsl"
#include "bsdf/principled_lobes.glsl"
#include "bsdf/rough_diffuse.glsl"
#include "bsdf/sample.glsl"

// Value and density of the facets of the base, for wi on the other side of a surface that refracts. Each colour is
// evaluated alone, since each has its own facets there.
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
        float fraction = principled_transmitted_fraction(p, reflected, transmitted);
        float pdf = 2.0 * d * jacobian * square(eta) / (wo.z + reach_o) * fraction;
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
    float fraction = PRINCIPLED_TRANSMITS ? principled_transmitted_fraction(p, reflected, transmitted) : 0.0;
    return BsdfValue((through ? transmitted : reflected) * (d * visibility),
                     ggx_reflected_pdf(d, wo.z, reach_o) * (through ? fraction : 1.0 - fraction));
}

// Value and density of a coat that is not ideal, with its own normal, which also decides the side of a direction. The
// value is for a cosine of wi to another normal: 1 gives the value times the cosine to the coat's.
BsdfValue principled_coat_evaluate(Principled p, vec3 wo, vec3 wi, float cosine) {
    if (p.coat_ideal || p.pmf.x <= 0.0) return bsdf_zero();
    vec3 o = to_coat(p, wo), i = to_coat(p, wi);
    if (o.z <= MIN_FACET_COSINE || i.z <= MIN_FACET_COSINE) return bsdf_zero();
    vec3 sum = o + i;
    float d = ggx_d(vec2(p.coat_alpha), normalize(sum));
    float reach_o = ggx_reach(vec2(p.coat_alpha), o);
    float visibility = ggx_visibility(o.z, i.z, reach_o, ggx_reach(vec2(p.coat_alpha), i));
    float fresnel = coat_fresnel(p, 0.5 * length(sum));
    return BsdfValue(vec3(p.coat * fresnel * d * visibility * (i.z / cosine)),
                     p.pmf.x * ggx_reflected_pdf(d, o.z, reach_o));
}

// Value and density of all lobes that are not ideal.
BsdfValue principled_evaluate(Principled p, vec3 wo, vec3 wi) {
    BsdfValue value = bsdf_zero();
    if (wo.z <= MIN_FACET_COSINE || abs(wi.z) <= MIN_FACET_COSINE) return value;
    bool above = wi.z > 0.0;
    float cosine_pdf = warp_cosine_hemisphere_pdf(abs(wi.z));
    if (above) value.f += p.multiscatter * INV_PI;
    if (above && principled_has(PRINCIPLED_HAS_DIFFUSE)) {
        if (principled_has(PRINCIPLED_HAS_DIFFUSE_ROUGHNESS)) {
            value.f += p.diffuse * rough_diffuse_f(p.base_color, p.roughness, wo, wi);
        } else {
            value.f += p.base_color * p.diffuse * INV_PI;
        }
    }
    if (above && principled_has(PRINCIPLED_HAS_SHEEN)) value.f += p.sheen * sheen_f(p.sheen_alpha, wo, wi);
    value.pdf = (above ? p.pmf.z : p.pmf.w) * cosine_pdf;
    if (principled_has(PRINCIPLED_HAS_FUZZ) && above) {
        float f = fuzz_f(p.fuzz_shape, wo, wi);
        value.f += p.fuzz * f;
        value.pdf += p.fuzz_pmf * f * wi.z;
    }
    // Radiance is divided by eta^2 for every kind of transmission.
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
    if (principled_has(PRINCIPLED_HAS_COAT) && above) {
        BsdfValue coat = principled_coat_evaluate(p, wo, wi, wi.z);
        value.f += coat.f;
        value.pdf += coat.pdf;
    }
    return value;
}

// See bsdf_is_sharp().
bool principled_is_sharp(Principled p, float uc) {
    bool coat = principled_has(PRINCIPLED_HAS_COAT) && (p.coat_ideal || p.coat_alpha <= SHARP_ALPHA);
    bool base = p.ideal || max(p.alpha.x, p.alpha.y) <= SHARP_ALPHA;
    float sharp = (coat ? p.pmf.x : 0.0) + (base ? p.pmf.y : 0.0);
    bool chosen = uc < p.pmf.x ? coat : uc < p.pmf.x + p.pmf.y && base;
    return chosen && sharp >= 0.5;
}

// An ideal direction and its weight; `chosen` is the probability of choosing it.
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
    float fraction = PRINCIPLED_TRANSMITS ? principled_transmitted_fraction(p, reflected, transmitted) : 0.0;
    if (!PRINCIPLED_TRANSMITS || uc >= fraction) {
        vec3 wi = p.ideal ? mirror_direction(wo) : normalize(2.0 * cos_o * h - wo);
        if (wi.z <= 0.0) return bsdf_sample_failed();
        return principled_ideal(wi, reflected, p.pmf.y * (1.0 - fraction), 1.0);
    }
    if (!p.refracts) {
        vec3 wi = p.ideal ? mirror_direction(wo) : normalize(2.0 * cos_o * h - wo);
        if (wi.z <= 0.0) return bsdf_sample_failed();
        return principled_ideal(vec3(wi.xy, -wi.z), transmitted, p.pmf.y * fraction, 1.0);
    }
    // One colour decides the direction; the others follow if they scatter into it, too.
    float eta = p.eta.y;
    float chosen = fraction;
    if (principled_has(PRINCIPLED_HAS_DISPERSION)) {
        float rest = uc / fraction;
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
        s.above = true;
        if (i.z <= MIN_FACET_COSINE) return bsdf_sample_failed();
        // Below the horizon of the other layers, the coat is alone.
        if (principled_has(PRINCIPLED_HAS_COAT_NORMAL) && !ideal && s.wi.z <= MIN_FACET_COSINE) {
            BsdfValue coat = principled_coat_evaluate(p, wo, s.wi, 1.0);
            if (coat.pdf == 0.0) return bsdf_sample_failed();
            return BsdfSample(s.wi, coat.f / coat.pdf, coat.pdf, false, 1.0, true);
        }
    } else if (uc < to_facets) {
        ideal = p.ideal;
        s = principled_sample_facets(p, wo, min((uc - p.pmf.x) / p.pmf.y, 0.99999994), u);
        if (s.pdf == 0.0) return s;
    } else if (principled_has(PRINCIPLED_HAS_FUZZ) && uc >= 1.0 - p.fuzz_pmf) {
        s.wi = fuzz_direction(p.fuzz_shape, wo, u);
    } else if (p.pmf.z + p.pmf.w > 0.0) {
        s.wi = warp_cosine_hemisphere(u);
        if (uc >= to_facets + p.pmf.z) s.wi.z = -s.wi.z;
    } else {
        return s;
    }
    if (ideal) return s;
    BsdfValue value = principled_evaluate(p, wo, s.wi);
    if (value.pdf == 0.0) return bsdf_sample_failed();
    float eta = p.refracts && s.wi.z < 0.0 ? p.eta.y : 1.0;
    return BsdfSample(s.wi, value.f * (abs(s.wi.z) / value.pdf), value.pdf, false, eta, s.wi.z > 0.0);
}

#endif
