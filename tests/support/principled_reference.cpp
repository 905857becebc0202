// See principled_reference.h.
#include "support/principled_reference.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "support/ggx_reference.h"
#include "support/layer_reference.h"

namespace candela {
namespace {

constexpr double MIN_FACET_ALPHA = 1e-3;        // Below it, reflection is ideal.
constexpr double MIN_STEP_OF_THE_INDEX = 1e-3;  // The same, in a volume.
constexpr double MIN_SHEEN_ROUGHNESS = 0.07;    // The model has no value at 0.
constexpr double MIN_FUZZ_ROUGHNESS = 0.01;     // The least that its fits are for.
constexpr double ETA_OF_A_PERFECT_REFLECTOR = 1e6;

double max_channel(dvec3 v) {
    return std::max({v.x, v.y, v.z});
}

dvec3 mirrored(dvec3 w) {
    return dvec3(w.x, w.y, -w.z);
}

// The lobes of three materials, one for each channel.
template <class Material>
PrincipledLobes by_channel(const Material& lobes_of) {
    PrincipledLobes l;
    for (int k = 0; k < 3; ++k) {
        const PrincipledLobes c = lobes_of(size_t(k));
        for (const auto lobe : {&PrincipledLobes::fuzz, &PrincipledLobes::coat, &PrincipledLobes::sheen,
                                &PrincipledLobes::reflection, &PrincipledLobes::transmission,
                                &PrincipledLobes::diffuse_reflection, &PrincipledLobes::diffuse_transmission,
                                &PrincipledLobes::multiscatter_up, &PrincipledLobes::multiscatter_down})
            (l.*lobe)[k] = (c.*lobe)[k];
    }
    return l;
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
    find_fractions();
    find_diffuse_parts();
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
    const double ior = p_.ior == 0 ? ETA_OF_A_PERFECT_REFLECTOR : p_.ior;
    eta_ = p_.inside ? 1 / ior : ior;
    // Facets between equal indices turn no light, however rough they are.
    const bool is_unrefracting =
        !p_.thin && p_.transmission > 0 && std::abs(eta_ - 1) < MIN_STEP_OF_THE_INDEX;

    const double alpha = square(p_.roughness);
    facets_ = {std::lerp(alpha, 1.0, square(p_.anisotropy)), alpha};
    ideal_ = is_unrefracting || std::max(facets_.alpha_x, facets_.alpha_y) < MIN_FACET_ALPHA;
    facets_ = {std::max(facets_.alpha_x, MIN_FACET_ALPHA), std::max(facets_.alpha_y, MIN_FACET_ALPHA)};

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

// Means over the facets that wo sees.
void PrincipledReference::find_fractions() {
    const auto mean = [&](const std::function<dvec3(dvec3)>& g) {
        return ideal_ ? g(dvec3(0, 0, 1)) : mean_over_visible_normals(facets_, wo_, p_.thin ? 1 : eta_, g);
    };
    const auto reflection_lost = [&](dvec3 h) {
        return ideal_ ? 0 : 1 - reflected_fraction(facets_, wo_, h);
    };
    const auto transmission_lost = [&](dvec3 h) {
        // What a thin wall transmits is shadowed as if reflected.
        return ideal_ || p_.thin ? reflection_lost(h) : 1 - refracted_fraction(facets_, wo_, h, eta_);
    };
    const dvec3 reflected = mean([&](dvec3 h) {
        const double fresnel = greatest_fresnel(dot(wo_, h));
        return dvec3(reflection_lost(h), fresnel, fresnel * reflection_lost(h));
    });
    fractions_.metal_lost = reflected[0];
    fractions_.dielectric_reflected = reflected[1];
    fractions_.dielectric_lost = reflected[2];
    if (p_.transmission == 0) return;
    const dvec3 transmitted = mean([&](dvec3 h) {
        const double fresnel = greatest_transmitting_fresnel(dot(wo_, h));
        return dvec3(std::lerp(transmission_lost(h), reflection_lost(h), fresnel));
    });
    fractions_.glass_lost = transmitted[0];
}

// What facets lose goes out diffusely, as much as metal reflects and on those sides to which glass sends
// diffuse light. After Kulla and Conty 2017, "Revisiting physically based shading at Imageworks", but as a
// function of wo alone.
void PrincipledReference::find_diffuse_parts() {
    const double alpha = std::hypot(facets_.alpha_x, facets_.alpha_y) / std::numbers::sqrt2;
    const dvec3 metal_multiscatter =
        ggx_multiscatter(alpha, metal_f0_, (1 - film_) * (dvec3(1) - p_.base_color));

    // Schlick's reflectance of an even sky. From inside, the share eta^2 of it is not totally reflected, and
    // of that, as much is transmitted as from outside.
    const double f0 = fresnel_normal(eta_), outside = f0 + (1 - f0) / 21;
    const double up = p_.thin || eta_ >= 1 ? outside : 1 - (1 - outside) * square(eta_);

    // What the dielectric over an opaque base does not reflect again joins the light that reaches the base.
    const double dielectric = (1 - p_.metalness) * (1 - p_.transmission);
    const double glass = (1 - p_.metalness) * p_.transmission;
    multiscatter_up_ =
        p_.metalness * fractions_.metal_lost * metal_multiscatter + glass * fractions_.glass_lost * up;
    multiscatter_down_ = glass * fractions_.glass_lost * (1 - up) * p_.base_color;
    // Nothing lies between the inside of a volume and the opaque base.
    diffuse_ = dielectric;
    if (p_.inside) return;
    multiscatter_up_ += dielectric * fractions_.dielectric_lost * dielectric_f0_;
    diffuse_ *=
        1 - fractions_.dielectric_reflected + fractions_.dielectric_lost * (1 - max_channel(dielectric_f0_));
}

// Sheen (KHR_materials_sheen, "Albedo-scaling technique", of wo alone), coat (KHR_materials_clearcoat, by
// albedo; OpenPBR 1.1, "Darkening") and fuzz (OpenPBR 1.1, whose colour is that of reflection alone): a
// viewer inside a volume sees none.
void PrincipledReference::find_layers() {
    has_fuzz_ = !p_.inside && p_.fuzz > 0;
    if (has_fuzz_) {
        fuzz_roughness_ = std::max(p_.fuzz_roughness, MIN_FUZZ_ROUGHNESS);
        fuzz_transmittance_ = 1 - p_.fuzz * fuzz_albedo(fuzz_roughness_, wo_.z);
    }

    has_sheen_ = !p_.inside && max_channel(p_.sheen_color) > 0;
    if (has_sheen_) {
        alpha_g_ = square(std::max(p_.sheen_roughness, MIN_SHEEN_ROUGHNESS));
        fractions_.es = sheen_albedo(alpha_g_, wo_.z);
        // The model reflects more than all light where fibres are smooth and light grazes them: it is scaled.
        sheen_scale_ = 1 / std::max(1.0, fractions_.es);
        sheen_transmittance_ = 1 - max_channel(p_.sheen_color) * sheen_scale_ * fractions_.es;
    }

    const double cosine = dot(wo_, p_.coat_normal);
    has_coat_ = !p_.inside && p_.coat > 0 && cosine > 0;
    if (!has_coat_) return;
    const dvec3 side = std::abs(p_.coat_normal.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    coat_y_ = normalize(cross(p_.coat_normal, side));
    coat_x_ = cross(coat_y_, p_.coat_normal);
    const double alpha = square(p_.coat_roughness);
    coat_ideal_ = alpha < MIN_FACET_ALPHA;
    coat_facets_ = {std::max(alpha, MIN_FACET_ALPHA), std::max(alpha, MIN_FACET_ALPHA)};
    const dvec3 wo = to_coat(wo_);
    fractions_.rc =
        coat_ideal_ ? coat_fresnel(cosine)
                    : mean_over_visible_normals(coat_facets_, wo, 1, [&](dvec3 h) {
                          return dvec3(coat_fresnel(dot(wo, h)) * reflected_fraction(coat_facets_, wo, h));
                      }).x;
    coat_transmittance_ = 1 - p_.coat * fractions_.rc;

    // Estimates of the base's roughness and reflectance. Where it transmits, no diffuse base lies below it.
    const double specular_fraction = max_channel(dielectric_fresnel(wo_.z));
    const double below = std::lerp(1.0, p_.roughness, p_.transmission);
    const double roughness =
        std::lerp(std::lerp(below, p_.roughness, specular_fraction), p_.roughness, p_.metalness);
    const double diffuse =
        (1 - max_channel(dielectric_f0_)) * (1 - p_.transmission) * (1 - p_.diffuse_transmission);
    const dvec3 albedo = mix(dielectric_f0_ + diffuse * p_.base_color, metal_f0_, p_.metalness);
    darkening_ =
        mix(dvec3(1), coat_darkening(p_.coat_ior, cosine, albedo, roughness), p_.coat * p_.coat_darkening);
}

// F_d, with Fresnel's own curve between normal incidence and the edge; KHR_materials_specular.
dvec3 PrincipledReference::dielectric_fresnel(double cosine) const {
    return p_.specular * (f0_ + (dvec3(1) - f0_) * fresnel_edge(cosine, eta_));
}

dvec3 PrincipledReference::film_or_dielectric_fresnel(double cosine) const {
    return mix(dielectric_fresnel(cosine), film_dielectric_, film_);
}

// That of the share of the surface that transmits: where no light gets through, it reflects all of it.
dvec3 PrincipledReference::transmitting_fresnel(double cosine) const {
    const bool total = !p_.thin && refracted_cosine_squared(cosine, eta_) <= 0;
    return total ? dvec3(1) : film_or_dielectric_fresnel(cosine);
}

// What layers below do without: the greatest channel of the dielectric's and of the film's reflectance, each
// for itself.
double PrincipledReference::greatest_fresnel(double cosine) const {
    return std::lerp(max_channel(dielectric_fresnel(cosine)), max_channel(film_dielectric_), film_);
}

double PrincipledReference::greatest_transmitting_fresnel(double cosine) const {
    const bool total = !p_.thin && refracted_cosine_squared(cosine, eta_) <= 0;
    return total ? 1 : greatest_fresnel(cosine);
}

// What all kinds of specular reflection together multiply facets' reflection by.
dvec3 PrincipledReference::specular_fresnel(double cosine) const {
    const dvec3 schlick = p_.base_color + (dvec3(1) - p_.base_color) * std::pow(1 - cosine, 5);
    const dvec3 opaque = p_.inside ? dvec3(0) : film_or_dielectric_fresnel(cosine);
    const dvec3 dielectric = mix(opaque, transmitting_fresnel(cosine), p_.transmission);
    return mix(dielectric, mix(schlick, film_metal_, film_), p_.metalness);
}

// The same for specular transmission; KHR_materials_transmission.
dvec3 PrincipledReference::transmittance(double cosine) const {
    return (1 - p_.metalness) * p_.transmission * (1 - greatest_transmitting_fresnel(cosine)) * p_.base_color;
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
    if (!channels_.empty()) return by_channel([&](size_t k) { return channels_[k].lobes(wi); });
    PrincipledLobes l;
    if (wi.z == 0) return l;
    if (wi.z > 0) {
        if (has_fuzz_) l.fuzz = p_.fuzz * fuzz_f(fuzz_roughness_, wo_, wi) * p_.fuzz_color;
        l.coat = dvec3(fuzz_transmittance_ * coat_value(wi));
        if (has_sheen_)
            l.sheen = fuzz_transmittance_ * coat_transmittance_ * darkening_ * p_.sheen_color * sheen_scale_ *
                      sheen_f(alpha_g_, wo_, wi);
        l.reflection = under_layers() * darkening_ * reflection_value(wi);
        l.diffuse_reflection = under_layers() * darkening_ * diffuse_ * (1 - p_.diffuse_transmission) *
                               eon_f(p_.base_color, p_.diffuse_roughness, wo_, wi);
        l.multiscatter_up = under_layers() * darkening_ / PI_D * multiscatter_up_;
    } else {
        l.transmission = under_layers() * transmission_value(wi);
        // Radiance is divided by eta^2 for every kind of transmission.
        const double through = under_layers() / (PI_D * square(p_.thin ? 1 : eta_));
        l.diffuse_transmission = through * diffuse_ * p_.diffuse_transmission * p_.diffuse_transmission_color;
        l.multiscatter_down = through * multiscatter_down_;
    }
    return l;
}

PrincipledLobes PrincipledReference::ideal() const {
    if (!channels_.empty()) return by_channel([&](size_t k) { return channels_[k].ideal(); });
    PrincipledLobes l;
    if (has_coat_ && coat_ideal_ && reflect(wo_, p_.coat_normal).z > 0)
        l.coat = dvec3(fuzz_transmittance_ * p_.coat * coat_fresnel(dot(wo_, p_.coat_normal)));
    if (!ideal_) return l;
    l.reflection = under_layers() * darkening_ * specular_fresnel(wo_.z);
    l.transmission = under_layers() * transmittance(wo_.z);
    return l;
}

PrincipledLobes PrincipledReference::albedos() const {
    if (!channels_.empty()) return by_channel([&](size_t k) { return channels_[k].albedos(); });
    PrincipledLobes l = ideal();
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
        if (p_.transmission > 0 && !p_.thin)
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
    if (has_fuzz_) l.fuzz = integrate_over_cosine(wo_, [&](dvec3 wi) { return lobes(wi).fuzz; });
    if (has_sheen_) l.sheen = integrate_over_cosine(wo_, [&](dvec3 wi) { return lobes(wi).sheen; });
    l.diffuse_reflection = integrate_over_cosine(wo_, [&](dvec3 wi) { return lobes(wi).diffuse_reflection; });
    // The others are Lambert's.
    const dvec3 above(0, 0, 1), below(0, 0, -1);
    l.multiscatter_up = PI_D * lobes(above).multiscatter_up;
    const double energy = PI_D * square(p_.thin ? 1 : eta_);
    l.multiscatter_down = energy * lobes(below).multiscatter_down;
    l.diffuse_transmission = energy * lobes(below).diffuse_transmission;
    return l;
}

}  // namespace candela
