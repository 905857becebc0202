// Environments: which image files give one, what is said about odd ones, and the sky that comes with the
// scenes.
#include "scene/environment.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "image/image_io.h"
#include "unit/base/base_fixture.h"
#include "unit/image/image_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

Image make_image(uint32_t width, uint32_t height, const std::vector<std::string>& channels) {
    Image image;
    image.full = {width, height};
    image.data = {0, 0, width, height};
    float value = 1.0f;
    for (const std::string& name : channels) {
        for (float& v : image.add(name).values)
            v = value++;
    }
    return image;
}

class EnvironmentFile : public testing::Test {
  protected:
    Environment load(const Image& image) {
        write_exr(path_, image);
        return load();
    }
    Environment load() {
        warnings_.clear();
        return load_environment(path_, FileReach(path_), warnings_);
    }
    // Warnings and errors begin with the file's name.
    std::string named(const std::string& text) const { return path_.string() + ": " + text; }

    TemporaryDirectory directory_;
    fs::path path_ = directory_ / "sky.exr";
    std::vector<std::string> warnings_;
};

TEST_F(EnvironmentFile, HoldsTheTexelsOfAnExrFileInTheirOrder) {
    const Environment environment = load(make_image(4, 2, {"R", "G", "B", "A"}));
    EXPECT_EQ(environment.size, uvec2(4, 2));
    ASSERT_EQ(environment.radiance.size(), 8u);
    for (size_t i = 0; i < 8; ++i)
        EXPECT_EQ(environment.radiance[i], vec3(float(1 + i), float(9 + i), float(17 + i))) << i;
    EXPECT_EQ(environment.rotation, 0.0f);
    EXPECT_TRUE(environment.visible);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(EnvironmentFile, TakesARadiancePicture) {
    path_ = directory_ / "sky.hdr";
    write_quickly(path_, hdr_header(2, 1) + rgbe(128, 64, 32, 129) + rgbe(0, 0, 255, 136));
    const Environment environment = load();
    EXPECT_EQ(environment.size, uvec2(2, 1));
    EXPECT_EQ(environment.radiance, (std::vector<vec3>{vec3(1, 0.5f, 0.25f), vec3(0, 0, 255)}));
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(EnvironmentFile, TakesGreyWhereThereIsNoColour) {
    EXPECT_EQ(load(make_image(2, 1, {"A", "Y"})).radiance, (std::vector<vec3>{vec3(3), vec3(4)}));
    EXPECT_EQ(load(make_image(2, 1, {"Y", "R", "G", "B"})).radiance[0], vec3(3, 5, 7))
        << "colour has precedence";
}

TEST_F(EnvironmentFile, NamesTheChannelsThatDoNotDo) {
    EXPECT_EQ(error_of([&] {
                  load(make_image(2, 1, {"R", "G", "left.B"}));
              }),
              named("an environment needs the channels R, G and B, or Y, but the file has G, R, left.B; "
                    "write it with one of these"));
}

TEST_F(EnvironmentFile, MustBeComplete) {
    Image image = make_image(4, 2, {"R", "G", "B"});
    image.full = {5, 2};
    EXPECT_EQ(error_of([&] { load(image); }),
              named("the environment must be complete, but the file holds only 4x2 of its picture's 5x2 "
                    "pixels; write all of it"));
    image.full = {4, 3};
    image.data = {0, 1, 4, 3};
    EXPECT_EQ(error_of([&] { load(image); }),
              named("the environment must be complete, but the file holds only 4x2 of its picture's 4x3 "
                    "pixels; write all of it"));
}

TEST_F(EnvironmentFile, UnusableTexelsAreBlackAndCounted) {
    Image image = make_image(4, 2, {"B", "G", "R"});
    image.channels[0].values[0] = -1e-30f;
    image.channels[1].values[3] = std::numeric_limits<float>::quiet_NaN();
    image.channels[2].values[3] = -1.0f;  // The same texel again.
    image.channels[2].values[6] = INFINITE;
    image.channels[0].values[7] = -INFINITE;
    image.channels[0].values[5] = 0.0f;
    const Environment environment = load(image);
    for (const size_t i : {0, 3, 6, 7})
        EXPECT_EQ(environment.radiance[i], vec3(0)) << i;
    for (const size_t i : {1, 2, 4})
        EXPECT_EQ(environment.radiance[i], vec3(float(17 + i), float(9 + i), float(1 + i))) << i;
    EXPECT_EQ(environment.radiance[5], vec3(22, 14, 0)) << "zero is a fine value";
    EXPECT_EQ(warnings_,
              std::vector{named("4 of 8 texels are negative or not finite, and are treated as black")});

    image = make_image(4, 2, {"Y"});
    image.channels[0].values[0] = -1.0f;
    load(image);
    EXPECT_EQ(warnings_,
              std::vector{named("1 of 8 texels is negative or not finite, and is treated as black")});
}

TEST_F(EnvironmentFile, WarnsOfAStretchedMap) {
    EXPECT_EQ(load(make_image(3, 2, {"R", "G", "B"})).size, uvec2(3, 2));
    EXPECT_EQ(warnings_,
              std::vector{named("the environment has 3x2 texels, not twice as many across as down; "
                                "it is stretched over the sphere")});
}

TEST_F(EnvironmentFile, WarnsThatBlackGivesNoLight) {
    Image image = make_image(4, 2, {"Y"});
    std::ranges::fill(image.channels[0].values, 0.0f);
    const std::string black = named("the environment is black everywhere: it gives no light");
    load(image);
    EXPECT_EQ(warnings_, std::vector{black});
    std::ranges::fill(image.channels[0].values, -1.0f);
    load(image);
    const std::string count = named("8 of 8 texels are negative or not finite, and are treated as black");
    EXPECT_EQ(warnings_, (std::vector{count, black}));
    image.channels[0].values[7] = 1e-30f;
    load(image);
    EXPECT_EQ(warnings_.size(), 1u) << "a little light is light";
}

TEST_F(EnvironmentFile, HasALimitToItsSize) {
    path_ = directory_ / "sky.hdr";
    write_quickly(path_, hdr_header(8193, 8192));
    EXPECT_EQ(error_of([&] { load(); }),
              "cannot read \"" + path_.string() +
                  "\": its 8193x8192 pixels are more than the 67108864 allowed here; make the image smaller");
    write_quickly(path_, hdr_header(8192, 8192));  // Just allowed, but without pixels.
    EXPECT_NE(error_of([&] { load(); }).find("8192x8192 pixels are more than "), std::string::npos);
}

TEST_F(EnvironmentFile, SaysWhyAFileCannotBeUsed) {
    EXPECT_EQ(error_of([&] { load(); }),
              "cannot read \"" + path_.string() + "\": the file does not exist; check the name");
    path_ = directory_ / "sky.png";
    write_quickly(path_, "\x89PNG\r\n");
    EXPECT_EQ(error_of([&] { load(); }),
              "cannot read \"" + path_.string() +
                  "\": it is neither an OpenEXR image nor a Radiance picture; give an .exr or .hdr image");
}

// The centre of a texel, as Environment says.
vec3 texel_direction(uvec2 size, uint32_t x, uint32_t y) {
    const float azimuth = 2.0f * PI * ((float(x) + 0.5f) / float(size.x) - 0.5f);
    const float polar = PI * (float(y) + 0.5f) / float(size.y);
    return {std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)};
}

// What make_sky.py says of its sun: where it is, and its irradiance by the colour of a white sheet.
TEST(Sky, HasItsSunWhereItsMakerSays) {
    std::vector<std::string> warnings;
    const fs::path path = fs::path(CANDELA_SCENES) / "sky.hdr";
    const Environment sky = load_environment(path, FileReach(path), warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(sky.size, uvec2(1024, 512));
    EXPECT_LE(fs::file_size(path), 2u << 20);

    const float azimuth = glm::radians(55.0f);
    const float elevation = glm::radians(18.0f);
    const vec3 sun(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                   -std::cos(elevation) * std::cos(azimuth));
    const double texel = 2.0 * PI / sky.size.x;
    double irradiance = 0.0;  // On a surface that faces the sun, from within one degree of it.
    for (uint32_t y = 0; y < sky.size.y; ++y) {
        for (uint32_t x = 0; x < sky.size.x; ++x) {
            const vec3 direction = texel_direction(sky.size, x, y);
            const vec3 radiance = sky.radiance[y * sky.size.x + x];
            const float luminance = glm::dot(radiance, vec3(0.2126f, 0.7152f, 0.0722f));
            if (glm::dot(direction, sun) > std::cos(glm::radians(1.0f))) {
                const double solid_angle = texel * texel * std::sqrt(1.0 - direction.y * direction.y);
                irradiance += luminance * solid_angle;
            } else {
                ASSERT_LT(luminance, 20.0f) << x << ", " << y;  // The sun has several 10 000.
            }
        }
    }
    // A white sheet has luminance 1 under irradiance pi: from the sky, and 5 times that from the sun, which
    // reaches the ground at 18 degrees. The sun's edge is sampled to 0.5 %, colours are rounded to 0.4 %, and
    // the bright sky around the sun, below 20 in 0.00096 sr, adds at most 0.3 %.
    EXPECT_NEAR(irradiance, PI * 5.0 / (1.0 + 5.0 * std::sin(elevation)), 0.012 * irradiance);
}

}  // namespace
}  // namespace candela
