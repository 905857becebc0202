// The environment of a scene file: constant or from an image, and what is refused.
#include <gtest/gtest.h>

#include "image/image_io.h"
#include "scene/geometry.h"
#include "scene/sky.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

// A scene with an emitter and this environment.
std::string lit(const std::string& environment) {
    return "{" + GOOD_CAMERA +
           ",\n\"shapes\": [{\"type\": \"sphere\", \"emission\": 1}],\n\"environment\": " + environment + "}";
}

class SceneEnvironment : public testing::Test {
  protected:
    // Writes a map of 4x2 texels: red is 1 .. 8 times `brightness`, green half of that, blue 0.
    void write_sky(float brightness) {
        Image image{uvec2(4, 2), {0, 0, 4, 2}, {}, {}};
        for (const char* name : {"R", "G", "B"})
            image.add(name);
        for (size_t i = 0; i < 8; ++i) {
            image.channels[0].values[i] = brightness * float(i + 1);
            image.channels[1].values[i] = 0.5f * brightness * float(i + 1);
        }
        write_exr(folder_.path() / "sky.exr", image);
    }

    Environment load(const std::string& text) {
        const Scene scene = folder_.load(lit(text));
        EXPECT_TRUE(scene.warnings.empty());
        return scene.environment.value();
    }

    SceneFolder folder_;
};

TEST_F(SceneEnvironment, IsAbsentUnlessGiven) {
    EXPECT_FALSE(folder_.load(settings(GOOD_CAMERA)).environment.has_value());
}

TEST_F(SceneEnvironment, MayBeConstant) {
    const Environment grey = load(R"({"radiance": 0.5})");
    EXPECT_EQ(grey.size, uvec2(1, 1));
    EXPECT_EQ(grey.radiance, std::vector<vec3>{vec3(0.5f)});
    EXPECT_EQ(grey.rotation, 0.0f);
    EXPECT_TRUE(grey.visible);
    const Environment blue = load(R"({"radiance": [1, 2, 3], "intensity": 2.5, "visible": false})");
    EXPECT_EQ(blue.radiance, std::vector<vec3>{vec3(2.5f, 5.0f, 7.5f)});
    EXPECT_FALSE(blue.visible);
}

TEST_F(SceneEnvironment, MayBeAnImageBesideTheScene) {
    write_sky(1.0f);
    const Environment sky = load(R"({"file": "sky.exr"})");
    EXPECT_EQ(sky.size, uvec2(4, 2));
    ASSERT_EQ(sky.radiance.size(), 8u);
    EXPECT_EQ(sky.radiance[5], vec3(6, 3, 0));
    EXPECT_EQ(sky.rotation, 0.0f);
    EXPECT_TRUE(sky.visible);
    const Environment turned =
        load(R"({"file": "sky.exr", "rotation": -450, "intensity": 3, "visible": false})");
    EXPECT_EQ(turned.radiance[7], vec3(24, 12, 0));
    EXPECT_FLOAT_EQ(turned.rotation, -PI / 2);
    EXPECT_FALSE(turned.visible);
}

TEST_F(SceneEnvironment, IsALight) {
    const std::string dark_sphere = R"("shapes": [{"type": "sphere", "material": "m"}], "materials":
        {"m": {"type": "mirror"}}, "environment": )";
    EXPECT_TRUE(
        folder_.load("{" + GOOD_CAMERA + ", " + dark_sphere + R"({"radiance": 1}})").warnings.empty());
    EXPECT_TRUE(folder_.load(settings(GOOD_CAMERA + R"(, "environment": {"radiance": 1})")).warnings.empty());
    const Scene black = folder_.load("{" + GOOD_CAMERA + ", " + dark_sphere + R"({"radiance": 0}})");
    EXPECT_EQ(black.warnings.size(), 2u);  // The environment is black, and the scene has no light.
}

TEST_F(SceneEnvironment, WarnsOfBlack) {
    write_sky(1.0f);
    const std::string black = "the environment is black: it gives no light";
    folder_.expect_warning(lit(R"(@{"radiance": 0})"), black);
    folder_.expect_warning(lit(R"(@{"radiance": 1, "intensity": 0})"), black);
    folder_.expect_warning(lit(R"(@{"radiance": 1e-30, "intensity": 1e-30})"), black);
    folder_.expect_warning(lit(R"(@{"file": "sky.exr", "intensity": 0})"), black);
    const Scene scene = folder_.load(lit(R"({"radiance": 0})"));
    ASSERT_TRUE(scene.environment.has_value());
    EXPECT_FALSE(gives_light(*scene.environment));
}

TEST_F(SceneEnvironment, HandsOnTheWarningsOfTheImage) {
    write_sky(0.0f);
    folder_.expect_warning(lit(R"({"file": @"sky.exr"})"),
                           "sky.exr: the environment is black everywhere: it gives no light");
}

TEST_F(SceneEnvironment, ReportsAnImageThatCannotBeRead) {
    folder_.expect_error(lit(R"({"file": @"none.exr"})"),
                         "cannot read \"none.exr\": the file does not exist; check the name");
    // The image reader says what is wrong with a file, the loader where the scene names it.
    folder_.write("empty.hdr", "");
    folder_.write("text.exr", "This is no image.");
    for (const std::string file : {"empty.hdr", "text.exr"}) {
        std::string text = lit("{\"file\": @\"" + file + "\"}");
        const std::string place = "scene.json:" + take_mark(text) + ": ";
        const std::string message = folder_.without_folder(error_of([&] { folder_.load(text); }));
        EXPECT_TRUE(message.starts_with(place)) << message;
        EXPECT_NE(message.find(file), std::string::npos) << message;
    }
}

TEST_F(SceneEnvironment, ChecksItsValues) {
    const std::string either = "the environment needs either \"file\", an image, or \"radiance\", a constant";
    folder_.expect_error(lit("@{}"), either);
    folder_.expect_error(lit(R"(@{"file": "sky.exr", "radiance": 1})"), either);
    folder_.expect_error(lit(R"({@"fil": "sky.exr"})"),
                         "unknown key \"fil\" (did you mean \"file\"? known: file, radiance, rotation, "
                         "intensity, visible)");
    folder_.expect_error(lit(R"({"radiance": @[1, 2, -3]})"),
                         "\"radiance\": expected numbers of at least 0, found [1, 2, -3]");
    folder_.expect_error(lit(R"({"radiance": 1, "intensity": @-1})"),
                         "\"intensity\": expected a number of at least 0, found -1");
    folder_.expect_error(lit(R"({"radiance": 1, "visible": @1})"),
                         "\"visible\": expected true or false, found 1");
    folder_.expect_error(lit(R"({"radiance": 1, "rotation": @90})"),
                         "a constant environment looks the same in all directions; rotation needs \"file\"");
    const std::string range =
        "radiance times intensity exceeds the range of 32-bit floats; lower the intensity";
    folder_.expect_error(lit(R"({"radiance": [0, 0, 1e20], "intensity": @1e19})"), range);
    write_sky(1e30f);
    folder_.expect_error(lit(R"({"file": "sky.exr", "intensity": @1e8})"), range);
}

// A scene with an emitter and this sky.
std::string under(const std::string& sky) {
    return "{" + GOOD_CAMERA + ",\n\"shapes\": [{\"type\": \"sphere\", \"emission\": 1}],\n\"sky\": " + sky +
           "}";
}

TEST_F(SceneEnvironment, MayBeASky) {
    const Scene scene = folder_.load(under(R"({"sun_elevation": 25, "sun_azimuth": 470, "turbidity": 3,
        "ground": [0.1, 0.2, 0.3], "intensity": 2, "visible": false})"));
    EXPECT_TRUE(scene.warnings.empty());
    const Environment& sky = scene.environment.value();
    EXPECT_FALSE(sky.visible);
    const Environment expected = sky_environment({.sun_elevation = glm::radians(25.0),
                                                  .sun_azimuth = glm::radians(110.0),
                                                  .turbidity = 3.0,
                                                  .ground = vec3(0.1f, 0.2f, 0.3f)});
    ASSERT_EQ(sky.radiance.size(), expected.radiance.size());
    // The azimuth is rounded at 2^-50, which may move parts of the disk's edge between texels.
    for (size_t i = 0; i < sky.radiance.size(); i += 997) {
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(sky.radiance[i][c], 2.0f * expected.radiance[i][c], 1e-5f * sky.radiance[i].x);
    }
}

TEST_F(SceneEnvironment, ChecksTheNumbersOfASky) {
    folder_.expect_error(under("@{}"), "the key \"sun_elevation\" is missing here; add it");
    for (const std::string elevation : {"-6.1", "90.1"})
        folder_.expect_error(under("{\"sun_elevation\": @" + elevation + "}"),
                             "\"sun_elevation\": expected a number from -6 to 90, found " + elevation);
    for (const std::string turbidity : {"0.9", "11"})
        folder_.expect_error(under("{\"sun_elevation\": 3, \"turbidity\": @" + turbidity + "}"),
                             "\"turbidity\": expected a number from 1 to 10, found " + turbidity);
    folder_.expect_error(under(R"({"sun_elevation": 3, "sun_azimuth": @"east"})"),
                         "\"sun_azimuth\": expected a number, found \"east\"");
    folder_.expect_error(under(R"({"sun_elevation": 3, "ground": @2})"),
                         "\"ground\": expected numbers from 0 to 1, found 2");
    folder_.expect_error(under(R"({"sun_elevation": 3, @"rotation": 2})"),
                         "unknown key \"rotation\" (known: sun_elevation, sun_azimuth, turbidity, ground, "
                         "intensity, visible)");
    folder_.expect_error(
        under(R"(@{"sun_elevation": 3}, "environment": {"radiance": 1})"),
        "the scene already has an \"environment\", and the sky is one, too; leave one of them "
        "out");
}

}  // namespace
}  // namespace candela
