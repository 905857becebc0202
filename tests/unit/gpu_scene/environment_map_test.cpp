// Environment -> texels, their density and the table that chooses them, against solid angles in closed form.
#include "gpu_scene/environment_map.h"

#include <cmath>
#include <numbers>
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

// A radiance of 1 everywhere, at any resolution: the texels fill the sphere. Luminance in floats is off by
// some 2^-23.
TEST(EnvironmentMap, TexelsFillTheSphere) {
    for (const uvec2 size : {uvec2(1, 1), uvec2(1, 7), uvec2(16, 1), uvec2(3, 5), uvec2(512, 256)}) {
        const std::vector<vec3> ones(size_t(size.x) * size.y, vec3(1.0f));
        const EnvironmentMap map = build_environment_map({.size = size, .radiance = ones});
        EXPECT_NEAR(map.irradiance, 4.0 * std::numbers::pi, 4.0 * std::numbers::pi * 0x1p-22);
        for (size_t i = 0; i < map.texels.size(); ++i) {
            // Both the row and the column are chosen by whole numbers of 2^32 words.
            const double angle = solid_angle(size, uint32_t(i) / size.x);
            const double row = angle * size.x / (4.0 * std::numbers::pi), column = 1.0 / size.x;
            ASSERT_NEAR(map.texels[i].pdf, 1.0 / (4.0 * std::numbers::pi),
                        0x1p-24 + 0x1p-32 * (row + column) / angle);
        }
    }
}

// Luminances are floats, good to some 2^-23 each.
TEST(EnvironmentMap, TheDensityIsProportionalToLuminanceAndIntegratesToOne) {
    const uvec2 size(31, 17);
    const Environment environment = random_environment(size, 1);
    const EnvironmentMap map = build_environment_map(environment);
    ASSERT_EQ(map.texels.size(), environment.radiance.size());
    double irradiance = 0.0, integral = 0.0;
    for (size_t i = 0; i < map.texels.size(); ++i) {
        const double angle = solid_angle(size, uint32_t(i) / size.x);
        irradiance += luminance_of(environment.radiance[i]) * angle;
        integral += double(map.texels[i].pdf) * angle;
    }
    EXPECT_NEAR(map.irradiance, irradiance, irradiance * 0x1p-22);
    EXPECT_NEAR(integral, 1.0, 0x1p-22);
    for (size_t i = 0; i < map.texels.size(); ++i) {
        const double pdf = luminance_of(environment.radiance[i]) / irradiance;
        EXPECT_EQ(map.texels[i].radiance, environment.radiance[i]);
        const double words = 0x1p-31 / solid_angle(size, uint32_t(i) / size.x);  // Of a row and of a column.
        ASSERT_NEAR(map.texels[i].pdf, pdf, pdf * 0x1p-21 + words);
    }
}

// A share is a product of two that are rounded to 2^-32; luminances are good to 2^-23 of themselves. The
// density is that of the choice to the last bit of a float.
TEST(EnvironmentMap, TheTablesChooseTexelsByTheirPartOfTheLight) {
    const uvec2 size(31, 17);
    const Environment environment = random_environment(size, 2);
    const EnvironmentMap map = build_environment_map(environment);
    ASSERT_EQ(map.cdf.size(), map.texels.size() + size.y);
    const std::span table(map.cdf);
    const std::vector<uint64_t> rows = words_of(table.subspan(map.texels.size()));
    for (uint32_t y = 0; y < size.y; ++y) {
        const std::vector<uint64_t> columns = words_of(table.subspan(size_t(y) * size.x, size.x));
        for (uint32_t x = 0; x < size.x; ++x) {
            const size_t i = size_t(y) * size.x + x;
            const double chosen = double(rows[y]) * 0x1p-32 * double(columns[x]) * 0x1p-32;
            const double part = luminance_of(environment.radiance[i]) * solid_angle(size, y) / map.irradiance;
            ASSERT_NEAR(chosen, part, 0x1p-31 + part * 0x1p-22) << i;
            ASSERT_NEAR(double(map.texels[i].pdf) * solid_angle(size, y), chosen, chosen * 0x1p-23) << i;
        }
    }
}

// Half of the sphere at 3, half at 1: (9 + 1) / 2 over 2 squared.
TEST(EnvironmentMap, ContrastIsTheMeanSquareOverTheSquaredMean) {
    const EnvironmentMap map = build_environment_map({.size = {1, 2}, .radiance = {vec3(3.0f), vec3(1.0f)}});
    EXPECT_NEAR(map.contrast, 1.25, 0x1p-20);
}

TEST(EnvironmentMap, ABlackSkyIsNotSampled) {
    const EnvironmentMap map =
        build_environment_map({.size = {4, 2}, .radiance = std::vector<vec3>(8, vec3(0.0f))});
    EXPECT_EQ(map.irradiance, 0.0);
    EXPECT_TRUE(map.cdf.empty());
    ASSERT_EQ(map.texels.size(), 8u);
    for (const EnvironmentTexel& texel : map.texels)
        EXPECT_EQ(texel.pdf, 0.0f);
}

}  // namespace
}  // namespace candela
