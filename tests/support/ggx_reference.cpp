// See ggx_reference.h.
#include "support/ggx_reference.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/quadrature.h"

namespace candela {
namespace {

// Where a level changes its sign between two points.
double root_between(double lo, double hi, const std::function<double(double)>& level) {
    const bool positive = level(lo) > 0;
    for (int i = 0; i < 36; ++i) {
        const double middle = 0.5 * (lo + hi);
        ((level(middle) > 0) == positive ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

// The point between two at which a level is nearest to 0, where it has one extremum between them.
double nearest_to_zero(double lo, double hi, const std::function<double(double)>& level) {
    for (int i = 0; i < 30; ++i) {
        const double left = lo + (hi - lo) / 3, right = hi - (hi - lo) / 3;
        const bool is_left = std::abs(level(left)) < std::abs(level(right));
        (is_left ? hi : lo) = is_left ? right : left;
    }
    return 0.5 * (lo + hi);
}

// Where one of the levels, as a function of x in [a, b], changes its sign: with a and b, ascending.
std::vector<double> breaks_of(double a, double b, const std::function<dvec3(double)>& levels) {
    constexpr int STEPS = 24;
    std::vector<double> x, breaks{a, b};
    std::vector<dvec3> at;
    for (int step = 0; step <= STEPS; ++step) {
        // Steps are shorter towards b, where facets are steepest.
        x.push_back(b - (b - a) * square(1.0 - double(step) / STEPS));
        at.push_back(levels(x.back()));
    }
    for (int k = 0; k < 3; ++k) {
        const auto level = [&](double point) { return levels(point)[k]; };
        for (size_t i = 1; i < x.size(); ++i)
            if ((at[i - 1][k] > 0) != (at[i][k] > 0)) breaks.push_back(root_between(x[i - 1], x[i], level));
        // Two roots so near to each other that both samples beside them have the same sign.
        for (size_t i = 1; i + 1 < x.size(); ++i) {
            const double before = at[i - 1][k], here = at[i][k], after = at[i + 1][k];
            if ((before > 0) != (here > 0) || (here > 0) != (after > 0)) continue;
            if (std::abs(here) > std::abs(before) || std::abs(here) > std::abs(after)) continue;
            const double extremum = nearest_to_zero(x[i - 1], x[i + 1], level);
            if ((level(extremum) > 0) == (here > 0)) continue;
            breaks.push_back(root_between(x[i - 1], extremum, level));
            breaks.push_back(root_between(extremum, x[i + 1], level));
        }
    }
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

// The integral of g over [a, b], of which `whole` is an estimate: halves it until both halves agree with it.
dvec3 integrate_adaptively(double a, double b, dvec3 whole, double tolerance, int depth,
                           const std::function<dvec3(double, double)>& estimate) {
    const double middle = 0.5 * (a + b);
    const dvec3 left = estimate(a, middle), right = estimate(middle, b);
    const dvec3 error = abs(left + right - whole);
    if (depth == 0 || std::max({error.x, error.y, error.z}) < tolerance) return left + right;
    return integrate_adaptively(a, middle, left, 0.5 * tolerance, depth - 1, estimate) +
           integrate_adaptively(middle, b, right, 0.5 * tolerance, depth - 1, estimate);
}

}  // namespace

// Ref: Burley 2012, "Physically based shading at Disney", eq. 13; KHR_materials_anisotropy.
double facet_distribution(const Facets& facets, dvec3 h) {
    if (h.z <= 0) return 0;
    const double k = square(h.x / facets.alpha_x) + square(h.y / facets.alpha_y) + square(h.z);
    return 1 / (PI_D * facets.alpha_x * facets.alpha_y * k * k);
}

// Ref: Heitz 2014, eq. 72 and 80.
double smith_lambda(const Facets& facets, dvec3 w) {
    const double reach = std::sqrt(square(w.z) + square(facets.alpha_x * w.x) + square(facets.alpha_y * w.y));
    return 0.5 * (reach / std::abs(w.z) - 1);
}

double smith_g1(const Facets& facets, dvec3 w) {
    return 1 / (1 + smith_lambda(facets, w));
}

// Ref: Heitz 2018, "Sampling the GGX distribution of visible normals", eq. 1.
double visible_normals_pdf(const Facets& facets, dvec3 wo, dvec3 h) {
    return smith_g1(facets, wo) * std::max(0.0, dot(wo, h)) * facet_distribution(facets, h) / wo.z;
}

// Ref: Born and Wolf, Principles of Optics, section 1.5.
double fresnel_exact(double cosine, double eta) {
    const double squared = refracted_cosine_squared(cosine, eta);
    if (squared <= 0) return 1;
    const double behind = std::sqrt(squared);
    const double s = (cosine - eta * behind) / (cosine + eta * behind);
    const double p = (eta * cosine - behind) / (eta * cosine + behind);
    return 0.5 * (s * s + p * p);
}

double fresnel_normal(double eta) {
    return square((eta - 1) / (eta + 1));
}

double fresnel_edge(double cosine, double eta) {
    constexpr double GREATEST_ETA = 100;  // Beyond it, the unreflected light is negligible: Schlick's curve.
    if (eta > GREATEST_ETA) return std::pow(1 - cosine, 5);
    if (refracted_cosine_squared(cosine, eta) <= 0) return 1;
    const double f0 = fresnel_normal(eta);
    return std::clamp((fresnel_exact(cosine, eta) - f0) / (1 - f0), 0.0, 1.0);
}

double fresnel_average(double eta) {
    const double critical = eta < 1 ? std::sqrt(1 - eta * eta) : 0.0;
    double sum = 0;
    visit_pieces({0, critical, 1}, 48,
                 [&](double mu, double weight) { sum += 2 * fresnel_exact(mu, eta) * mu * weight; });
    return sum;
}

dvec3 reflect(dvec3 wo, dvec3 h) {
    return 2 * dot(wo, h) * h - wo;
}

double refracted_cosine_squared(double cosine, double eta) {
    return 1 - (1 - cosine * cosine) / (eta * eta);
}

dvec3 refract(dvec3 wo, dvec3 h, double eta) {
    const double cosine = dot(wo, h);
    const double behind = std::sqrt(std::max(0.0, refracted_cosine_squared(cosine, eta)));
    return (cosine / eta - behind) * h - wo / eta;
}

// Stretched by alpha, the facets are a hemisphere, and those that wo sees are projected evenly along wo: onto
// half a disk, of those that face the viewer beyond the horizon's plane, and half an ellipse below it.
// Ref: Heitz 2018, section 3.
dvec3 mean_over_visible_normals(const Facets& facets, dvec3 wo, double eta,
                                const std::function<dvec3(dvec3)>& g) {
    constexpr int ANGLES = 8, RADII = 14, MAX_DEPTH = 10;
    constexpr double TOLERANCE = 3e-6;
    const dvec3 v = normalize(dvec3(facets.alpha_x * wo.x, facets.alpha_y * wo.y, wo.z));
    const double side = std::hypot(v.x, v.y);
    const dvec3 t1 = side > 1e-12 ? dvec3(-v.y, v.x, 0) / side : dvec3(1, 0, 0);
    const dvec3 t2 = cross(v, t1);
    const auto levels = [&](dvec3 h) {
        return dvec3(reflect(wo, h).z, refracted_cosine_squared(dot(wo, h), eta), refract(wo, h, eta).z);
    };
    dvec3 sum(0);
    for (const double height : {1.0, -v.z}) {
        const auto along_radius = [&](double angle) {
            // The radius on the disk is sin(b), so that its rim costs no accuracy.
            const auto normal = [&](double b) {
                const double x = std::sin(b) * std::cos(angle), y = height * std::sin(b) * std::sin(angle);
                const dvec3 h = x * t1 + y * t2 + std::sqrt(std::max(0.0, 1 - x * x - y * y)) * v;
                return normalize(dvec3(facets.alpha_x * h.x, facets.alpha_y * h.y, std::max(h.z, 1e-12)));
            };
            dvec3 radius_sum(0);
            const std::vector<double> breaks =
                breaks_of(0, PI_D / 2, [&](double b) { return levels(normal(b)); });
            visit_pieces(breaks, RADII, [&](double b, double weight) {
                radius_sum += std::abs(height) * weight * std::sin(b) * std::cos(b) * g(normal(b));
            });
            return radius_sum;
        };
        const auto estimate = [&](double from, double to) {
            dvec3 angle_sum(0);
            visit_interval(from, to, ANGLES,
                           [&](double angle, double weight) { angle_sum += weight * along_radius(angle); });
            return angle_sum;
        };
        for (const double from : {0.0, PI_D / 2})
            sum += integrate_adaptively(from, from + PI_D / 2, estimate(from, from + PI_D / 2), TOLERANCE,
                                        MAX_DEPTH, estimate);
    }
    return sum * (2 / (PI_D * (1 + v.z)));
}

// Masking and shadowing of light reflected, over the masking of wo: Smith's, correlated by height. Ref: Heitz
// 2014, "Understanding the masking-shadowing function", eq. 99.
double reflected_fraction(const Facets& facets, dvec3 wo, dvec3 h) {
    const dvec3 wi = reflect(wo, h);
    if (wi.z <= 0) return 0;
    const double lambda = smith_lambda(facets, wo);
    return (1 + lambda) / (1 + lambda + smith_lambda(facets, wi));
}

// The same of light refracted: uncorrelated, G1(wo) G1(wi). Ref: Walter et al. 2007, eq. 23.
double refracted_fraction(const Facets& facets, dvec3 wo, dvec3 h, double eta) {
    if (refracted_cosine_squared(dot(wo, h), eta) < 0) return 0;
    const dvec3 wi = refract(wo, h, eta);
    return wi.z < 0 ? smith_g1(facets, wi) : 0;
}

double ggx_albedo(double alpha_x, double alpha_y, dvec3 wo) {
    const Facets facets{alpha_x, alpha_y};
    return mean_over_visible_normals(facets, wo, 1,
                                     [&](dvec3 h) { return dvec3(reflected_fraction(facets, wo, h)); })
        .x;
}

dvec3 ggx_multiscatter(double alpha, dvec3 f_0, dvec3 edge) {
    const double leaves = 1 - 0.397 * alpha;
    const dvec3 fresnel = f_0 + 0.0378 / (alpha + 0.0459) * edge;
    return fresnel * fresnel * leaves / (dvec3(1) - (1 - leaves) * fresnel);
}

}  // namespace candela
