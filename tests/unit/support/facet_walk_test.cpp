// Light that a metal's facets scatter more than once, compared with random walks among the facets of a
// surface of random heights. Ref: Heitz et al. 2016, "Multiple-Scattering Microfacet BSDFs with the Smith
// Model", sections 3 and 4: heights are uniform here, which changes nothing for the light that leaves.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "support/principled_reference.h"

namespace candela {
namespace {

// The normal of a facet that a ray along -w meets, w on any side.
// Ref: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
dvec3 met_normal(const Facets& facets, dvec3 w, double u, double v) {
    const dvec3 alpha(facets.alpha_x, facets.alpha_y, 1);
    const dvec3 stretched = normalize(alpha * w);
    const double z = (1 - u) * (1 + stretched.z) - stretched.z;
    const double radius = std::sqrt(std::max(1 - z * z, 0.0)), phi = 2 * std::numbers::pi * v;
    const dvec3 h = stretched + dvec3(radius * std::cos(phi), radius * std::sin(phi), z);
    return normalize(dvec3(alpha.x * h.x, alpha.y * h.y, std::max(h.z, 0.0)));
}

// Share of an even sky that leaves the surface after one reflection, and after more, with a standard error.
struct Walks {
    double once = 0, multiscatter = 0, error = 0;
};

// Walks from views of cosine-weighted directions. Each reflection leaves f_0 + (1 - f_0) S of the light, S
// being Schlick's power. Heights [0, 1] are uniform: a share h of the surface lies below h.
Walks walk(double alpha, double f_0, size_t count) {
    const Facets facets{alpha, alpha};
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit;
    double once = 0, multiscatter = 0, squares = 0;
    for (size_t i = 0; i < count; ++i) {
        const double cosine = std::sqrt(1 - unit(random));
        dvec3 d(std::sqrt(1 - cosine * cosine), 0, -cosine);
        double height = 1, light = 1;
        for (int reflections = 0;; ++reflections) {
            const double lambda = d.z > 0 ? smith_lambda(facets, d) : -1 - smith_lambda(facets, -d);
            const double u = 1 - unit(random);
            if (d.z > 0 && u <= std::pow(height, lambda)) {
                (reflections == 1 ? once : multiscatter) += light;
                if (reflections > 1) squares += light * light;
                break;
            }
            height = std::min(height * std::pow(u, -1 / lambda), 1.0);
            const dvec3 h = met_normal(facets, -d, unit(random), unit(random));
            const double cos_h = std::clamp(-dot(d, h), 0.0, 1.0);
            light *= f_0 + (1 - f_0) * std::pow(1 - cos_h, 5);
            d = normalize(d + 2 * cos_h * h);
        }
    }
    const auto n = double(count);
    return {once / n, multiscatter / n, std::sqrt(squares) / n};
}

constexpr size_t WALKS = 500000;

// All light comes back from facets that reflect all, and the share that comes back at once is the albedo.
TEST(PrincipledReferenceWalk, LosesNothingOfItsOwn) {
    const Walks walks = walk(1.0, 1.0, WALKS);
    EXPECT_NEAR(walks.once + walks.multiscatter, 1.0, 1e-9);
    double albedo = 0;
    constexpr int STEPS = 64;
    for (int i = 0; i < STEPS; ++i) {
        const double cosine = std::sqrt((i + 0.5) / STEPS);
        albedo += ggx_albedo(1, 1, dvec3(std::sqrt(1 - cosine * cosine), 0, cosine)) / STEPS;
    }
    EXPECT_NEAR(walks.once, albedo, 4 * std::sqrt(0.25 / double(WALKS)) + 1e-3);
}

// The fit promises 0.001 of the albedo; the rest is the noise of the walks.
TEST(PrincipledReferenceWalk, MetalGivesBackWhatWalksBringBack) {
    for (const double alpha : {0.09, 0.36, 0.7, 1.0}) {
        const Walks white = walk(alpha, 1.0, WALKS);
        for (const double f_0 : {0.1, 0.5, 0.9}) {
            const Walks metal = walk(alpha, f_0, WALKS);
            const double promised = (1 - white.once) * ggx_multiscatter(alpha, dvec3(f_0), dvec3(1 - f_0)).x;
            EXPECT_NEAR(promised, metal.multiscatter, 0.001 + 4 * (metal.error + white.error))
                << alpha << ' ' << f_0;
            EXPECT_LT(metal.error + white.error, 0.002);
        }
    }
}

TEST(PrincipledReferenceWalk, TheReferenceCountsThatLight) {
    const PrincipledReference metal({.base_color = dvec3(0.5), .metalness = 1, .roughness = 0.6},
                                    normalize(dvec3(1, 0, 0.5)));
    const double multiscatter =
        ggx_multiscatter(0.36, dvec3(0.5), dvec3(0.5)).x * metal.fractions().metal_lost;
    EXPECT_NEAR(metal.albedos().multiscatter_up.x, multiscatter, 1e-9);
}

}  // namespace
}  // namespace candela
