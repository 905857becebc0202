// Sunlight in air: columns against integrals over height, thin air against closed forms.
#include "scene/atmosphere.h"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/scene/slant_column.h"

namespace candela {
namespace {

constexpr int K = WAVELENGTHS / 2;  // Any wavelength.

dvec3 at_elevation(double degrees, double azimuth = 0.0) {
    const double e = glm::radians(degrees), a = glm::radians(azimuth);
    return {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
}

Air thin_air(dvec3 depth) {
    Air air;
    air.fill(depth);
    return air;
}

TEST(Atmosphere, WhatPassesIsTheExponentialOfTheColumn) {
    for (const double turbidity : {1.0, 2.0, 10.0}) {
        const Air air = clear_air(turbidity);
        const Atmosphere atmosphere(air, 0.3);
        for (const double elevation : {90.0, 30.0, 5.0, 1.0}) {
            const Spectrum passing = atmosphere.transmittance(at_elevation(elevation));
            const dvec3 columns = slant_column(elevation);
            for (int k = 0; k < WAVELENGTHS; ++k) {
                const double depth = dot(air[k], columns);
                // The midpoint rule is off by about (step / scale height)^2 / 24, here 1e-3 for aerosol.
                EXPECT_NEAR(-std::log(passing[k]), depth, 1e-3 * depth) << elevation << ' ' << k;
            }
        }
        EXPECT_EQ(atmosphere.transmittance(at_elevation(-1.0))[K], 0.0);
    }
}

// Of 550 nm, published for molecules, 1013 hPa: 0.0971 (Bodhaine et al., 1999); turbidity 3 has twice as much
// aerosol.
TEST(Atmosphere, HasTheEarthsOpticalDepth) {
    const Air air = clear_air(3.0);
    for (int k = 0; k + 1 < WAVELENGTHS; ++k) {
        if (wavelength(k) > 550.0 || wavelength(k + 1) <= 550.0) continue;
        const double share = (550.0 - wavelength(k)) / (wavelength(k + 1) - wavelength(k));
        const dvec3 depth = glm::mix(air[k], air[k + 1], share);
        EXPECT_NEAR(depth.x, 0.0971, 0.002);  // The chord is 1.5 % above the curve.
        EXPECT_NEAR(depth.y, 2.0 * 0.0971, 0.003);
    }
    EXPECT_EQ(clear_air(1.0)[K].y, 0.0);
}

TEST(Atmosphere, WithoutAirTheSkyIsBlack) {
    const Atmosphere atmosphere(Air{}, 0.5);
    for (const double elevation : {80.0, 1.0, -20.0}) {
        const ScatteredLight light = atmosphere.scattered(at_elevation(elevation), at_elevation(30.0));
        EXPECT_EQ(light.molecules, Spectrum{});
        EXPECT_EQ(light.aerosol, Spectrum{});
        EXPECT_EQ(light.multiple, Spectrum{});
        EXPECT_EQ(light.passing[K], 1.0);
        EXPECT_EQ(light.meets_ground, elevation < 0.0);
    }
    EXPECT_EQ(atmosphere.transmittance(at_elevation(1.0))[K], 1.0);
}

// Thin air scatters its optical depth along the view, times the share of light that is not absorbed.
// Forty-eight parts of a ray: the midpoint rule is off by up to 0.1 % for molecules and 0.6 % for aerosol.
TEST(Atmosphere, ThinAirScattersItsOpticalDepthOnce) {
    constexpr double DEPTH = 1e-6;
    const Atmosphere atmosphere(thin_air({DEPTH, DEPTH, 0.0}), 0.0);
    for (const double elevation : {90.0, 30.0, 5.0}) {
        const ScatteredLight light = atmosphere.scattered(at_elevation(elevation, 70.0), at_elevation(40.0));
        const dvec3 column = slant_column(elevation);
        EXPECT_NEAR(light.molecules[K] / (DEPTH * column.x), 1.0, 1e-3);
        EXPECT_NEAR(light.aerosol[K] / (0.9 * DEPTH * column.y), 1.0, 6e-3);
        EXPECT_LT(light.multiple[K], 100.0 * DEPTH * light.molecules[K]);
    }
}

// Above a ground that reflects all light, with radiance sin(40) / pi, thin air is lit from below: at a height
// h, the ground fills (1 - sin(dip)) / 2 of all directions. Twelve bands of directions decide on the horizon,
// so that the share is off by up to a twenty-fourth, of about a half.
TEST(Atmosphere, ThinAirIsLitByTheGround) {
    constexpr double DEPTH = 1e-6, HEIGHT = 8.0, STEPS = 1000;
    const Atmosphere atmosphere(thin_air({DEPTH, 0.0, 0.0}), 1.0);
    double expected = 0.0;
    for (int i = 0; i < STEPS; ++i) {
        const double h = EYE + (100.0 - EYE) * (i + 0.5) / STEPS, cos_dip = EARTH / (EARTH + h);
        const double share = 0.5 * (1.0 - std::sqrt(1.0 - cos_dip * cos_dip));
        expected += DEPTH * std::exp(-h / HEIGHT) / HEIGHT * share * (100.0 - EYE) / STEPS;
    }
    expected *= std::sin(glm::radians(40.0)) / M_PI;
    const ScatteredLight light = atmosphere.scattered(at_elevation(90.0), at_elevation(40.0));
    EXPECT_NEAR(light.multiple[K] / expected, 1.0, 1.0 / 12.0);
}

TEST(Atmosphere, PhaseFunctionsHaveUnitIntegrals) {
    double molecules = 0.0, aerosol = 0.0;
    constexpr int N = 10000;
    for (int i = 0; i < N; ++i) {
        const double cosine = -1.0 + 2.0 * (i + 0.5) / N;
        molecules += 4.0 * M_PI / N * molecule_phase(cosine);
        aerosol += 4.0 * M_PI / N * aerosol_phase(cosine);
    }
    EXPECT_NEAR(molecules, 1.0, 1e-5);
    EXPECT_NEAR(aerosol, 1.0, 1e-5);
}

// Ref: the colour of the sun outside the atmosphere by ASTM G173, integrated with the CIE's functions of
// 1931: within 1 %, of which half is the black body's.
TEST(Atmosphere, TheSunIsAlmostWhite) {
    Spectrum sun;
    sun.fill(1.0);
    const dvec3 rgb = rgb_of(sun) / M_PI;
    EXPECT_NEAR(rgb.x, 1.096, 0.01);
    EXPECT_NEAR(rgb.y, 0.978, 0.01);
    EXPECT_NEAR(rgb.z, 0.940, 0.01);
    EXPECT_NEAR(dot(rgb, dvec3(0.2126, 0.7152, 0.0722)), 1.0, 1e-4);
}

}  // namespace
}  // namespace candela
