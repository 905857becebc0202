// Environment -> texels, their density and the table that chooses them, against solid angles in closed form.
#include "gpu_scene/environment_map.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "probe/random.h"

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
        for (const EnvironmentTexel& texel : map.texels)
            ASSERT_NEAR(texel.pdf, 1.0 / (4.0 * std::numbers::pi), 0x1p-24);
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
        ASSERT_NEAR(map.texels[i].pdf, pdf, pdf * 0x1p-21);
    }
}

// A threshold is rounded to 2^-32 of a column; luminances to 2^-23 of themselves.
TEST(EnvironmentMap, TheTableChoosesTexelsByTheirShareOfTheLight) {
    const uvec2 size(31, 17);
    const EnvironmentMap map = build_environment_map(random_environment(size, 2));
    ASSERT_EQ(map.alias.size(), map.texels.size());
    std::vector<double> chosen(map.alias.size());
    for (size_t i = 0; i < chosen.size(); ++i) {
        const double kept = double(map.alias[i].threshold) * 0x1p-32;
        chosen[i] += kept / double(chosen.size());
        chosen[map.alias[i].alias] += (1.0 - kept) / double(chosen.size());
    }
    for (size_t i = 0; i < chosen.size(); ++i) {
        const double share = double(map.texels[i].pdf) * solid_angle(size, uint32_t(i) / size.x);
        ASSERT_NEAR(chosen[i], share, 0x1p-32 + share * 0x1p-22) << i;
    }
}

TEST(EnvironmentMap, ABlackSkyIsNotSampled) {
    const EnvironmentMap map =
        build_environment_map({.size = {4, 2}, .radiance = std::vector<vec3>(8, vec3(0.0f))});
    EXPECT_EQ(map.irradiance, 0.0);
    EXPECT_TRUE(map.alias.empty());
    ASSERT_EQ(map.texels.size(), 8u);
    for (const EnvironmentTexel& texel : map.texels)
        EXPECT_EQ(texel.pdf, 0.0f);
}

}  // namespace
}  // namespace candela
