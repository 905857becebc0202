// Tone curves: properties that their publications promise, values computed separately in double precision,
// and the results for inputs that are not colours.
#include "image/tonemap.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "unit/base/base_fixture.h"

namespace candela {
namespace {

constexpr std::array<Tonemap, 5> CURVES = {Tonemap::linear, Tonemap::reinhard, Tonemap::aces, Tonemap::agx,
                                           Tonemap::neutral};
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

void expect_near(vec3 actual, vec3 expected, float tolerance = 2e-5f) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(actual[i], expected[i], tolerance) << "component " << i;
}

TEST(Tonemap, EveryCodeOfSrgbSurvivesDecodingAndEncoding) {
    for (int code = 0; code < 256; ++code) {
        const double v = code / 255.0;
        const double light = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        const uint8_t expected = uint8_t(code);
        EXPECT_EQ(encode_srgb8(vec3(float(light))), (std::array<uint8_t, 3>{expected, expected, expected}));
    }
}

TEST(Tonemap, EncodingRoundsToTheNearestCode) {
    const float step = 1.0f / (255.0f * 12.92f);  // Step of the linear part of the transfer function.
    EXPECT_EQ(encode_srgb8({1.49f * step, 1.51f * step, 9.49f * step}), (std::array<uint8_t, 3>{1, 2, 9}));
    EXPECT_EQ(encode_srgb8({0.18f, 0.5f, 1.0f}), (std::array<uint8_t, 3>{118, 188, 255}));
}

TEST(Tonemap, LinearOnlyClamps) {
    EXPECT_EQ(tonemap(Tonemap::linear, {-0.5f, 0.3f, 1.5f}), vec3(0.0f, 0.3f, 1.0f));
}

TEST(Tonemap, ReinhardCompressesLuminanceAndKeepsHue) {
    expect_near(tonemap(Tonemap::reinhard, vec3(1.0f)), vec3(0.5f));
    expect_near(tonemap(Tonemap::reinhard, vec3(0.18f)), vec3(0.152542f));
    expect_near(tonemap(Tonemap::reinhard, {0.05f, 0.3f, 0.9f}), {0.038755f, 0.232527f, 0.697582f});
}

TEST(Tonemap, AcesHasTheValuesOfHillsFit) {
    expect_near(tonemap(Tonemap::aces, vec3(0.18f)), vec3(0.105591f));
    expect_near(tonemap(Tonemap::aces, vec3(1.0f)), {0.619115f, 0.619115f, 0.619109f});
    expect_near(tonemap(Tonemap::aces, {2.0f, 0.5f, 0.1f}), {0.901499f, 0.418689f, 0.105001f});
    expect_near(tonemap(Tonemap::aces, {0.05f, 0.3f, 0.9f}), {0.020446f, 0.212623f, 0.567259f});
}

TEST(Tonemap, AgxShowsMiddleGreyAsHalfTheCodeRange) {
    const vec3 grey = tonemap(Tonemap::agx, vec3(0.18f));
    // The published error of the polynomial is 1.9e-3 (root mean square) against AgX' own table.
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(std::pow(grey[i], 1.0f / 2.2f), 0.5f, 0.005f);
}

TEST(Tonemap, AgxHasTheValuesOfThePublishedPolynomial) {
    expect_near(tonemap(Tonemap::agx, vec3(1.0f)), {0.589977f, 0.590207f, 0.590221f});
    expect_near(tonemap(Tonemap::agx, {2.0f, 0.5f, 0.1f}), {0.807289f, 0.449624f, 0.210690f});
    expect_near(tonemap(Tonemap::agx, {0.05f, 0.3f, 0.9f}), {0.134223f, 0.328989f, 0.591839f});
    EXPECT_EQ(tonemap(Tonemap::agx, vec3(0.0f)), vec3(0.0f));
}

TEST(Tonemap, NeutralKeepsBaseColoursLessTheFresnelReflection) {
    for (const vec3 colour : {vec3(0.08f, 0.3f, 0.8f), vec3(0.5f), vec3(0.79f, 0.1f, 0.2f)}) {
        expect_near(tonemap(Tonemap::neutral, colour), colour - 0.04f, 1e-6f);
    }
}

TEST(Tonemap, NeutralHasTheValuesOfItsSpecification) {
    expect_near(tonemap(Tonemap::neutral, vec3(1.0f)), vec3(0.869091f));
    expect_near(tonemap(Tonemap::neutral, {2.0f, 0.5f, 0.1f}), {0.96f, 0.321136f, 0.150772f});
    expect_near(tonemap(Tonemap::neutral, {0.05f, 0.3f, 0.9f}), {0.018985f, 0.258503f, 0.833345f});
}

TEST(Tonemap, EveryCurveRisesFromBlackToWhite) {
    for (const Tonemap curve : CURVES) {
        EXPECT_EQ(tonemap(curve, vec3(0.0f)), vec3(0.0f));
        float previous = 0.0f;
        for (float x = 1e-4f; x < 1e30f; x *= 1.5f) {
            const vec3 light = tonemap(curve, vec3(x));
            EXPECT_GE(light.y, previous - 1e-6f) << int(curve) << " at " << x;
            EXPECT_TRUE(light.y >= 0.0f && light.y <= 1.0f) << int(curve) << " at " << x;
            previous = light.y;
        }
        EXPECT_EQ(encode_srgb8(tonemap(curve, vec3(1e30f))), (std::array<uint8_t, 3>{255, 255, 255}));
    }
}

TEST(Tonemap, NamesWhatBecomesOfInputsThatAreNoColours) {
    for (const Tonemap curve : CURVES) {
        EXPECT_EQ(tonemap(curve, {1.0f, NOT_A_NUMBER, 1.0f}), vec3(0.0f));
        EXPECT_EQ(tonemap(curve, {INFINITE, NOT_A_NUMBER, 1.0f}), vec3(0.0f));
        EXPECT_EQ(tonemap(curve, {0.1f, 0.1f, INFINITE}), vec3(1.0f));
        EXPECT_EQ(tonemap(curve, {-INFINITE, 0.2f, 0.3f}), tonemap(curve, {0.0f, 0.2f, 0.3f}));
        EXPECT_EQ(tonemap(curve, {0.2f, -7.0f, 0.3f}), tonemap(curve, {0.2f, 0.0f, 0.3f}));
    }
}

}  // namespace
}  // namespace candela
