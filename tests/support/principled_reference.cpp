// See principled_reference.h.
#include "support/principled_reference.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "support/layer_reference.h"

namespace candela {
namespace {

constexpr double PI_D = std::numbers::pi;
constexpr double LEAST_ALPHA = 1e-3;            // Below it, reflection is ideal.
constexpr double LEAST_SHEEN_ROUGHNESS = 0.07;  // The model has no value at 0.
constexpr double ETA_OF_A_PERFECT_REFLECTOR = 1e6;

double square(double x) {
    return x * x;
}

double max_channel(dvec3 v) {
    return std::max({v.x, v.y, v.z});
}

dvec3 mirrored(dvec3 w) {
    return dvec3(w.x, w.y, -w.z);
}

// Reflection by facets that reflect everything. Ref: Walter et al. 2007, "Microfacet models for refraction
// through rough surfaces", eq. 20, with Heitz 2014, eq. 99.
double facet_reflection(const Facets& facets, dvec3 wo, dvec3 wi) {
    if (wo.z <= 0 || wi.z <= 0) return 0;
    const double g2 = 1 / (1 + smith_lambda(facets, wo) + smith_lambda(facets, wi));
    return facet_distribution(facets, normalize(wo + wi)) * g2 / (4 * wo.z * wi.z);
}

// The normal, on the viewer's side, at which facets refract one direction into the other; h.z <= 0: none
// does. Ref: the same, eq. 16.
dvec3 refracting_normal(dvec3 wo, dvec3 wi, double eta) {
    const dvec3 sum = wo + eta * wi;
    if (length(sum) == 0) return dvec3(0, 0, -1);
    const dvec3 h = normalize(sum.z < 0 ? -sum : sum);
    return dot(wo, h) > 0 && dot(wi, h) < 0 ? h : dvec3(0, 0, -1);
}

// Refraction by facets that reflect nothing, for radiance. Ref: the same, eq. 21 to 23.
double facet_refraction(const Facets& facets, dvec3 wo, dvec3 wi, double eta) {
    const dvec3 h = refracting_normal(wo, wi, eta);
    if (wo.z <= 0 || wi.z >= 0 || h.z <= 0) return 0;
    const double g = smith_g1(facets, wo) * smith_g1(facets, wi);
    return std::abs(dot(wo, h) * dot(wi, h) / (wo.z * wi.z)) * g * facet_distribution(facets, h) /
           square(dot(wo, h) + eta * dot(wi, h));
}

}  // namespace

PrincipledReference::PrincipledReference(const PrincipledParameters& parameters, dvec3 wo)
    : p_(parameters), wo_(wo) {
    assert(wo.z > 0 && !(p_.thin && p_.inside));
    find_optics();
    find_shares();
    find_layers();
    if (p_.thin || p_.transmission == 0 || p_.dispersion == 0 || p_.ior == 0) return;
    for (int k = 0; k < 3; ++k) {
        PrincipledParameters channel = p_;
        channel.ior = dispersed_ior(p_.ior, p_.dispersion)[k];
        channel.dispersion = 0;
        channels_.emplace_back(channel, wo);
    }
}

// Roughness (KHR_materials_anisotropy), indices (KHR_materials_ior) and reflectance at normal incidence
// (KHR_materials_specular, _iridescence).
void PrincipledReference::find_optics() {
    const double alpha = square(p_.roughness);
    facets_ = {std::lerp(alpha, 1.0, square(p_.anisotropy)), alpha};
    ideal_ = std::max(facets_.alpha_x, facets_.alpha_y) < LEAST_ALPHA;
    facets_ = {std::max(facets_.alpha_x, LEAST_ALPHA), std::max(facets_.alpha_y, LEAST_ALPHA)};

    const double ior = p_.ior == 0 ? ETA_OF_A_PERFECT_REFLECTOR : p_.ior;
    eta_ = p_.inside ? 1 / ior : ior;
    f0_ = min(fresnel_normal(eta_) * p_.specular_color, dvec3(1));

    film_ = p_.inside ? 0 : p_.iridescence;
    if (film_ > 0) {
        const auto film = [&](dvec3 base_f0) {
            return iridescent_fresnel(p_.iridescence_ior, base_f0, p_.iridescence_thickness, wo_.z);
        };
        film_metal_ = film(p_.base_color);
        film_dielectric_ = film(p_.specular * f0_);
    }
    metal_f0_ = mix(p_.base_color, film_metal_, film_);
    dielectric_f0_ = mix(p_.specular * f0_, film_dielectric_, film_);
}

// Albedos and the compensation of multiple scattering. Ref: Turquin 2019, "Practical multiple scattering
// compensation for microfacet models", eq. 16.
void PrincipledReference::find_shares() {
    Shares& s = shares_;
    const double ax = facets_.alpha_x, ay = facets_.alpha_y;
    s.a = ideal_ ? 1 : ggx_albedo(ax, ay, wo_);
    s.b = ideal_ ? fresnel_edge(wo_.z, eta_) : ggx_edge_albedo(ax, ay, wo_, eta_);
    s.k_metal = dvec3(1) + metal_f0_ * (1 - s.a) / s.a;
    s.k_dielectric = dvec3(1) + dielectric_f0_ * (1 - s.a) / s.a;

    const dvec3 without_film = p_.specular * (f0_ * s.a + (dvec3(1) - f0_) * s.b);
    s.r = max_channel(mix(without_film, film_dielectric_ * s.a, film_) * s.k_dielectric);

    if (p_.transmission == 0) return;
    if (p_.thin) {
        s.k_transmissive = 1 / s.a;
        return;
    }
    // The albedo of facets that reflect the greatest channel and refract the rest: Fresnel's reflectance F,
    // scaled to s g F - s (f0 g - f0_max), where there is no total internal reflection.
    s.e = ideal_ ? 1 : glass_albedo(ax, ay, wo_, eta_);
    s.e0 = ideal_ ? 1 : glass_albedo_clear(ax, ay, wo_, eta_);
    const double f0 = fresnel_normal(eta_), f0_max = max_channel(f0_);
    const double g = (1 - f0_max) / (1 - f0), sg = p_.specular * g;
    const double albedo = sg * s.e + (1 - sg) * s.e0 - p_.specular * (f0 * g - f0_max) * (s.a - s.e0);
    // A film reflects the same share everywhere, its greatest channel here.
    s.k_transmissive = 1 / std::lerp(albedo, std::lerp(s.e0, s.a, max_channel(film_dielectric_)), film_);
}

// Sheen (KHR_materials_sheen, "Albedo-scaling technique", of wo alone) and coat (KHR_materials_clearcoat, by
// albedo; OpenPBR 1.1, "Darkening"): a viewer inside a volume sees neither.
void PrincipledReference::find_layers() {
    has_sheen_ = !p_.inside && max_channel(p_.sheen_color) > 0;
    if (has_sheen_) {
        alpha_g_ = square(std::max(p_.sheen_roughness, LEAST_SHEEN_ROUGHNESS));
        shares_.es = sheen_albedo(alpha_g_, wo_.z);
        // The model reflects more than all light where fibres are smooth and light grazes them: it is scaled.
        sheen_scale_ = 1 / std::max(1.0, shares_.es);
        sheen_transmittance_ = 1 - max_channel(p_.sheen_color) * sheen_scale_ * shares_.es;
    }

    const double cosine = dot(wo_, p_.coat_normal);
    has_coat_ = !p_.inside && p_.coat > 0 && cosine > 0;
    if (!has_coat_) return;
    const dvec3 side = std::abs(p_.coat_normal.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    coat_y_ = normalize(cross(p_.coat_normal, side));
    coat_x_ = cross(coat_y_, p_.coat_normal);
    const double alpha = square(p_.coat_roughness);
    coat_ideal_ = alpha < LEAST_ALPHA;
    coat_facets_ = {std::max(alpha, LEAST_ALPHA), std::max(alpha, LEAST_ALPHA)};
    const double f0 = fresnel_normal(p_.coat_ior);
    const dvec3 wo = to_coat(wo_);
    const double a = coat_ideal_ ? 1 : ggx_albedo(coat_facets_.alpha_x, coat_facets_.alpha_y, wo);
    const double b = coat_ideal_
                         ? fresnel_edge(cosine, p_.coat_ior)
                         : ggx_edge_albedo(coat_facets_.alpha_x, coat_facets_.alpha_y, wo, p_.coat_ior);
    shares_.rc = f0 * a + (1 - f0) * b;
    coat_transmittance_ = 1 - p_.coat * shares_.rc;

    // Estimates of the base's roughness and reflectance. Where it transmits, no diffuse base lies below it.
    const double specular_share = max_channel(dielectric_fresnel(wo_.z));
    const double below = std::lerp(1.0, p_.roughness, p_.transmission);
    const double roughness =
        std::lerp(std::lerp(below, p_.roughness, specular_share), p_.roughness, p_.metalness);
    const double diffuse =
        (1 - max_channel(dielectric_f0_)) * (1 - p_.transmission) * (1 - p_.diffuse_transmission);
    const dvec3 albedo = mix(dielectric_f0_ + diffuse * p_.base_color, metal_f0_, p_.metalness);
    darkening_ =
        mix(dvec3(1), coat_darkening(p_.coat_ior, cosine, albedo, roughness), p_.coat * p_.coat_darkening);
}

// Facets between equal indices turn no light, however rough they are: all goes straight on.
bool PrincipledReference::is_unrefracting() const {
    return !p_.thin && p_.transmission > 0 && eta_ == 1;
}

// F_d, with Fresnel's own curve between normal incidence and the edge; KHR_materials_specular.
dvec3 PrincipledReference::dielectric_fresnel(double cosine) const {
    return p_.specular * (f0_ + (dvec3(1) - f0_) * fresnel_edge(cosine, eta_));
}

dvec3 PrincipledReference::film_or_dielectric_fresnel(double cosine) const {
    return mix(dielectric_fresnel(cosine), film_dielectric_, film_);
}

// What all kinds of specular reflection together multiply facets' reflection by.
dvec3 PrincipledReference::specular_fresnel(double cosine) const {
    const dvec3 schlick = p_.base_color + (dvec3(1) - p_.base_color) * std::pow(1 - cosine, 5);
    const dvec3 metal = mix(schlick, film_metal_, film_) * shares_.k_metal;
    // Where no light is transmitted, the transmitting share of the surface reflects all of it.
    const bool total = !p_.thin && refracted_cosine_squared(cosine, eta_) <= 0;
    const dvec3 reflected = film_or_dielectric_fresnel(cosine);
    const dvec3 dielectric = mix(reflected * shares_.k_dielectric,
                                 (total ? dvec3(1) : reflected) * shares_.k_transmissive, p_.transmission);
    return mix(dielectric, metal, p_.metalness);
}

// The same for specular transmission; KHR_materials_transmission.
dvec3 PrincipledReference::transmittance(double cosine) const {
    if (!p_.thin && refracted_cosine_squared(cosine, eta_) <= 0) return dvec3(0);
    return (1 - p_.metalness) * p_.transmission * p_.base_color *
           (1 - max_channel(film_or_dielectric_fresnel(cosine))) * shares_.k_transmissive;
}

double PrincipledReference::coat_fresnel(double cosine) const {
    const double f0 = fresnel_normal(p_.coat_ior);
    return f0 + (1 - f0) * fresnel_edge(cosine, p_.coat_ior);
}

dvec3 PrincipledReference::reflection_value(dvec3 wi) const {
    if (ideal_ || wi.z <= 0) return dvec3(0);
    return facet_reflection(facets_, wo_, wi) * specular_fresnel(dot(wo_, normalize(wo_ + wi)));
}

// Through a thin wall, light scatters as if reflected and then mirrored at the wall
// (KHR_materials_transmission).
dvec3 PrincipledReference::transmission_value(dvec3 wi) const {
    if (ideal_ || wi.z >= 0 || p_.transmission == 0) return dvec3(0);
    if (p_.thin) {
        const dvec3 other = mirrored(wi);
        return facet_reflection(facets_, wo_, other) * transmittance(dot(wo_, normalize(wo_ + other)));
    }
    if (is_unrefracting()) return dvec3(0);
    const double value = facet_refraction(facets_, wo_, wi, eta_);
    return value > 0 ? value * transmittance(dot(wo_, refracting_normal(wo_, wi, eta_))) : dvec3(0);
}

// In the frame of the coat's own normal.
double PrincipledReference::coat_value(dvec3 wi) const {
    if (!has_coat_ || coat_ideal_ || wi.z <= 0) return 0;
    const dvec3 o = to_coat(wo_), i = to_coat(wi);
    // Light falls on the coat under its own cosine.
    return p_.coat * coat_fresnel(dot(o, normalize(o + i))) * facet_reflection(coat_facets_, o, i) * i.z /
           wi.z;
}

dvec3 PrincipledReference::to_coat(dvec3 w) const {
    return dvec3(dot(w, coat_x_), dot(w, coat_y_), dot(w, p_.coat_normal));
}

dvec3 PrincipledReference::from_coat(dvec3 w) const {
    return w.x * coat_x_ + w.y * coat_y_ + w.z * p_.coat_normal;
}

PrincipledLobes PrincipledReference::lobes(dvec3 wi) const {
    PrincipledLobes l;
    if (wi.z == 0) return l;
    if (!channels_.empty()) {
        for (int k = 0; k < 3; ++k) {
            const PrincipledLobes c = channels_[size_t(k)].lobes(wi);
            for (const auto lobe :
                 {&PrincipledLobes::coat, &PrincipledLobes::sheen, &PrincipledLobes::reflection,
                  &PrincipledLobes::transmission, &PrincipledLobes::diffuse_reflection,
                  &PrincipledLobes::diffuse_transmission})
                (l.*lobe)[k] = (c.*lobe)[k];
        }
        return l;
    }
    const double diffuse = (1 - p_.metalness) * (1 - p_.transmission) * (1 - shares_.r);
    const double under_layers = coat_transmittance_ * sheen_transmittance_;
    if (wi.z > 0) {
        l.coat = dvec3(coat_value(wi));
        if (has_sheen_)
            l.sheen =
                coat_transmittance_ * darkening_ * p_.sheen_color * sheen_scale_ * sheen_f(alpha_g_, wo_, wi);
        l.reflection = under_layers * darkening_ * reflection_value(wi);
        l.diffuse_reflection = under_layers * darkening_ * diffuse * (1 - p_.diffuse_transmission) *
                               eon_f(p_.base_color, p_.diffuse_roughness, wo_, wi);
    } else {
        l.transmission = under_layers * transmission_value(wi);
        l.diffuse_transmission =
            under_layers * diffuse * p_.diffuse_transmission / PI_D * p_.diffuse_transmission_color;
    }
    return l;
}

PrincipledLobes PrincipledReference::ideal() const {
    PrincipledLobes l;
    if (!channels_.empty()) {
        for (int k = 0; k < 3; ++k) {
            const PrincipledLobes c = channels_[size_t(k)].ideal();
            for (const auto lobe :
                 {&PrincipledLobes::coat, &PrincipledLobes::reflection, &PrincipledLobes::transmission})
                (l.*lobe)[k] = (c.*lobe)[k];
        }
        return l;
    }
    if (has_coat_ && coat_ideal_ && reflect(wo_, p_.coat_normal).z > 0)
        l.coat = dvec3(p_.coat * coat_fresnel(dot(wo_, p_.coat_normal)));
    const double under_layers = coat_transmittance_ * sheen_transmittance_;
    if (!ideal_ && is_unrefracting()) l.transmission = under_layers * shares_.e0 * transmittance(wo_.z);
    if (!ideal_) return l;
    l.reflection = under_layers * darkening_ * specular_fresnel(wo_.z);
    l.transmission = under_layers * transmittance(wo_.z);
    return l;
}

PrincipledLobes PrincipledReference::albedos() const {
    PrincipledLobes l;
    if (!channels_.empty()) {
        for (int k = 0; k < 3; ++k) {
            const PrincipledLobes c = channels_[size_t(k)].albedos();
            for (const auto lobe :
                 {&PrincipledLobes::coat, &PrincipledLobes::sheen, &PrincipledLobes::reflection,
                  &PrincipledLobes::transmission, &PrincipledLobes::diffuse_reflection,
                  &PrincipledLobes::diffuse_transmission})
                (l.*lobe)[k] = (c.*lobe)[k];
        }
        return l;
    }
    l = ideal();
    // f cos / pdf, where light that wo sees by reflection at h has the density D_wo(h) / (4 o.h).
    if (!ideal_) {
        const auto mean = [&](const std::function<dvec3(dvec3)>& g) {
            return mean_over_visible_normals(facets_, wo_, p_.thin ? 1 : eta_, g);
        };
        const auto weight = [&](dvec3 h) { return 4 * dot(wo_, h) / visible_normals_pdf(facets_, wo_, h); };
        l.reflection = mean([&](dvec3 h) {
            const dvec3 wi = reflect(wo_, h);
            return wi.z > 0 ? lobes(wi).reflection * wi.z * weight(h) : dvec3(0);
        });
        if (p_.transmission > 0 && p_.thin)
            l.transmission = mean([&](dvec3 h) {
                const dvec3 wi = reflect(wo_, h);
                return wi.z > 0 ? lobes(mirrored(wi)).transmission * wi.z * weight(h) : dvec3(0);
            });
        // Refraction: D_wo(h) eta^2 |i.h| / (o.h + eta i.h)^2, of which eta^2 is taken up by energy.
        if (p_.transmission > 0 && !p_.thin && !is_unrefracting())
            l.transmission = mean([&](dvec3 h) {
                if (refracted_cosine_squared(dot(wo_, h), eta_) <= 0) return dvec3(0);
                const dvec3 wi = refract(wo_, h, eta_);
                if (wi.z >= 0) return dvec3(0);
                const double denominator = square(dot(wo_, h) + eta_ * dot(wi, h));
                return lobes(wi).transmission * -wi.z * denominator /
                       (std::abs(dot(wi, h)) * visible_normals_pdf(facets_, wo_, h));
            });
    }
    if (has_coat_ && !coat_ideal_) {
        const dvec3 o = to_coat(wo_);
        l.coat = mean_over_visible_normals(coat_facets_, o, 1, [&](dvec3 h) {
            const dvec3 wi = from_coat(reflect(o, h));
            if (wi.z <= 0) return dvec3(0);
            return lobes(wi).coat * wi.z * 4.0 * dot(o, h) / visible_normals_pdf(coat_facets_, o, h);
        });
    }
    if (has_sheen_) l.sheen = integrate_over_cosine(wo_, [&](dvec3 wi) { return lobes(wi).sheen; });
    l.diffuse_reflection = integrate_over_cosine(wo_, [&](dvec3 wi) { return lobes(wi).diffuse_reflection; });
    l.diffuse_transmission =
        integrate_over_cosine(wo_, [&](dvec3 wi) { return lobes(mirrored(wi)).diffuse_transmission; });
    return l;
}

}  // namespace candela
