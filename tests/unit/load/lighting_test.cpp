// Light as the user asks for it: studios, their ground, and images of a sky for any scene.
#include "load/lighting.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/color.h"
#include "image/image_io.h"
#include "scene/environment.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

constexpr std::array<StudioChoice, 5> STUDIOS = {StudioChoice::standard, StudioChoice::softbox,
                                                 StudioChoice::white, StudioChoice::overcast,
                                                 StudioChoice::sunset};

bool has_ground(StudioChoice studio) {
    return studio != StudioChoice::standard && studio != StudioChoice::softbox;
}

// The radiance of white paper that lies in the light: the mean of directions in proportion to their cosine,
// each looked up in the map.
vec3 paper(const Environment& environment) {
    dvec3 sum(0.0);
    constexpr int N = 1000;
    for (int i = 0; i < N; ++i) {
        const double v = std::acos(std::sqrt((i + 0.5) / N)) / M_PI;
        for (int j = 0; j < N; ++j) {
            const uvec2 texel(uint32_t((j + 0.5) / N * environment.size.x), uint32_t(v * environment.size.y));
            sum +=
                dvec3(environment.radiance[size_t{texel.y} * environment.size.x + texel.x]) / double(N * N);
        }
    }
    return vec3(sum);
}

TEST(Studio, WhitePaperHasTheStatedRadiance) {
    const auto luminance_in = [](StudioChoice studio) {
        return luminance(paper(studio_environment(studio)));
    };
    EXPECT_NEAR(luminance_in(StudioChoice::white), 1.25, 0.01);
    EXPECT_NEAR(luminance_in(StudioChoice::overcast), 0.9, 0.01);
    EXPECT_NEAR(luminance_in(StudioChoice::sunset), 0.5, 0.02);
}

TEST(Studio, TheGroundIsAsBrightAsTheSkyBelowTheHorizon) {
    for (const StudioChoice studio : STUDIOS) {
        SCOPED_TRACE(int(studio));
        Scene scene;
        scene.materials.emplace_back();
        scene.shapes.push_back(
            {.geometry = Sphere{.center = dvec3(1, 5, 2), .radius = 2.0}, .material = 0, .emission = {}});
        put_into_studio(scene, studio);
        ASSERT_EQ(scene.shapes.size(), has_ground(studio) ? 2u : 1u);
        EXPECT_EQ(scene.environment->visible, has_ground(studio));
        if (!has_ground(studio)) continue;
        const Disk& ground = std::get<Disk>(scene.shapes[1].geometry);
        EXPECT_LT(ground.center.y, 3.0);
        EXPECT_GT(ground.center.y, 2.99);
        EXPECT_GT(cross(ground.e1, ground.e2).y, 0.0);  // Its front is above.
        EXPECT_GT(length(ground.e1), 10 * 2.0);
        const vec3 reflectance =
            std::get<DiffuseMaterial>(scene.materials[scene.shapes[1].material].model).reflectance.factor;
        const vec3 expected = reflectance * paper(*scene.environment),
                   below = scene.environment->radiance.back();
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(expected[c], below[c], 0.01f);
        if (studio == StudioChoice::white) {
            EXPECT_NEAR(below.x, 1.0f, 0.01f);  // As the sky at the horizon.
        }
    }
}

TEST(Studio, OfNothingHasNoGround) {
    Scene scene;
    put_into_studio(scene, StudioChoice::white);
    EXPECT_TRUE(scene.shapes.empty());
}

// Ref: the CIE's overcast sky, three times as bright above as at the horizon.
TEST(Studio, AnOvercastSkyIsBrightestAbove) {
    const Environment sky = studio_environment(StudioChoice::overcast);
    const float above = sky.radiance[0].y;
    const float horizon = sky.radiance[size_t{sky.size.x} * (sky.size.y / 2 - 1)].y;
    EXPECT_NEAR(above / horizon, 3.0f, 0.15f);
}

class LightingTest : public testing::Test {
  protected:
    LightingTest() {
        folder_.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        folder_.write(
            "m.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        folder_.write(
            "m.json",
            scene_of(R"({"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "white"})"));
        folder_.write("m.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{}]})");
        Image sky{.full = {2, 1}, .data = {0, 0, 2, 1}, .channels = {}, .attributes = {}};
        for (const char* name : {"R", "G", "B"})
            sky.add(name).values = {1.0f, 4.0f};
        write_exr(sky_, sky);
    }
    Scene load(const std::string& name, const LightingOptions& lighting) const {
        return load_scene(folder_.path() / name, {.lighting = lighting});
    }
    std::string error(const std::string& name, const LightingOptions& lighting) const {
        return folder_.without_folder(error_of([&] { load(name, lighting); }));
    }

    SceneFolder folder_;
    TemporaryDirectory elsewhere_;
    std::filesystem::path sky_ = elsewhere_ / "sky.exr";
};

TEST_F(LightingTest, AStudioLightsAnyScene) {
    for (const char* name : {"m.obj", "m.ply", "m.json", "m.gltf"}) {
        for (const StudioChoice studio : STUDIOS) {
            const Scene scene = load(name, {.studio = studio});
            ASSERT_TRUE(scene.environment);
            EXPECT_EQ(scene.environment->radiance, studio_environment(studio).radiance) << name;
        }
    }
}

TEST_F(LightingTest, OffLeavesAModelDarkAndSaysSo) {
    for (const std::string name : {"m.obj", "m.ply"}) {
        EXPECT_EQ(load(name, {}).environment.value().radiance, std::vector<vec3>{vec3(1)});
        EXPECT_EQ(load(name, {.studio = StudioChoice::automatic}).environment.value().radiance,
                  std::vector<vec3>{vec3(1)});
        const Scene dark = load(name, {.studio = StudioChoice::off});
        EXPECT_FALSE(dark.environment);
        ASSERT_FALSE(dark.warnings.empty());
        EXPECT_EQ(folder_.without_folder(dark.warnings.back()),
                  name + ": the scene has no light: the image will be black");
    }
}

// The file may lie anywhere: the user names it, not the scene.
TEST_F(LightingTest, AnImageLightsAnyScene) {
    for (const char* name : {"m.obj", "m.ply", "m.json", "m.gltf"}) {
        const Scene scene = load(name, {.environment = sky_});
        ASSERT_TRUE(scene.environment);
        EXPECT_EQ(scene.environment->radiance, (std::vector<vec3>{vec3(1), vec3(4)}));
        EXPECT_TRUE(scene.environment->visible);
        EXPECT_EQ(scene.files.back(), sky_);
        for (const std::string& warning : scene.warnings)
            EXPECT_EQ(warning.find("no light"), std::string::npos) << warning;
    }
}

TEST_F(LightingTest, ASkyLightsAnyScene) {
    const Sky sky{.sun_elevation = 0.5, .sun_azimuth = 1.0};
    const Environment expected = sky_environment(sky);
    for (const char* name : {"m.obj", "m.gltf"}) {
        const Scene scene = load(name, {.sky = sky});
        ASSERT_TRUE(scene.environment);
        EXPECT_EQ(scene.environment->radiance, expected.radiance) << name;
        EXPECT_TRUE(scene.environment->visible);
        for (const std::string& warning : scene.warnings)
            EXPECT_EQ(warning.find("no light"), std::string::npos) << warning;
    }
}

TEST_F(LightingTest, AnEnvironmentIsTurnedScaledAndHidden) {
    for (const bool image : {true, false}) {
        LightingOptions options{.rotation = 450.0, .intensity = 2.5, .hidden = true};
        if (image) options.environment = sky_;
        const Environment changed = load("m.obj", options).environment.value();
        EXPECT_EQ(changed.radiance.back(), vec3(image ? 10.0f : 2.5f));
        EXPECT_FLOAT_EQ(changed.rotation, float(M_PI / 2));
        EXPECT_FALSE(changed.visible);
    }
}

TEST_F(LightingTest, WhatCannotBeDoneIsRefused) {
    EXPECT_EQ(error("m.obj", {.studio = StudioChoice::white, .environment = sky_}),
              "--environment and --studio both light the scene; give one of them");
    EXPECT_EQ(error("m.obj", {.studio = StudioChoice::white, .sky = Sky{}}),
              "--sky and --studio both light the scene; give one of them");
    EXPECT_EQ(error("m.obj", {.environment = sky_, .sky = Sky{}}),
              "--environment and --sky both light the scene; give one of them");
    for (const LightingOptions& options :
         {LightingOptions{.rotation = 1.0}, LightingOptions{.intensity = 1.0},
          LightingOptions{.hidden = true}}) {
        EXPECT_EQ(error("m.json", options),
                  "m.json:3:11: the scene has no environment to turn, scale or hide; give one (--environment "
                  "FILE)");
    }
    EXPECT_EQ(
        error("m.obj", {.environment = sky_, .intensity = 1e38}),
        "--environment-intensity: radiance times intensity exceeds the range of 32-bit floats; lower the "
        "intensity");
    EXPECT_EQ(error("m.obj", {.environment = elsewhere_ / "none.exr"}).rfind("cannot read \"", 0), 0u);
}

}  // namespace
}  // namespace candela
