// The lobes of a principled material seen from one direction: fuzz, coat, sheen and base, from above, each lit by what
// the previous one leaves. bsdf/principled.glsl has the whole on one page.
#ifndef BSDF_PRINCIPLED_LOBES_GLSL
#define BSDF_PRINCIPLED_LOBES_GLSL

#include "base/frame.glsl"
#include "bsdf/fuzz.glsl"
#include "bsdf/iridescence.glsl"
#include "bsdf/principled_facets.glsl"
#include "bsdf/sheen.glsl"
#include "bsdf/sheen_albedo.glsl"

// Conversion between the frame and the coat's frame.
vec3 to_coat(Principled p, vec3 w) {
    return principled_has(PRINCIPLED_HAS_COAT_NORMAL) ? frame_to_local(frame_from_z(p.coat_n), w) : w;
}

vec3 from_coat(Principled p, vec3 w) {
    return principled_has(PRINCIPLED_HAS_COAT_NORMAL) ? frame_to_world(frame_from_z(p.coat_n), w) : w;
}

float coat_fresnel(Principled p, float cos_o) {
    return mix(fresnel_edge(p.coat_ior, cos_o), 1.0, p.coat_f0);
}

// The fuzz's lobe; returns the fraction that it leaves to the layers below.
float principled_fuzz(inout Principled p, PrincipledSurface s, vec3 wo) {
    p.fuzz = vec3(0.0);
    p.fuzz_shape = vec2(1.0, 0.0);
    p.fuzz_pmf = 0.0;
    if (!principled_has(PRINCIPLED_HAS_FUZZ) || s.inside) return 1.0;
    float roughness = max(s.record.fuzz_roughness, MIN_FUZZ_ROUGHNESS);
    float reflected = s.record.fuzz * fuzz_albedo(roughness, wo.z);
    p.fuzz = reflected * s.record.fuzz_color;
    p.fuzz_shape = fuzz_shape(roughness, wo.z);
    p.fuzz_pmf = dot(s.hue, p.fuzz);
    return 1.0 - reflected;
}

// The coat's lobes; returns the fraction that it leaves to the layers below.
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
    p.coat_alpha = max(alpha, MIN_FACET_ALPHA);
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

// Darkens the light that the layers under the coat send up: the coat reflects a part of it down again, and a dark base
// absorbs that. `up` is the fraction that they send up, `roughness` its diffuseness.
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
    p.multiscatter *= factor;
    p.sheen *= factor;
}

// The sheen's lobe under a coat that leaves `above`; returns the fraction that sheen and coat leave.
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

// The facets of the base: their roughness and indices of refraction.
void principled_base_facets(inout Principled p, PrincipledSurface s, float transmission) {
    PrincipledRecord r = s.record;
    float alpha = square(r.roughness);
    p.alpha = vec2(alpha);
    if (principled_has(PRINCIPLED_HAS_ANISOTROPY)) p.alpha.x = mix(alpha, 1.0, square(r.anisotropy));
    p.refracts = principled_has(PRINCIPLED_HAS_VOLUME) && s.encloses;
    // Facets between nearly equal indices turn light by less than MIN_FACET_ALPHA, too.
    bool matched = p.refracts && transmission > 0.0 && abs(s.eta - 1.0) < MIN_FACET_ALPHA;
    p.ideal = is_ideal(p.alpha.x) || matched;
    if (!principled_has(PRINCIPLED_HAS_ROUGH)) p.ideal = true;
    p.alpha = max(p.alpha, MIN_FACET_ALPHA);
    p.eta = vec3(s.eta);
    if (principled_has(PRINCIPLED_HAS_DISPERSION) && p.refracts) p.eta *= s.spread;
}

// The reflectance of facets: d_0 + d_edge t of the dielectric, m_0 + m_edge S of the metal.
struct BaseReflectance {
    vec3 d_0;
    vec3 d_edge;
    vec3 m_0;
    vec3 m_edge;
    vec3 max_0;     // The greatest channel of the dielectric, with the index of red, of green and of blue light:
    vec3 max_edge;  // max_0 + max_edge t.
    float smooth_fraction;  // The greatest channel of the mirror reflection of the dielectric without a film.
};

BaseReflectance principled_base_reflectance(Principled p, PrincipledSurface s, vec3 wo) {
    PrincipledRecord r = s.record;
    BaseReflectance f;
    vec3 root = (p.eta - 1.0) / (p.eta + 1.0);
    vec3 f0 = root * root;
    f.d_0 = f0;
    f.d_edge = 1.0 - f0;
    f.max_0 = f0;
    if (principled_has(PRINCIPLED_HAS_SPECULAR)) {
        f.d_0 = r.specular * min(f0 * r.specular_color, 1.0);
        f.d_edge = max(r.specular - f.d_0, 0.0);
        f.max_0 = r.specular * min(f0 * max_component(r.specular_color), 1.0);
    }
    f.max_edge = (principled_has(PRINCIPLED_HAS_SPECULAR) ? r.specular : 1.0) - f.max_0;
    f.smooth_fraction = max_component(f.d_0 + f.d_edge * fresnel_edge(s.eta, wo.z));
    f.m_0 = s.base_color;
    f.m_edge = 1.0 - s.base_color;
    if (principled_has(PRINCIPLED_HAS_IRIDESCENCE) && !s.inside && r.iridescence > 0.0) {
        float thickness = r.thickness + r.thickness_range;
        vec3 film = fresnel_film(wo.z, r.iridescence_ior, thickness, f.d_0);
        f.d_0 = mix(f.d_0, film, r.iridescence);
        f.max_0 = mix(f.max_0, vec3(max_component(film)), r.iridescence);
        f.max_edge *= 1.0 - r.iridescence;
        f.d_edge *= 1.0 - r.iridescence;
        if (principled_has(PRINCIPLED_HAS_METAL)) {
            f.m_0 = mix(f.m_0, fresnel_film(wo.z, r.iridescence_ior, thickness, f.m_0), r.iridescence);
            f.m_edge *= 1.0 - r.iridescence;
        }
    }
    return f;
}

// The light that the facets lose and leave, by the means over the facets that wo sees.
FacetMeans principled_base_means(Principled p, PrincipledSurface s, BaseReflectance f, vec3 wo) {
    FacetMeans mean = FacetMeans(principled_edge(p, wo.z), schlick_weight(wo.z), 0.0, 0.0, 0.0, vec3(0.0));
    mean.max_reflected = min(f.max_0.y + f.max_edge.y * mean.edge.y, 1.0);
    if (principled_has(PRINCIPLED_HAS_ROUGH) && !p.ideal) {
        mean = principled_measure(p, f.max_0, f.max_edge, wo, s.random.xy);
    }
    return mean;
}

// The weights of the base's lobes under layers that leave the fraction `above`.
void principled_base_weights(inout Principled p, PrincipledSurface s, BaseReflectance f, FacetMeans mean, float above,
                             float metalness, float transmission, float diffuse_transmission) {
    PrincipledRecord r = s.record;
    float dielectric = above * (1.0 - metalness);
    float opaque = dielectric * (1.0 - transmission);
    float bounded = s.inside ? dielectric * transmission : dielectric;  // By facets.
    p.r_0 = bounded * f.d_0;
    p.r_edge = bounded * f.d_edge;
    p.r_schlick = vec3(0.0);
    p.r_total = 0.0;
    if (principled_has(PRINCIPLED_HAS_SPECULAR)) p.r_total = dielectric * transmission * (1.0 - r.specular);
    p.multiscatter = s.inside ? vec3(0.0) : opaque * mean.max_lost * f.d_0;
    if (principled_has(PRINCIPLED_HAS_METAL)) {
        float metal = above * metalness;
        p.r_0 += metal * f.m_0;
        p.r_schlick = metal * f.m_edge;
        p.multiscatter += metal * mean.lost * metal_multiscatter(f.m_0, f.m_edge, p.alpha);
    }
    float below = max(1.0 - mean.max_reflected + mean.max_lost * (1.0 - max_component(f.d_0)), 0.0);
    below = s.inside ? opaque : opaque * below;
    p.base_color = s.base_color;
    p.roughness = r.diffuse_roughness;
    p.diffuse = vec3(below * (1.0 - diffuse_transmission));
    p.through = below * diffuse_transmission * r.diffuse_transmission_color;
    p.t_0 = 1.0 - f.max_0;
    p.t_edge = f.max_edge;
    p.transmit = dielectric * transmission * s.base_color;
    if (PRINCIPLED_TRANSMITS) {
        vec3 lost = dielectric * transmission * mean.glass_lost;
        vec3 back = vec3(diffuse_reflectance(p.eta.y));
        if (principled_has(PRINCIPLED_HAS_DISPERSION)) {
            back.xz = vec2(diffuse_reflectance(p.eta.x), diffuse_reflectance(p.eta.z));
        }
        p.multiscatter += back * lost;
        p.through += (1.0 - back) * lost * s.base_color;
    }
}

// The probabilities of choosing the base's lobes, not yet normalised: about the albedo of each. Scattering by facets is
// not 0 even if none of the measured ones scatters.
void principled_base_choices(inout Principled p, PrincipledSurface s, FacetMeans mean) {
    const float UNMEASURED = 1e-3;
    vec3 edge = mean.edge + UNMEASURED;
    vec3 facets = p.r_0 + p.r_edge * edge + p.r_schlick * (mean.schlick + UNMEASURED);
    if (PRINCIPLED_TRANSMITS) facets += p.transmit * max(p.t_0 - p.t_edge * mean.edge, UNMEASURED);
    p.pmf.y = dot(p.hue, facets);
    p.pmf.z += dot(p.hue, p.diffuse * s.base_color + p.multiscatter);
    p.pmf.w = dot(p.hue, p.through);
}

// The lobes of the base under layers that leave `above`.
void principled_base(inout Principled p, PrincipledSurface s, vec3 wo, float above) {
    PrincipledRecord r = s.record;
    float metalness = principled_has(PRINCIPLED_HAS_METAL) ? r.metalness : 0.0;
    float transmission = PRINCIPLED_TRANSMITS ? r.transmission : 0.0;
    float diffuse_transmission = principled_has(PRINCIPLED_HAS_DIFFUSE_TRANSMISSION) ? r.diffuse_transmission : 0.0;
    principled_base_facets(p, s, transmission);
    BaseReflectance f = principled_base_reflectance(p, s, wo);
    FacetMeans mean = principled_base_means(p, s, f, wo);
    principled_base_weights(p, s, f, mean, above, metalness, transmission, diffuse_transmission);
    if (principled_has(PRINCIPLED_HAS_COAT_DARKENING)) {
        // The light that the metal and the dielectric send up at normal incidence.
        vec3 base = p.t_0 * ((1.0 - transmission) * (1.0 - diffuse_transmission)) * s.base_color;
        float roughness = mix(mix(1.0, r.roughness, transmission), r.roughness, f.smooth_fraction);
        principled_darken(p, s, wo, mix(f.d_0 + base, f.m_0, metalness), mix(roughness, r.roughness, metalness));
    }
    principled_base_choices(p, s, mean);
}

// The fraction of light that fuzz, coat and sheen leave to the base.
float principled_layers(PrincipledSurface s, vec3 wo) {
    Principled p;
    float below_fuzz = principled_fuzz(p, s, wo);
    return principled_sheen(p, s, wo, below_fuzz * principled_coat(p, s, wo));
}

// The lobes of a surface that is seen from wo, which is above it.
Principled principled_lobes(PrincipledSurface s, vec3 wo) {
    Principled p;
    p.pmf = vec4(0.0);
    p.hue = s.hue;
    float below_fuzz = principled_fuzz(p, s, wo);
    float below_coat = below_fuzz * principled_coat(p, s, wo);
    float below_sheen = principled_sheen(p, s, wo, below_coat);
    principled_base(p, s, wo, below_sheen);
    p.coat *= below_fuzz;
    p.pmf.x *= below_fuzz;
    float sum = p.pmf.x + p.pmf.y + p.pmf.z + p.pmf.w;
    if (principled_has(PRINCIPLED_HAS_FUZZ)) sum += p.fuzz_pmf;
    bool scatters = wo.z > MIN_FACET_COSINE && sum > 0.0;
    p.pmf = scatters ? p.pmf / sum : vec4(0.0);
    p.fuzz_pmf = scatters ? p.fuzz_pmf / sum : 0.0;
    return p;
}

#endif
