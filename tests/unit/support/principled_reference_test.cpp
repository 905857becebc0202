// The reference of the principled material is consistent in itself: what loses no light reflects all of it,
// quadratures meet closed forms, single lobes are reciprocal.
#include "support/principled_reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "support/layer_reference.h"
#include "support/quadrature.h"

namespace candela {
namespace {

// Quadratures meet 2e-5; an albedo is a sum of a few of them.
constexpr double QUADRATURE_ERROR = 2e-4;

dvec3 view(double cosine, double azimuth = 0.7) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
}

dvec3 random_above(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.02, 1.0);
    return view(unit(random), 6.28 * unit(random));
}

void expect_all(dvec3 albedo, double expected, double tolerance, const std::string& what) {
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(albedo[k], expected, tolerance) << what;
}

// The material at all roughnesses and angles.
template <class Check>
void for_views(PrincipledParameters material, const Check& check) {
    for (const double roughness : {0.0, 0.04, 0.15, 0.5, 1.0}) {
        for (const double cosine : {0.01, 0.1, 0.5, 1.0}) {
            material.roughness = roughness;
            check(PrincipledReference(material, view(cosine)),
                  "roughness " + std::to_string(roughness) + ", cosine " + std::to_string(cosine));
        }
    }
}

void expect_lossless(const PrincipledParameters& material) {
    for_views(material, [](const PrincipledReference& reference, const std::string& what) {
        expect_all(reference.albedo(), 1, QUADRATURE_ERROR, what);
    });
}

void expect_lossless_from_both_sides(PrincipledParameters volume) {
    expect_lossless(volume);
    volume.inside = true;
    expect_lossless(volume);
}

// Where a film colours reflection, transmitted light and the base are left what the greatest channel does not
// reflect.
void expect_greatest_channel_lossless(const PrincipledParameters& material) {
    for_views(material, [](const PrincipledReference& reference, const std::string& what) {
        const dvec3 albedo = reference.albedo();
        EXPECT_NEAR(std::max({albedo.x, albedo.y, albedo.z}), 1, QUADRATURE_ERROR) << what;
    });
}

TEST(PrincipledReference, WhiteMetalReflectsAllLight) {
    expect_lossless({.base_color = dvec3(1), .metalness = 1});
    expect_lossless({.base_color = dvec3(1), .metalness = 1, .anisotropy = 0.6});
}

// A dielectric that reflects everything over a base that absorbs it.
TEST(PrincipledReference, WhiteReflectorOfInfiniteIndexReflectsAllLight) {
    expect_lossless({.base_color = dvec3(0), .ior = 0});
    expect_lossless({.base_color = dvec3(0), .ior = 0, .anisotropy = 0.6});
}

TEST(PrincipledReference, ClearGlassLosesNoLightFromEitherSide) {
    expect_lossless_from_both_sides({.base_color = dvec3(1), .transmission = 1, .thin = false});
    expect_lossless_from_both_sides(
        {.base_color = dvec3(1), .ior = 2.4, .anisotropy = 0.6, .transmission = 1, .thin = false});
}

TEST(PrincipledReference, GlassLosesNoLightWhereItsReflectionIsScaled) {
    expect_lossless_from_both_sides({.base_color = dvec3(1),
                                     .specular = 0.4,
                                     .specular_color = dvec3(0.7),
                                     .transmission = 1,
                                     .thin = false});
}

TEST(PrincipledReference, DispersiveGlassLosesNoLight) {
    for (const bool inside : {false, true}) {
        const PrincipledParameters glass{.base_color = dvec3(1),
                                         .roughness = 0.6,
                                         .transmission = 1,
                                         .thin = false,
                                         .inside = inside,
                                         .dispersion = 4};
        const PrincipledReference reference(glass, view(0.3));
        expect_all(reference.albedo(), 1, QUADRATURE_ERROR, inside ? "inside" : "outside");
        EXPECT_NE(reference.albedos().reflection.x, reference.albedos().reflection.z);
    }
}

// Where indices are equal, facets refract all light straight on.
TEST(PrincipledReference, VolumeOfTheAirsIndexIsNotThere) {
    for (const double ior : {1.0, 1.0009}) {
        for_views({.base_color = dvec3(1), .ior = ior, .transmission = 1, .thin = false},
                  [](const PrincipledReference& reference, const std::string& what) {
                      EXPECT_TRUE(reference.is_ideal()) << what;
                      expect_all(reference.ideal().sum(), 1, 1e-12, what);
                      expect_all(reference.albedo(), 1, 1e-12, what);
                  });
    }
    EXPECT_FALSE(PrincipledReference({.ior = 1, .transmission = 1, .thin = true}, view(0.5)).is_ideal());
    EXPECT_FALSE(PrincipledReference({.ior = 1, .transmission = 0, .thin = false}, view(0.5)).is_ideal());
}

TEST(PrincipledReference, ThinGlassLosesNoLight) {
    expect_lossless({.base_color = dvec3(1), .transmission = 1, .thin = true});
    expect_lossless({.base_color = dvec3(1), .specular = 0.8, .anisotropy = 0.6, .transmission = 1});
}

// A white diffuse base takes what reflection leaves, as long as all channels reflect alike.
TEST(PrincipledReference, WhiteDiffuseBaseTakesWhatReflectionLeaves) {
    expect_lossless({.base_color = dvec3(1), .diffuse_roughness = 0.8, .diffuse_transmission = 0.3});
    expect_lossless({.base_color = dvec3(1), .ior = 3, .specular = 0.7, .anisotropy = 0.5});
}

TEST(PrincipledReference, FilmsLeaveWhatTheyDoNotReflect) {
    for (const double iridescence : {0.3, 1.0}) {
        expect_greatest_channel_lossless(
            {.base_color = dvec3(1), .transmission = 1, .thin = false, .iridescence = iridescence});
        expect_greatest_channel_lossless(
            {.base_color = dvec3(1), .transmission = 0.4, .thin = true, .iridescence = iridescence});
    }
}

TEST(PrincipledReference, WhiteLayersLoseNoLight) {
    const PrincipledParameters layered{.base_color = dvec3(1),
                                       .metalness = 0.2,
                                       .diffuse_roughness = 0.5,
                                       .specular = 0.9,
                                       .anisotropy = 0.3,
                                       .transmission = 0.4,
                                       .diffuse_transmission = 0.3,
                                       .coat = 0.8,
                                       .coat_roughness = 0.7,
                                       .sheen_color = dvec3(0.8),
                                       .sheen_roughness = 0.4,
                                       .fuzz = 0.7};
    PrincipledParameters volume = layered;
    volume.thin = false;
    expect_lossless(layered);
    expect_lossless_from_both_sides(volume);
}

// Any material; weights are often 0 or 1.
PrincipledParameters random_parameters(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const auto sometimes = [&](double value) { return unit(random) < 0.5 ? value : 0.0; };
    const auto often_one = [&] { return std::min(1.0, 1.5 * unit(random)); };
    const auto color = [&] { return dvec3(often_one(), often_one(), often_one()); };
    PrincipledParameters p;
    p.base_color = color();
    p.metalness = sometimes(often_one());
    p.roughness = unit(random);
    p.diffuse_roughness = sometimes(unit(random));
    p.ior = unit(random) < 0.1 ? 0 : 1 + 2 * unit(random) * unit(random);
    p.specular = often_one();
    p.specular_color = color();
    p.anisotropy = sometimes(unit(random));
    p.transmission = sometimes(often_one());
    p.thin = unit(random) < 0.3;
    p.inside = !p.thin && p.ior > 0 && unit(random) < 0.5;
    p.dispersion = unit(random) < 0.2 ? unit(random) : 0;
    p.diffuse_transmission = sometimes(often_one());
    p.diffuse_transmission_color = color();
    p.coat = sometimes(often_one());
    p.coat_roughness = sometimes(unit(random));
    p.coat_ior = 1 + unit(random);
    p.coat_darkening = sometimes(unit(random));
    p.coat_normal = unit(random) < 0.3 ? view(0.8 + 0.2 * unit(random)) : dvec3(0, 0, 1);
    p.sheen_color = unit(random) < 0.3 ? color() : dvec3(0);
    p.sheen_roughness = unit(random);
    p.fuzz = unit(random) < 0.3 ? often_one() : 0;
    p.fuzz_color = color();
    p.fuzz_roughness = unit(random);
    p.iridescence = sometimes(often_one());
    p.iridescence_ior = 1 + unit(random);
    p.iridescence_thickness = 800 * unit(random);
    return p;
}

TEST(PrincipledReference, NoMaterialGainsLight) {
    constexpr int MATERIALS = 100;
    std::mt19937 random(5);
    for (int i = 0; i < MATERIALS; ++i) {
        const PrincipledParameters material = random_parameters(random);
        const PrincipledLobes l =
            PrincipledReference(material, view(0.01 + 0.99 * i / MATERIALS, 6.28 * i / 7)).albedos();
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(l.sum()[k], 1.0005) << "material " << i;
            for (const dvec3 lobe :
                 {l.fuzz, l.coat, l.sheen, l.reflection, l.transmission, l.diffuse_reflection,
                  l.diffuse_transmission, l.multiscatter_up, l.multiscatter_down})
                EXPECT_GE(lobe[k], 0) << "material " << i;
        }
    }
}

// A smooth coat over white: what it does not reflect, the base does, and nothing is lost to darkening, since
// nothing is absorbed.
TEST(PrincipledReference, SmoothCoatOverWhiteMetalLosesNoLight) {
    expect_lossless({.base_color = dvec3(1), .metalness = 1, .coat = 1, .coat_darkening = 1});
}

TEST(PrincipledReference, CoatLosesAndDarkensWhatTheFormulaOfOpenPbrSays) {
    const PrincipledParameters grey{
        .base_color = dvec3(0.5), .roughness = 1, .specular = 0, .coat = 1, .coat_darkening = 1};
    const double f = fresnel_exact(0.6, 1.5), k = 1 - (1 - fresnel_average(1.5)) / 2.25;
    const PrincipledReference reference(grey, view(0.6));
    expect_all(reference.albedo(), f + (1 - f) * 0.5 * (1 - k) / (1 - 0.5 * k), 1e-6, "grey under a coat");
}

// Walsh's closed form. Ref: Duntley 1942, "The optical properties of diffusing materials", eq. 33.
TEST(PrincipledReference, AverageOfFresnelIsWalshs) {
    for (const double n : {1.2, 1.5, 2.4}) {
        const double n2 = n * n, n4 = n2 * n2;
        const double walsh = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
                             n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
                             2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
                             8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
        EXPECT_NEAR(fresnel_average(n), walsh, 1e-8);
        EXPECT_NEAR(1 - (1 - fresnel_average(n)) / n2, fresnel_average(1 / n), 1e-8);
    }
}

// At normal incidence and alpha = 1, D = 1/pi and the integral of G2 is elementary: 1 - ln 2.
TEST(PrincipledReference, AlbedoOfTheRoughestFacetsHasAClosedForm) {
    EXPECT_NEAR(ggx_albedo(1, 1, dvec3(0, 0, 1)), 1 - std::log(2.0), 2e-5);
}

// Diffuse light that goes through the surface of a volume is as much from either side, but spread over eta^2
// times the projected solid angle inside.
TEST(PrincipledReference, GlassSendsOnAsMuchLostLightFromEitherSide) {
    PrincipledParameters glass{.base_color = dvec3(1), .roughness = 0.6, .transmission = 1, .thin = false};
    const auto fraction_down = [&](bool inside) {
        glass.inside = inside;
        const PrincipledReference reference(glass, view(0.4));
        return reference.albedos().multiscatter_down.x / reference.fractions().glass_lost;
    };
    EXPECT_NEAR(fraction_down(false), 0.96 * 20 / 21, 1e-12);
    EXPECT_NEAR(fraction_down(true) * 1.5 * 1.5, fraction_down(false), 1e-12);
}

// Facets tilt by alpha, and their tails by more: what is lost goes down as alpha itself.
TEST(PrincipledReference, SmoothFacetsHaveFresnelsAlbedos) {
    for (const double cosine : {0.3, 0.6, 1.0}) {
        const PrincipledReference glass(
            {.base_color = dvec3(1), .roughness = 0.032, .transmission = 1, .thin = false}, view(cosine));
        EXPECT_FALSE(glass.is_ideal());
        EXPECT_NEAR(glass.fractions().metal_lost, 0, 1e-4);
        EXPECT_NEAR(glass.fractions().glass_lost, 0, 1e-4);
        EXPECT_NEAR(glass.albedos().reflection.x, fresnel_exact(cosine, 1.5), 1e-3);
    }
    EXPECT_NEAR(fresnel_exact(1, 1.5), 0.04, 1e-12);
    EXPECT_NEAR(fresnel_exact(std::cos(std::atan(1.5)), 1.5), 0.5 * std::pow((1.25 / 3.25), 2), 1e-12);
    EXPECT_EQ(fresnel_exact(0.5, 1 / 1.5), 1);
}

TEST(PrincipledReference, ReflectionIsReciprocal) {
    std::mt19937 random(1);
    const PrincipledParameters metal{
        .base_color = dvec3(0.9, 0.6, 0.2), .metalness = 1, .roughness = 0.5, .anisotropy = 0.7};
    for (int i = 0; i < 8; ++i) {
        const dvec3 wo = random_above(random), wi = random_above(random);
        const PrincipledReference there(metal, wo), back(metal, wi);
        const dvec3 a = there.reflection(wi), b = back.reflection(wo);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(a[k], b[k], 1e-10 * a[k]);
    }
}

TEST(PrincipledReference, SheenAndDiffuseReflectionAreReciprocal) {
    std::mt19937 random(2);
    for (int i = 0; i < 200; ++i) {
        const dvec3 wo = random_above(random), wi = random_above(random);
        const double sheen = sheen_f(0.1, wo, wi);
        EXPECT_NEAR(sheen, sheen_f(0.1, wi, wo), 1e-12 * sheen);
        EXPECT_NEAR(eon_f(dvec3(0.5), 0.7, wo, wi).x, eon_f(dvec3(0.5), 0.7, wi, wo).x, 1e-14);
    }
}

// For radiance, eta^2 f is the value that light on its way back meets, from the other side of the surface: z
// is turned about.
TEST(PrincipledReference, TransmissionIsReciprocalForEnergy) {
    std::mt19937 random(3);
    PrincipledParameters outside{.base_color = dvec3(1), .roughness = 0.7, .transmission = 1, .thin = false};
    PrincipledParameters inside = outside;
    inside.inside = true;
    int lit = 0;
    for (int i = 0; i < 8; ++i) {
        // Near to where light goes straight on.
        const dvec3 wo = random_above(random);
        const dvec3 below = normalize(dvec3(-wo.x, -wo.y, wo.z) + 0.6 * random_above(random));
        const PrincipledReference there(outside, wo), back(inside, below);
        const dvec3 wi(below.x, below.y, -below.z), seen_from_below(wo.x, wo.y, -wo.z);
        const double a = there.transmission(wi).x * 1.5 * 1.5;
        const double b = back.transmission(seen_from_below).x;
        EXPECT_NEAR(a, b, 1e-9 * a);
        lit += a > 0 ? 1 : 0;
    }
    EXPECT_GE(lit, 4);
}

TEST(PrincipledReference, ThinWallsTransmitTheMirroredReflection) {
    const PrincipledReference wall(
        {.base_color = dvec3(1), .roughness = 0.4, .specular = 0, .transmission = 1, .thin = true},
        view(0.5));
    const PrincipledReference mirror({.base_color = dvec3(1), .metalness = 1, .roughness = 0.4}, view(0.5));
    std::mt19937 random(4);
    for (int i = 0; i < 20; ++i) {
        const dvec3 wi = random_above(random);
        const double expected = mirror.reflection(wi).x;
        EXPECT_NEAR(wall.transmission(dvec3(wi.x, wi.y, -wi.z)).x, expected, 1e-12 * expected);
        EXPECT_EQ(wall.reflection(wi), dvec3(0));
    }
}

TEST(PrincipledReference, DiffuseReflectionWithoutRoughnessIsLamberts) {
    const dvec3 color(0.8, 0.3, 0.1);
    EXPECT_EQ(eon_f(color, 0, view(0.3), view(0.9, 3)), color / std::numbers::pi);
}

TEST(PrincipledReference, RoughDiffuseReflectionOfWhiteLosesNoLight) {
    for (const double sigma : {0.2, 1.0}) {
        for (const double cosine : {0.05, 0.5, 0.95}) {
            const dvec3 wo = view(cosine);
            expect_all(integrate_over_cosine(wo, [&](dvec3 wi) { return eon_f(dvec3(1), sigma, wo, wi); }), 1,
                       1e-6, "sigma " + std::to_string(sigma));
        }
    }
}

// At normal incidence: at others, the extension's outer interface reflects by Schlick's curve, for any
// index. The amplitude of interference is at least sqrt(1e-5), its sensitivity at most 1.5.
TEST(PrincipledReference, FilmOfAirIsNoneAtNormalIncidence) {
    const dvec3 f0(0.04, 0.5, 0.9);
    for (const double thickness : {0.0, 150.0, 400.0}) {
        const dvec3 film = iridescent_fresnel(1, f0, thickness, 1);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(film[k], f0[k], 2 * 1.5 * 2 * std::sqrt(1e-5) + 1e-4);
    }
}

// A very thick film does not interfere: both reflections and all orders between them add up.
TEST(PrincipledReference, ThickFilmAddsReflectionsUp) {
    const double r12 = std::pow(0.3 / 2.3, 2), base_ior = (1 + std::sqrt(0.2501)) / (1 - std::sqrt(0.2501));
    const double r23 = std::pow((base_ior - 1.3) / (base_ior + 1.3), 2);
    const double sum = r12 + (1 - r12) * (1 - r12) * r23 / (1 - r12 * r23);
    expect_all(iridescent_fresnel(1.3, dvec3(0.25), 1e6, 1), sum, 1e-12, "1 mm");
}

// From a roughness of 0.25 on: below it, the model reflects more than all light at grazing angles, up to
// three times as much.
TEST(PrincipledReference, SheenReflectsAtMostAllLight) {
    for (const double roughness : {0.25, 0.5, 1.0}) {
        for (const double cosine : {0.001, 0.03, 0.3, 1.0}) {
            const double albedo = sheen_albedo(roughness * roughness, cosine);
            EXPECT_GE(albedo, 0);
            EXPECT_LE(albedo, 1) << roughness << " " << cosine;
        }
    }
}

// So the sheen as a layer is scaled, and the base below it never negative.
TEST(PrincipledReference, SmoothSheenHidesTheBaseAtGrazingAngles) {
    const PrincipledReference cloth({.base_color = dvec3(1), .metalness = 1, .sheen_color = dvec3(1)},
                                    view(0.03));
    EXPECT_GT(cloth.fractions().es, 1);
    expect_all(cloth.albedos().sheen, 1, QUADRATURE_ERROR, "sheen");
    expect_all(cloth.albedo(), 1, QUADRATURE_ERROR, "all");
}

// Its matrix keeps the horizon, so that the density of a hemisphere stays one.
TEST(PrincipledReference, FuzzReflectsWhatItsFitSays) {
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
        for (const double cosine : {0.01, 0.1, 0.5, 1.0}) {
            const dvec3 wo = view(cosine);
            const double albedo =
                integrate_over_cosine(wo, [&](dvec3 wi) { return dvec3(fuzz_f(roughness, wo, wi)); }).x;
            EXPECT_NEAR(albedo, fuzz_albedo(roughness, cosine), QUADRATURE_ERROR)
                << roughness << " " << cosine;
        }
    }
}

TEST(PrincipledReference, FuzzIsBrightestAtGrazingAnglesAndBackwards) {
    for (const double roughness : {0.1, 0.5, 1.0})
        EXPECT_GT(fuzz_albedo(roughness, 0.05), fuzz_albedo(roughness, 0.5));
    const dvec3 wo = view(0.3);
    EXPECT_GT(fuzz_f(0.5, wo, wo), fuzz_f(0.5, wo, dvec3(-wo.x, -wo.y, wo.z)));
    // At a roughness of 1, the end of the fits, all azimuths are alike.
    for (const double azimuth : {0.0, 1.0, 3.0})
        EXPECT_NEAR(fuzz_f(1, wo, view(0.4, azimuth)), fuzz_f(1, wo, view(0.4, 2)), 1e-12);
}

TEST(PrincipledReference, FuzzTakesFromLayersBelowWhateverItsColour) {
    const PrincipledReference cloth({.base_color = dvec3(0.5),
                                     .metalness = 1,
                                     .roughness = 0,
                                     .fuzz = 0.5,
                                     .fuzz_color = dvec3(1, 0.25, 0),
                                     .fuzz_roughness = 0.4},
                                    view(0.2));
    const double reflected = 0.5 * fuzz_albedo(0.4, 0.2), below = 0.5 + 0.5 * std::pow(0.8, 5);
    const dvec3 expected = reflected * dvec3(1, 0.25, 0) + (1 - reflected) * below;
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(cloth.albedo()[k], expected[k], QUADRATURE_ERROR);
    EXPECT_NEAR(cloth.emission_factor(), 1 - reflected, 1e-12);
}

TEST(PrincipledReference, DispersionSpreadsTheIndicesAboutGreens) {
    const dvec3 ior = dispersed_ior(1.5, 2);
    EXPECT_NEAR(ior.x, 1.475, 1e-12);
    EXPECT_NEAR(ior.y, 1.5, 1e-12);
    EXPECT_NEAR(ior.z, 1.525, 1e-12);
    EXPECT_EQ(dispersed_ior(1.5, 100).x, 1.001);
    EXPECT_EQ(dispersed_ior(1.0005, 100).x, 1.0005);
}

}  // namespace
}  // namespace candela
