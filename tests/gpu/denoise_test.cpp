// Denoising by variance on the device: against double precision, and what must hold for every picture.
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "denoise/blend.h"
#include "denoise/smooth_albedo.h"
#include "denoise/variance.h"
#include "gpu/denoise_reference.h"
#include "gpu/device_fixture.h"

namespace candela {
namespace {

constexpr float U = 0x1p-24f;  // The relative error of rounding to a float.
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

using Planes = std::array<std::vector<float>, 3>;

// A picture that owns its planes.
struct Owned {
    uvec2 size;
    Planes rgb, variance, albedo, normal;
    std::vector<float> alpha, albedo_variance;

    explicit Owned(uvec2 s) : size(s) {
        for (Planes* planes : {&rgb, &variance, &albedo, &normal}) {
            for (std::vector<float>& plane : *planes)
                plane.assign(size_t(s.x) * s.y, planes == &albedo ? 1.0f : 0.0f);
        }
        std::ranges::fill(normal[2], 1.0f);
    }
    size_t pixels() const { return rgb[0].size(); }
    NoisyPicture picture() const {
        const auto view = [](const Planes& planes) { return RgbPlanes{planes[0], planes[1], planes[2]}; };
        return {size, view(rgb), view(variance), view(albedo), view(normal), alpha, {}, albedo_variance};
    }
};

// Noise of that relative deviation on a picture of that truth, with its true variance.
Owned noisy_picture(uvec2 size, float deviation, const std::function<vec3(uint32_t, uint32_t)>& truth,
                    uint32_t seed = 1) {
    Owned picture(size);
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    for (uint32_t i = 0; i < picture.pixels(); ++i) {
        const vec3 value = truth(i % size.x, i / size.x);
        for (size_t c = 0; c < 3; ++c) {
            const float sigma = deviation * value[int(c)];
            picture.rgb[c][i] = value[int(c)] + sigma * normal(random);
            picture.variance[c][i] = sigma * sigma;
        }
    }
    return picture;
}

// One of everything: surfaces of two directions and several albedos, an edge that no feature shows, noise,
// alpha, and pixels without value or variance.
Owned varied_picture(uvec2 size) {
    Owned picture = noisy_picture(size, 0.3f, [](uint32_t x, uint32_t y) {
        return vec3(1.0f, 0.7f, 0.2f) * ((x / 11 + y / 9) % 2 == 0 ? 1.0f : 0.4f);
    });
    picture.alpha = picture.rgb[1];
    for (uint32_t i = 0; i < picture.pixels(); ++i) {
        const uint32_t x = i % size.x, y = i / size.x;
        for (size_t c = 0; c < 3; ++c)
            picture.albedo[c][i] = 0.1f * float(1 + (x / 7 + c) % 9);
        if (x + y > 60) {
            picture.normal[0][i] = 0.6f;
            picture.normal[2][i] = 0.7f;
        }
    }
    for (size_t i = 17; i < picture.pixels(); i += 1013) {
        picture.rgb[i % 3][i] = i % 2 ? NOT_A_NUMBER : INFINITE;
        picture.variance[i % 2][i - 5] = i % 2 ? INFINITE : NOT_A_NUMBER;
    }
    return picture;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return std::ranges::equal(
        a, b, {}, [](float x) { return std::bit_cast<uint32_t>(x); },
        [](float x) { return std::bit_cast<uint32_t>(x); });
}

// The mean over pixels and channels of the squared error.
double squared_error(const Planes& rgb, const std::function<vec3(uint32_t, uint32_t)>& truth, uvec2 size) {
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        for (uint32_t i = 0; i < rgb[c].size(); ++i)
            sum += std::pow(double(rgb[c][i]) - truth(i % size.x, i / size.x)[int(c)], 2.0);
    }
    return sum / double(3 * rgb[0].size());
}

class DenoiseTest : public DeviceTest {
  protected:
    Denoised denoise(const NoisyPicture& picture, uint32_t tile = DENOISE_TILE) const {
        Denoised result = filter_by_variance(device(), picture, tile);
        blend_with(picture, result);
        return result;
    }
    Denoised denoise(const Owned& picture, uint32_t tile = DENOISE_TILE) const {
        return denoise(picture.picture(), tile);
    }
    Denoised filter(const NoisyPicture& picture) const { return filter_by_variance(device(), picture); }
};

TEST_F(DenoiseTest, TheBitsDoNotDependOnTheTiles) {
    const Owned picture = varied_picture({131, 90});
    const Denoised whole = denoise(picture);
    for (const uint32_t tile : {64u, 29u}) {
        const Denoised tiled = denoise(picture, tile);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_TRUE(same_bits(tiled.rgb[c], whole.rgb[c])) << tile << ' ' << c;
        EXPECT_TRUE(same_bits(tiled.alpha, whole.alpha)) << tile;
    }
}

// A pass rounds each value and variance by at most 64 units: weights of distance d are off by (3 + 10 d) of
// them, times exp(-d), and sums of 25 terms by 25. What becomes of that in later passes, whose weights depend
// on it, the reference shows by itself with random errors of that size; the worst of all pixels, and twice
// that, is allowed.
TEST_F(DenoiseTest, AgreesWithDoublePrecision) {
    const uvec2 size(48, 40);
    Owned picture = noisy_picture(size, 0.3f, [](uint32_t x, uint32_t y) {
        return vec3(1.0f, 0.7f, 1.3f) * (x < 20 ? 1.0f : 0.4f) * (1.0f + 0.02f * float(y));
    });
    ReferencePicture reference{int(size.x), int(size.y), {}, {}};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> bend(-0.15f, 0.15f);
    for (uint32_t i = 0; i < picture.pixels(); ++i) {
        // Means of normals that differ from sample to sample, around two directions.
        const vec3 mean = i / size.x > 25 ? vec3(0.0f, 0.5f, 0.5f) : vec3(0.0f, 0.0f, 0.8f);
        for (size_t c = 0; c < 3; ++c)
            picture.normal[c][i] = mean[int(c)] + bend(random);
        if (i % 97 == 5) picture.rgb[1][i] = NOT_A_NUMBER;
        ReferencePixel pixel;
        dvec4 normal(0.0);
        for (size_t c = 0; c < 3; ++c) {
            pixel.value[int(c)] = picture.rgb[c][i];
            pixel.variance[int(c)] = picture.variance[c][i];
            normal[int(c)] = picture.normal[c][i];
        }
        normal.w = (1.0 - dot(dvec3(normal), dvec3(normal))) / 16.0;
        pixel.is_there = std::isfinite(picture.rgb[1][i]);
        if (!pixel.is_there) pixel = {dvec3(0.0), dvec3(0.0), 0.0, false};
        reference.pixels.push_back(pixel);
        reference.normals.push_back(normal);
    }
    const std::vector<ReferencePixel> expected = filtered_by_reference(reference, [](double x) { return x; });
    std::uniform_real_distribution<double> error(-64.0 * U, 64.0 * U);
    const std::vector<ReferencePixel> rounded =
        filtered_by_reference(reference, [&](double x) { return x * (1.0 + error(random)); });
    double allowed = 0.0, largest = 0.0;
    const Denoised result = filter(picture.picture());
    for (size_t i = 0; i < expected.size(); ++i) {
        ASSERT_TRUE(expected[i].is_there) << i;
        for (size_t c = 0; c < 3; ++c) {
            const double value = expected[i].value[int(c)];
            allowed = std::max(allowed, 2.0 * std::abs(rounded[i].value[int(c)] - value));
            largest = std::max(largest, std::abs(double(result.rgb[c][i]) - value));
        }
        EXPECT_NEAR(result.own_weight[i], expected[i].own_weight, 1e-3) << i;
    }
    EXPECT_LE(largest, allowed);
    EXPECT_LT(allowed, 1e-2);  // The test would notice an error in a weight.
}

// Each of the four passes that a value goes through is a weighted mean, with rounding of 26 sums, 25 products
// and a quotient; irradiance and back take four operations more.
TEST_F(DenoiseTest, AConstantPictureStaysConstant) {
    Owned picture(uvec2(40, 30));
    for (size_t c = 0; c < 3; ++c) {
        std::ranges::fill(picture.rgb[c], 0.7f);
        std::ranges::fill(picture.variance[c], 0.01f);
        std::ranges::fill(picture.albedo[c], 0.3f);
    }
    const Denoised result = denoise(picture);
    for (const float value : result.rgb[0])
        EXPECT_NEAR(value, 0.7f, 0.7f * (4 * 52 + 4) * U);
}

// A single pass with the weights of the spline alone would leave a share of (35/128)^2 = 0.075 of the
// variance, since the squares of 1, 4, 6, 4, 1 add up to 70 and 70/256 is 35/128. Further passes must do
// better than noise in the weights of the first does harm.
TEST_F(DenoiseTest, OfNoiseLittleRemains) {
    const auto truth = [](uint32_t, uint32_t) { return vec3(1.0f); };
    const Owned picture = noisy_picture({96, 96}, 0.25f, truth);
    const double noisy = squared_error(picture.rgb, truth, picture.size);
    EXPECT_LT(squared_error(filter(picture.picture()).rgb, truth, picture.size), 0.075 * noisy);
    EXPECT_LT(squared_error(denoise(picture).rgb, truth, picture.size), 0.15 * noisy);
}

// A checkerboard of albedos under light with noise: squares of one pixel keep their colours, as if there were
// none.
// A pixel in which one of 16 samples met the sun by chance: the pixels beside it take nothing of it, so that
// all stay within five deviations of the truth, as they would without it.
TEST_F(DenoiseTest, AnOutlierDoesNotSpread) {
    const uvec2 size(41, 41);
    Owned picture = noisy_picture(size, 0.1f, [](uint32_t, uint32_t) { return vec3(1.0f); });
    const size_t at = 20 * size.x + 20;
    for (size_t c = 0; c < 3; ++c) {
        picture.rgb[c][at] = 3000.0f;
        picture.variance[c][at] = 9e6f;
    }
    const Denoised result = denoise(picture);
    for (size_t i = 0; i < picture.pixels(); ++i) {
        if (i == at) continue;
        EXPECT_NEAR(result.rgb[0][i], 1.0f, 0.5f) << i % size.x << ' ' << i / size.x;
    }
}

TEST_F(DenoiseTest, AnEdgeThatOnlyTheAlbedoShowsRemains) {
    const auto albedo = [](uint32_t x, uint32_t y) { return vec3((x + y) % 2 == 0 ? 0.8f : 0.2f); };
    const uvec2 size(64, 64);
    Owned picture = noisy_picture(size, 0.25f, albedo);
    for (uint32_t i = 0; i < picture.pixels(); ++i) {
        for (size_t c = 0; c < 3; ++c)
            picture.albedo[c][i] = albedo(i % size.x, i / size.x)[int(c)];
    }
    EXPECT_LT(squared_error(filter(picture.picture()).rgb, albedo, size),
              0.15 * squared_error(picture.rgb, albedo, size));
}

// Perpendicular normals reduce weights to exp(-2 / 0.09) = 2e-10. So what lies beyond the edge changes
// nothing, not even where the noise hides the difference of light.
TEST_F(DenoiseTest, NothingCrossesAnEdgeThatNormalsShow) {
    const uvec2 size(64, 48);
    const auto one = [](uint32_t, uint32_t) { return vec3(1.0f); };
    Owned picture = noisy_picture(size, 0.4f, one);
    for (uint32_t i = 0; i < picture.pixels(); ++i) {
        if (i % size.x < 32) continue;
        picture.normal[0][i] = 1.0f;
        picture.normal[2][i] = 0.0f;
    }
    const Denoised before = filter(picture.picture());
    for (uint32_t i = 0; i < picture.pixels(); ++i) {
        if (i % size.x >= 32) picture.rgb[0][i] *= 0.9f;
    }
    const Denoised after = filter(picture.picture());
    // As far as the other side lets the first pass smooth the level that bounds variances.
    double moved = 0.0;
    for (uint32_t i = 0; i < picture.pixels(); ++i) {
        if (i % size.x < 31) moved = std::max(moved, std::abs(double(after.rgb[0][i]) - before.rgb[0][i]));
    }
    EXPECT_LT(moved, 1e-6);
}

TEST_F(DenoiseTest, WithoutNoiseNothingChanges) {
    Owned picture = varied_picture({50, 41});
    for (size_t c = 0; c < 3; ++c) {
        std::ranges::fill(picture.variance[c], 0.0f);
        for (float& value : picture.rgb[c])
            value = std::isfinite(value) ? value : 1.0f;
    }
    const Denoised result = denoise(picture);
    for (size_t c = 0; c < 3; ++c)
        EXPECT_TRUE(same_bits(result.rgb[c], picture.rgb[c]));
    EXPECT_TRUE(same_bits(result.alpha, picture.alpha));
}

// What has no value gets that of its surroundings, and gives them nothing.
TEST_F(DenoiseTest, MissingValuesAreFilled) {
    Owned picture(uvec2(30, 30));
    for (size_t c = 0; c < 3; ++c) {
        std::ranges::fill(picture.rgb[c], 2.0f);
        std::ranges::fill(picture.variance[c], 0.1f);
    }
    picture.rgb[0][100] = NOT_A_NUMBER;
    picture.rgb[1][101] = INFINITE;
    picture.rgb[2][102] = -INFINITE;
    picture.rgb[0][500] = 1e38f;
    picture.rgb[0][700] = NOT_A_NUMBER;
    picture.albedo[0][700] = picture.normal[0][700] = NOT_A_NUMBER;
    picture.variance[0][300] = NOT_A_NUMBER;
    picture.variance[0][301] = INFINITE;
    picture.variance[0][302] = -1.0f;
    picture.variance[0][303] = 1e38f;
    const Denoised result = filter(picture.picture());
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < picture.pixels(); ++i)
            EXPECT_NEAR(result.rgb[c][i], 2.0f, 1e-4f) << c << ' ' << i;
    }
    const Denoised blended = denoise(picture);
    for (const size_t i : {100, 101, 102, 500, 700})
        EXPECT_NEAR(blended.rgb[0][i], 2.0f, 1e-4f) << i;
}

TEST_F(DenoiseTest, WhereNothingHasAValueThePictureStaysAsItIs) {
    Owned picture(uvec2(12, 9));
    for (std::vector<float>& plane : picture.rgb)
        std::ranges::fill(plane, NOT_A_NUMBER);
    const Denoised result = denoise(picture);
    EXPECT_TRUE(same_bits(result.rgb[0], picture.rgb[0]));
}

// Of 1 x 1, 1 x N and N x 1 pixels; the single pixel can only stay as it is, but for the rounding of its
// irradiance.
TEST_F(DenoiseTest, ThePictureMayBeThin) {
    const auto truth = [](uint32_t, uint32_t) { return vec3(1.0f); };
    for (const uvec2 size : {uvec2(1, 1), uvec2(1, 150), uvec2(150, 1)}) {
        const Owned picture = noisy_picture(size, 0.25f, truth, 5);
        const Denoised result = denoise(picture, 64);
        ASSERT_EQ(result.rgb[0].size(), picture.pixels());
        if (picture.pixels() == 1) {
            EXPECT_NEAR(result.rgb[0][0], picture.rgb[0][0], 4.0f * U * picture.rgb[0][0]);
        } else {
            EXPECT_LT(squared_error(result.rgb, truth, size), 0.5 * squared_error(picture.rgb, truth, size));
        }
    }
}

// Without albedo, irradiance is colour: a coverage equal to a colour stays equal to it.
TEST_F(DenoiseTest, AlphaIsFilteredByTheWeightsOfTheColour) {
    Owned picture = varied_picture({70, 50});
    for (size_t c = 0; c < 3; ++c) {
        for (float& value : picture.rgb[c])
            value = std::isfinite(value) ? value : 0.0f;
    }
    picture.alpha = picture.rgb[1];
    NoisyPicture without = picture.picture();
    without.albedo.reset();
    // Its unit is 1: the median of the greatest channel lies between 1/sqrt(2) and sqrt(2).
    const Denoised result = denoise(without);
    EXPECT_TRUE(same_bits(result.alpha, result.rgb[1]));
}

TEST_F(DenoiseTest, TheUnitOfRadianceDoesNotMatter) {
    Owned picture = varied_picture({70, 50});
    const Denoised before = denoise(picture);
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < picture.pixels(); ++i) {
            picture.rgb[c][i] *= 0x1p-20f;
            picture.variance[c][i] *= 0x1p-40f;
        }
    }
    const Denoised after = denoise(picture);
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < picture.pixels(); ++i)
            ASSERT_EQ(after.rgb[c][i], before.rgb[c][i] * 0x1p-20f) << c << ' ' << i;
    }
}

// Noise of unknown variance is recognised by itself; there is no blend.
TEST_F(DenoiseTest, ColourAloneIsEnough) {
    const auto truth = [](uint32_t, uint32_t) { return vec3(1.0f); };
    const Owned picture = noisy_picture({64, 64}, 0.25f, truth);
    NoisyPicture alone = picture.picture();
    alone.variance.reset();
    alone.albedo.reset();
    alone.normal.reset();
    const Denoised result = denoise(alone);
    EXPECT_LT(squared_error(result.rgb, truth, picture.size),
              0.075 * squared_error(picture.rgb, truth, picture.size));
    EXPECT_TRUE(same_bits(result.rgb[0], filter(alone).rgb[0]));
}

// An albedo that differs from sample to sample would leave its noise in the picture.
TEST_F(DenoiseTest, WorksOnAlbedoWithoutItsNoise) {
    Owned picture = varied_picture({70, 50});
    std::mt19937 random(3);
    std::normal_distribution<float> normal(0.0f, 0.05f);
    for (std::vector<float>& plane : picture.albedo) {
        for (float& value : plane)
            value += normal(random);
    }
    picture.albedo_variance.assign(picture.pixels(), 3 * 0.05f * 0.05f);
    const Denoised result = filter_by_variance(device(), picture.picture(), 32);
    const std::vector<vec3> smooth = smooth_albedo(picture.picture(), {0, 0, 70, 50});
    for (size_t i = 0; i < smooth.size(); ++i) {
        for (size_t c = 0; c < 3; ++c)
            picture.albedo[c][i] = smooth[i][int(c)];
    }
    picture.albedo_variance.clear();
    const Denoised expected = filter_by_variance(device(), picture.picture(), 32);
    for (size_t c = 0; c < 3; ++c)
        EXPECT_TRUE(same_bits(result.rgb[c], expected.rgb[c]));
}

}  // namespace
}  // namespace candela
