// Point, spot and directional lights of a scene file, and what is refused.
#include <gtest/gtest.h>

#include "scene/geometry.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

// A scene with a surface and these lights.
std::string lit_by(const std::string& lights) {
    return "{" + GOOD_CAMERA +
           ",\n\"materials\": {\"grey\": {\"type\": \"diffuse\", \"reflectance\": 0.5}},\n\"shapes\": "
           "[{\"type\": \"sphere\", \"material\": \"grey\"}],\n\"lights\": " +
           lights + "}";
}

std::string spot(const std::string& members) {
    return lit_by("[@{\"type\": \"spot\", \"position\": [0, 1, 0], \"intensity\": 1, " + members + "}]");
}

// The same with its mark among the members.
std::string marked_spot(const std::string& members) {
    return lit_by("[{\"type\": \"spot\", \"position\": [0, 1, 0], \"intensity\": 1, " + members + "}]");
}

TEST(SceneLights, AreReadInTheirOrder) {
    SceneFolder folder;
    const Scene scene = folder.load(lit_by(R"([
        {"type": "directional", "direction": [0, -2, 0.5], "irradiance": [3, 2, 1], "angle": 90},
        {"type": "spot", "position": [1, 2, 3], "look_at": [1, 0, 3], "intensity": 7,
            "inner_angle": 10, "outer_angle": 90, "falloff": "smoothstep"},
        {"type": "point", "name": "bulb", "position": [1, 2, 3e30], "intensity": [0, 0.5, 1e30]},
        {"type": "spot", "position": [0, 0, 0], "direction": [3, 0, 0], "intensity": 1}])"));
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.lights.size(), 4u);

    EXPECT_EQ(scene.lights[0].name, "directional 1");
    const auto& sun = std::get<DirectionalLight>(scene.lights[0].model);
    EXPECT_EQ(sun.direction, dvec3(0, -2, 0.5));
    EXPECT_EQ(sun.irradiance, vec3(3, 2, 1));
    EXPECT_FLOAT_EQ(sun.angle, PI / 2);

    EXPECT_EQ(scene.lights[1].name, "spot 2");
    const auto& wide = std::get<SpotLight>(scene.lights[1].model);
    EXPECT_EQ(wide.position, dvec3(1, 2, 3));
    EXPECT_EQ(normalize(wide.direction), dvec3(0, -1, 0));
    EXPECT_EQ(wide.intensity, vec3(7));
    EXPECT_FLOAT_EQ(wide.cone.inner_angle, PI / 18);
    EXPECT_FLOAT_EQ(wide.cone.outer_angle, PI / 2);
    EXPECT_EQ(wide.cone.falloff, SpotFalloff::smoothstep);

    EXPECT_EQ(scene.lights[2].name, "bulb");
    const auto& bulb = std::get<PointLight>(scene.lights[2].model);
    EXPECT_EQ(bulb.position, dvec3(1, 2, 3e30));
    EXPECT_EQ(bulb.intensity, vec3(0, 0.5f, 1e30f));

    const auto& plain = std::get<SpotLight>(scene.lights[3].model);
    EXPECT_EQ(plain.direction, dvec3(3, 0, 0));
    EXPECT_EQ(plain.cone.inner_angle, 0.0f);
    EXPECT_FLOAT_EQ(plain.cone.outer_angle, PI / 4);
    EXPECT_EQ(plain.cone.falloff, SpotFalloff::square);
}

TEST(SceneLights, AreEnoughToLightAScene) {
    SceneFolder folder;
    const std::string black =
        R"({"type": "point", "name": "off", "position": [0, 2, 0], "intensity": [0, 0, 0]})";
    const Scene dark = folder.load(lit_by('[' + black + ']'));
    ASSERT_EQ(dark.warnings.size(), 2u);
    EXPECT_NE(dark.warnings[0].find("the light \"off\" is black: it gives no light"), std::string::npos);
    EXPECT_NE(dark.warnings[1].find("the scene has no light: the image will be black"), std::string::npos);
    const std::string bright = R"({"type": "directional", "direction": [0, -1, 0], "irradiance": 1})";
    folder.expect_warning(lit_by('[' + bright + ", @" + black + ']'),
                          "the light \"off\" is black: it gives no light");
}

TEST(SceneLights, ChecksTheirKeys) {
    SceneFolder folder;
    folder.expect_error(lit_by("@{}"), "\"lights\": expected an array [ ... ], found an object");
    folder.expect_error(lit_by("[@{}]"), "the key \"type\" is missing here; add it");
    folder.expect_error(lit_by("[{\"type\": @\"area\"}]"),
                        "unknown type \"area\" (known: point, spot, directional)");
    folder.expect_error(lit_by("[@{\"type\": \"point\", \"intensity\": 1}]"),
                        "the key \"position\" is missing here; add it");
    folder.expect_error(lit_by("[@{\"type\": \"point\", \"position\": [0, 0, 0]}]"),
                        "the key \"intensity\" is missing here; add it");
    folder.expect_error(
        lit_by("[{\"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": @[1, -1, 0]}]"),
        "\"intensity\": expected numbers of at least 0, found [1, -1, 0]");
    folder.expect_error(lit_by("[{\"type\": \"point\", @\"radius\": 1}]"),
                        "unknown key \"radius\" (known: type, name, position, intensity)");
    folder.expect_error(
        lit_by("[{\"type\": \"point\", \"name\": @1, \"position\": [0, 0, 0], \"intensity\": 1}]"),
        "\"name\": expected a string, found 1");
    folder.expect_error(lit_by("[{\"type\": \"directional\", \"direction\": @[0, 0, 0], \"irradiance\": 1}]"),
                        "\"direction\": expected a direction, not zero, found [0, 0, 0]");
    folder.expect_error(
        lit_by(
            "[{\"type\": \"directional\", \"direction\": [0, 0, 1], @\"intensity\": 1, \"irradiance\": 1}]"),
        "unknown key \"intensity\" (known: type, name, direction, irradiance, angle)");
    const auto wide_sun = [](const std::string& angle) {
        return lit_by(
            "[{\"type\": \"directional\", \"direction\": [0, 0, 1], \"irradiance\": 1, \"angle\": @" + angle +
            "}]");
    };
    folder.expect_error(wide_sun("180"), "\"angle\": expected an angle below 180 degrees, found 180");
    folder.expect_error(wide_sun("-1"), "\"angle\": expected a number of at least 0, found -1");
}

TEST(SceneLights, ChecksTheAxisOfASpot) {
    SceneFolder folder;
    const std::string either = "a spot light needs either \"direction\", or \"look_at\", a point on its axis";
    folder.expect_error(spot("\"inner_angle\": 1"), either);
    folder.expect_error(spot("\"direction\": [0, -1, 0], \"look_at\": [0, 0, 0]"), either);
    folder.expect_error(marked_spot("\"direction\": @[0, 0, 0]"),
                        "\"direction\": expected a direction, not zero, found [0, 0, 0]");
    folder.expect_error(marked_spot("\"look_at\": @[0, 1, 0]"),
                        "the light looks at its own position; move one of the two");
}

TEST(SceneLights, ChecksTheAnglesOfASpot) {
    SceneFolder folder;
    const std::string outer = "\"direction\": [0, -1, 0], \"outer_angle\": @";
    const std::string range = "\"outer_angle\": expected an angle above 0 and of at most 90 degrees, found ";
    folder.expect_error(marked_spot(outer + "0"), range + "0");
    folder.expect_error(marked_spot(outer + "-10"), range + "-10");
    folder.expect_error(marked_spot(outer + "90.5"), range + "90.5");
    folder.expect_error(marked_spot("\"direction\": [0, -1, 0], \"inner_angle\": @-1"),
                        "\"inner_angle\": expected a number of at least 0, found -1");
    for (const char* inner : {"45", "60"}) {
        folder.expect_error(marked_spot("\"direction\": [0, -1, 0], \"inner_angle\": @" + std::string(inner)),
                            "inner_angle must be below outer_angle, which is 45 degrees");
    }
    folder.expect_error(
        marked_spot("\"direction\": [0, -1, 0], \"outer_angle\": 20, \"inner_angle\": @20.0000000001"),
        "inner_angle must be below outer_angle, which is 20 degrees");
}

}  // namespace
}  // namespace candela
