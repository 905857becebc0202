// Which surfaces are catchers, by scene files and by options; and the ground.
#include "scene/catchers.h"

#include <gtest/gtest.h>

#include "load/json/change.h"
#include "unit/load/scene_fixture.h"
#include "views/bodies.h"

namespace candela {
namespace {

// Two white balls, and one that glows, of radius 1 and at y = 5; with more keys of the first and of the last.
std::string balls(const std::string& first, const std::string& last = "") {
    const auto ball = [](int x, const std::string& material, const std::string& keys) {
        return R"({ "type": "sphere", "center": [)" + std::to_string(x) +
               R"(, 5, 0], "radius": 1, "material": ")" + material + '"' + keys + " }";
    };
    return R"({ "cameras": { "main": { "position": [0, 0, 9], "look_at": [0, 0, 0], "vertical_fov": 40 } },
        "materials": { "white": { "type": "diffuse", "reflectance": 1 },
                       "lit": { "type": "principled", "emission": 1 },
                       "toon": { "type": "principled", "unlit": true } },
        "shapes": [ )" +
           ball(0, "white", first) + ", " + ball(3, "white", "") + ", " + ball(6, "lit", last) + " ] }";
}

class CatchersTest : public testing::Test {
  protected:
    Scene load(const CatcherOptions& options, std::optional<StudioChoice> studio = {}) {
        folder_.write("balls.json", balls(""));
        return load_scene(folder_.path() / "balls.json",
                          {.lighting = {.studio = studio, .catchers = options}});
    }
    std::string error(const CatcherOptions& options) {
        return folder_.without_folder(error_of([&] { load(options); }));
    }
    static Catcher catcher_of(const Scene& scene, size_t shape) {
        return scene.materials[scene.shapes[shape].material].catcher;
    }

    SceneFolder folder_;
};

// Other shapes of the same material are not.
TEST_F(CatchersTest, AShapeOfANativeSceneIsOneByItself) {
    const Scene scene = folder_.load(balls(R"(, "shadow_catcher": "catch-reflections")"));
    EXPECT_EQ(catcher_of(scene, 0), Catcher::reflections);
    EXPECT_EQ(catcher_of(scene, 1), Catcher::none);
    EXPECT_EQ(scene.materials[scene.shapes[0].material].model,
              scene.materials[scene.shapes[1].material].model);
    EXPECT_TRUE(has_catchers(scene));
    EXPECT_FALSE(has_catchers(folder_.load(balls(""))));
    const Scene held_out = folder_.load(balls("", R"(, "shadow_catcher": "holdout")"));
    EXPECT_EQ(catcher_of(held_out, 2), Catcher::holdout);
    EXPECT_TRUE(held_out.shapes[2].emission.has_value());
    folder_.expect_error(balls(R"(, "shadow_catcher": @"shadows")"),
                         R"(unknown shadow_catcher "shadows" (known: catch, catch-reflections, holdout))");
    folder_.expect_error(balls("", R"(, "shadow_catcher": @"catch")"),
                         std::string("the shape ") + CATCHER_EMITS);
}

TEST_F(CatchersTest, AShapeOfANativeSceneMayBeHiddenFromTheCamera) {
    const auto is_hidden = [](const Scene& scene, size_t shape) {
        return scene.materials[scene.shapes[shape].material].hidden;
    };
    const Scene scene =
        folder_.load(balls(R"(, "visible_to_camera": false)", R"(, "visible_to_camera": true)"));
    EXPECT_TRUE(is_hidden(scene, 0));
    EXPECT_FALSE(is_hidden(scene, 1));
    EXPECT_FALSE(is_hidden(scene, 2));
    EXPECT_FALSE(has_catchers(scene));
    const Scene lamp = folder_.load(balls("", R"(, "visible_to_camera": false)"));
    EXPECT_TRUE(is_hidden(lamp, 2));
    EXPECT_TRUE(lamp.shapes[2].emission.has_value());
    folder_.expect_error(balls(R"(, "visible_to_camera": @0)"),
                         R"("visible_to_camera": expected true or false, found 0)");
}

// A change of a material also reaches the shapes of it that the camera sees in another way, and leaves that
// as it is.
TEST_F(CatchersTest, ChangesReachCatchersAndWhatIsHidden) {
    Scene scene = folder_.load(balls(R"(, "shadow_catcher": "catch")", R"(, "visible_to_camera": false)"));
    SceneEdits edits;
    change_scene(scene, R"({ "materials": { "white": { "type": "diffuse", "reflectance": 0.25 },
                                             "lit": { "emission": 3 } } })",
                 "change", folder_.path(), edits);
    const auto reflectance = [&](size_t shape) {
        return std::get<DiffuseMaterial>(scene.materials[scene.shapes[shape].material].model)
            .reflectance.factor.x;
    };
    EXPECT_EQ(reflectance(0), 0.25f);
    EXPECT_EQ(reflectance(1), 0.25f);
    EXPECT_EQ(catcher_of(scene, 0), Catcher::shadows);
    EXPECT_EQ(catcher_of(scene, 1), Catcher::none);
    EXPECT_EQ(scene.shapes[2].emission->radiance.factor, vec3(3.0f));
    EXPECT_TRUE(scene.materials[scene.shapes[2].material].hidden);
}

// What an instance does not say is as in its object.
TEST_F(CatchersTest, InstancesAreSeenAsTheirObjects) {
    const Scene scene = folder_.load(
        R"({ "cameras": { "main": { "position": [0, 0, 9], "look_at": [0, 0, 0], "vertical_fov": 40 } },
             "materials": { "white": { "type": "diffuse", "reflectance": 1 } },
             "objects": { "sheet": [ { "type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                                       "triangles": [[0, 1, 2]], "material": "white", "visible_to_camera": false } ] },
             "shapes": [ { "type": "instance", "object": "sheet" },
                         { "type": "instance", "object": "sheet", "visible_to_camera": true },
                         { "type": "instance", "object": "sheet", "shadow_catcher": "catch" } ] })");
    const std::vector<bool> hidden{true, false, true};
    for (size_t i = 0; i < 3; ++i)
        EXPECT_EQ(scene.materials[scene.shapes.at(i).material].hidden, hidden[i]) << i;
    EXPECT_EQ(catcher_of(scene, 2), Catcher::shadows);
}

TEST_F(CatchersTest, OptionsNameMaterials) {
    const Scene scene = load({.shadows = {"white"}});
    EXPECT_EQ(catcher_of(scene, 0), Catcher::shadows);
    EXPECT_EQ(catcher_of(scene, 1), Catcher::shadows);
    EXPECT_EQ(catcher_of(scene, 2), Catcher::none);
    EXPECT_EQ(catcher_of(load({.reflections = {"white"}}), 1), Catcher::reflections);
    EXPECT_EQ(catcher_of(load({.holdouts = {"white"}}), 1), Catcher::holdout);
    EXPECT_EQ(error({.shadows = {"floor"}}),
              "--shadow-catcher: unknown material \"floor\" (defined: white, lit, toon)");
    EXPECT_EQ(error({.reflections = {"floor"}}),
              "--reflection-catcher: unknown material \"floor\" (defined: white, lit, toon)");
}

TEST_F(CatchersTest, WhatEmitsIsRefused) {
    EXPECT_NE(
        error({.shadows = {"lit"}})
            .find(
                "a surface of the material \"lit\" emits light, or shows its colour in any light, and cannot "
                "catch shadows; choose another surface, or take its light away"),
        std::string::npos);
    Scene scene = load({});
    scene.shapes[0].material = 2;  // Unlit.
    EXPECT_EQ(error_of([&] { make_catchers(scene, "toon.glb", {.shadows = {"toon"}}); }),
              std::string("toon.glb: a surface of the material \"toon\" ") + CATCHER_EMITS);
    EXPECT_NO_THROW(load({.holdouts = {"lit"}}));  // It gives its light, unseen.
}

// Views are fitted to what stands on it.
TEST_F(CatchersTest, TheGroundLiesBelowTheSceneAndIsNoneOfItsBodies) {
    EXPECT_FALSE(load({}).ground.has_value());
    const ShownBodies before = shown_bodies(load({}));
    for (const auto& [name, catcher] : GROUND_NAMES) {
        const Scene scene = load({.ground = catcher});
        ASSERT_EQ(scene.ground, 3u);
        const Disk& ground = std::get<Disk>(scene.shapes[3].geometry);
        EXPECT_LT(ground.center.y, 4.0);
        EXPECT_GT(ground.center.y, 3.99);
        EXPECT_GT(cross(ground.e1, ground.e2).y, 0.0);
        EXPECT_EQ(catcher_of(scene, 3), catcher);
        EXPECT_EQ(has_catchers(scene), catcher != Catcher::none);
        EXPECT_EQ(shown_bodies(scene).bodies.size(), before.bodies.size());
        EXPECT_EQ(shown_bodies(scene).origin, before.origin);
    }
}

// A studio that has a ground gets no second one.
TEST_F(CatchersTest, AStudiosGroundIsTheGround) {
    const Scene scene = load({.ground = Catcher::shadows}, StudioChoice::overcast);
    ASSERT_EQ(scene.shapes.size(), 4u);
    EXPECT_EQ(scene.materials[scene.shapes[3].material].name, "studio ground");
    EXPECT_EQ(catcher_of(scene, 3), Catcher::shadows);
    EXPECT_EQ(catcher_of(load({}, StudioChoice::overcast), 3), Catcher::none);
    EXPECT_EQ(load({.ground = Catcher::shadows}, StudioChoice::softbox).materials.back().name, "ground");
}

}  // namespace
}  // namespace candela
