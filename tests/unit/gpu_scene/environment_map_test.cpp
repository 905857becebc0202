// Environment -> texels, their density and the table that chooses them, against solid angles in closed form.
#include "gpu_scene/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include <gtest/gtest.h>

#include "probe/random.h"
#include "unit/gpu_scene/cdf_words.h"

namespace candela {
namespace {

// Solid angle of a texel in that row [sr]: 2 pi / width (cos(theta_0) - cos(theta_1)).
double solid_angle(uvec2 size, uint32_t row) {
    const long double step = std::numbers::pi_v<long double> / size.y;
    return double(2.0L * std::numbers::pi_v<long double> / size.x *
                  (std::cos(row * step) - std::cos((row + 1) * step)));
}

double luminance_of(vec3 rgb) {
    return 0.2126 * double(rgb.x) + 0.7152 * double(rgb.y) + 0.0722 * double(rgb.z);
}

Environment random_environment(uvec2 size, uint32_t seed) {
    Random random(seed);
    Environment environment{.size = size, .radiance = {}};
    for (uint32_t i = 0; i < size.x * size.y; ++i) {
        const vec3 colour = vec3(1.0f) + random.cube();
        environment.radiance.push_back(std::pow(1000.0f, random.unit()) * colour);
    }
    environment.radiance[size.x * size.y / 2] = vec3(0.0f);
    return environment;
}

// Every other texel is bright, the rest black. Luminance in floats is off by some 2^-23.
TEST(EnvironmentMap, TexelsFillTheSphere) {
    for (const uvec2 size : {uvec2(1, 7), uvec2(16, 1), uvec2(3, 5), uvec2(512, 256)}) {
        std::vector<vec3> radiance(size_t(size.x) * size.y, vec3(0.0f));
        double bright = 0.0;  // [sr]
        for (uint32_t i = 0; i < radiance.size(); i += 2) {
            radiance[i] = vec3(1.0f);
            bright += solid_angle(size, i / size.x);
        }
        const EnvironmentMap map = build_environment_map({.size = size, .radiance = radiance});
        const double mean = bright / (4.0 * std::numbers::pi);
        EXPECT_NEAR(map.irradiance, (1.0 - mean) * bright, 4.0 * std::numbers::pi * 0x1p-22);
        for (size_t i = 0; i < map.texels.size(); ++i) {
            // Both the row and the column are chosen by whole numbers of 2^32 words.
            const double angle = solid_angle(size, uint32_t(i) / size.x);
            const double row = angle * size.x / (4.0 * std::numbers::pi), column = 1.0 / size.x;
            ASSERT_NEAR(map.texels[i].pdf, i % 2 == 0 ? 1.0 / bright : 0.0,
                        0x1p-22 + 0x1p-31 * (row + column) / angle);
        }
    }
}

// What light samples look for in each texel [W/m^2].
std::vector<double> light_above_the_mean(const Environment& environment) {
    std::vector<double> angles;
    double mean = 0.0;
    for (size_t i = 0; i < environment.radiance.size(); ++i) {
        angles.push_back(solid_angle(environment.size, uint32_t(i) / environment.size.x));
        mean += luminance_of(environment.radiance[i]) * angles[i] / (4.0 * std::numbers::pi);
    }
    std::vector<double> light;
    for (size_t i = 0; i < angles.size(); ++i)
        light.push_back(std::max(luminance_of(environment.radiance[i]) - mean, 0.0) * angles[i]);
    return light;
}

// Luminances are floats, good to some 2^-23 each.
TEST(EnvironmentMap, TheDensityIsProportionalToLuminanceAboveTheMeanAndIntegratesToOne) {
    const uvec2 size(31, 17);
    const Environment environment = random_environment(size, 1);
    const EnvironmentMap map = build_environment_map(environment);
    ASSERT_EQ(map.texels.size(), environment.radiance.size());
    const std::vector<double> light = light_above_the_mean(environment);
    const double irradiance = std::accumulate(light.begin(), light.end(), 0.0);
    EXPECT_NEAR(map.irradiance, irradiance, irradiance * 0x1p-21);
    double integral = 0.0;
    for (size_t i = 0; i < map.texels.size(); ++i) {
        const double angle = solid_angle(size, uint32_t(i) / size.x);
        integral += double(map.texels[i].pdf) * angle;
        EXPECT_EQ(map.texels[i].radiance, environment.radiance[i]);
        // Luminance and mean are both rounded, the choice to words of a row and of a column.
        const double rounding = luminance_of(environment.radiance[i]) / irradiance * 0x1p-21;
        ASSERT_NEAR(map.texels[i].pdf, light[i] / (irradiance * angle), rounding + 0x1p-31 / angle);
    }
    EXPECT_NEAR(integral, 1.0, 0x1p-22);
}

// A share is a product of two that are rounded to 2^-32; luminances are good to 2^-23 of themselves, and so
// is the mean that is taken off. The density is that of the choice to the last bit of a float.
TEST(EnvironmentMap, TheTablesChooseTexelsByTheirPartOfTheLight) {
    const uvec2 size(31, 17);
    const Environment environment = random_environment(size, 2);
    const EnvironmentMap map = build_environment_map(environment);
    const std::vector<double> light = light_above_the_mean(environment);
    ASSERT_EQ(map.cdf.size(), map.texels.size() + size.y);
    const std::span table(map.cdf);
    const std::vector<uint64_t> rows = words_of(table.subspan(map.texels.size()));
    for (uint32_t y = 0; y < size.y; ++y) {
        const std::vector<uint64_t> columns = words_of(table.subspan(size_t(y) * size.x, size.x));
        for (uint32_t x = 0; x < size.x; ++x) {
            const size_t i = size_t(y) * size.x + x;
            const double chosen = double(rows[y]) * 0x1p-32 * double(columns[x]) * 0x1p-32;
            const double angle = solid_angle(size, y);
            const double rounding = luminance_of(environment.radiance[i]) * angle / map.irradiance * 0x1p-21;
            ASSERT_NEAR(chosen, light[i] / map.irradiance, 0x1p-31 + rounding) << i;
            ASSERT_NEAR(double(map.texels[i].pdf) * solid_angle(size, y), chosen, chosen * 0x1p-23) << i;
        }
    }
}

// Half of the sphere at 3, half at 1, and so half of it 1 above the mean, in the direction of 45 degrees.
TEST(EnvironmentMap, WhatIsBelowTheMeanIsLeftToBsdfSamples) {
    const double pi = std::numbers::pi;
    const EnvironmentMap map = build_environment_map({.size = {1, 2}, .radiance = {vec3(3.0f), vec3(1.0f)}});
    EXPECT_NEAR(map.irradiance, 2.0 * pi, 0x1p-19);
    EXPECT_NEAR(map.texels[0].pdf, 1.0 / (2.0 * pi), 0x1p-22);
    EXPECT_EQ(map.texels[1].pdf, 0.0f);
    EXPECT_NEAR(map.flux.y, pi * std::sqrt(0.5), 0x1p-19);
    EXPECT_NEAR(map.flux.w, 0.5 * pi, 0x1p-19);
}

TEST(EnvironmentMap, AnEvenSkyIsNotSampled) {
    for (const float radiance : {0.0f, 0.1f}) {
        const EnvironmentMap map =
            build_environment_map({.size = {4, 2}, .radiance = std::vector<vec3>(8, vec3(radiance))});
        EXPECT_TRUE(map.even);
        EXPECT_EQ(map.irradiance, 0.0);
        EXPECT_TRUE(map.cdf.empty());
        ASSERT_EQ(map.texels.size(), 8u);
        for (const EnvironmentTexel& texel : map.texels)
            EXPECT_EQ(texel.pdf, 0.0f);
    }
}

}  // namespace
}  // namespace candela
