// The identity of a rendering: all that its image depends on, and nothing else.
#include <algorithm>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "film/identity.h"
#include "probe/scenes.h"
#include "render/make_identity.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

class PictureIdentity : public testing::Test {
  protected:
    static RenderSettings plain() {
        RenderSettings settings;
        settings.size = uvec2(40, 30);
        settings.crop = {10, 20, 13, 22};
        settings.light_sampler = LightSampler::tree;
        return settings;
    }
    Identity identity(const RenderSettings& settings = plain()) const {
        return make_identity(build_gpu_scene(scene_), scene_.cameras.front(), settings);
    }
    // How the identity differs after the change.
    std::string after(const std::function<void(RenderSettings&, Scene&)>& change) const {
        RenderSettings settings = plain();
        Scene scene = scene_;
        change(settings, scene);
        const Identity changed = make_identity(build_gpu_scene(scene), scene.cameras.front(), settings);
        EXPECT_EQ(changed.hash == identity().hash, difference(changed, identity()).empty());
        return difference(changed, identity());
    }

    Scene scene_ = scene_of_everything();
};

TEST_F(PictureIdentity, EverySettingIsNamedWithBothValues) {
    const auto expect_named = [&](const char* message, const std::function<void(RenderSettings&)>& change) {
        EXPECT_EQ(after([&](RenderSettings& settings, Scene&) { change(settings); }), message);
    };
    expect_named("its size is 41x30, not 40x30", [](RenderSettings& s) { s.size.x = 41; });
    expect_named("its crop is 11,20,13,22, not 10,20,13,22", [](RenderSettings& s) { s.crop.x0 = 11; });
    expect_named("its crop is 10,20,13,23, not 10,20,13,22", [](RenderSettings& s) { s.crop.y1 = 23; });
    expect_named("its seed is 1, not 0", [](RenderSettings& s) { s.seed = 1; });
    expect_named("its sampler is stratified, not sobol",
                 [](RenderSettings& s) { s.sampler = SamplerKind::stratified; });
    expect_named("its estimator is light, not mis",
                 [](RenderSettings& s) { s.estimator = Estimator::light; });
    expect_named("its light sampler is power, not tree",
                 [](RenderSettings& s) { s.light_sampler = LightSampler::power; });
    expect_named("its terminator is flat, not smooth",
                 [](RenderSettings& s) { s.terminator = Terminator::flat; });
    expect_named("its max depth is 5, not 4096", [](RenderSettings& s) { s.max_depth = 5; });
    expect_named("its filter is tent,2, not box,1", [](RenderSettings& s) {
        s.filter = {FilterShape::tent, 2.0f};
    });
    expect_named("its filter is box,1.5, not box,1", [](RenderSettings& s) { s.filter.width = 1.5f; });
    expect_named("its clamp of indirect light is 10, not none",
                 [](RenderSettings& s) { s.clamp_indirect = 10.0f; });
    expect_named("its seed is 2, not 0, its rr depth is 4, not 3", [](RenderSettings& s) {
        s.rr_depth = 4;
        s.seed = 2;
    });
}

TEST_F(PictureIdentity, EveryPartOfTheCameraIsPartOfIt) {
    const std::vector<std::function<void(Camera&)>> changes = {
        [](Camera& c) { c.position.z += 0x1p-20f; }, [](Camera& c) { c.look_at.x += 0x1p-10f; },
        [](Camera& c) { c.up.x += 0x1p-10f; },       [](Camera& c) { c.vertical_fov *= 1.0f + 0x1p-20f; },
        [](Camera& c) { c.lens.radius *= 1.5f; },    [](Camera& c) { c.lens.focal_distance *= 1.5f; },
        [](Camera& c) { ++c.lens.blades; },          [](Camera& c) { c.lens.rotation += 0.1f; },
        [](Camera& c) { c.ortho_height = 2.0; },     [](Camera& c) { c.principal_offset.x = 0.1f; },
        [](Camera& c) { c.focal_ratio = 1.1f; },     [](Camera& c) { c.principal_offset.y = 0.1f; },
        [](Camera& c) { c.panorama.emplace(); }};
    for (const auto& change : changes) {
        const std::string message =
            after([&](RenderSettings&, Scene& scene) { change(scene.cameras.front()); });
        EXPECT_EQ(message.rfind("its camera is at ", 0), 0u) << message;
        EXPECT_NE(message.find(", not at "), std::string::npos) << message;
    }
    EXPECT_EQ(after([](RenderSettings&, Scene& scene) { scene.cameras.front().name = "another name"; }), "");
    scene_.cameras.front().ortho_height = 2.0;
    const std::string taller =
        after([](RenderSettings&, Scene& scene) { scene.cameras.front().ortho_height = 2.5; });
    EXPECT_NE(taller.find("orthographic, 2.5 m high, not at "), std::string::npos) << taller;
    scene_.cameras.front().ortho_height.reset();
    scene_.cameras.front().panorama = Panorama{Mapping::fisheye, 2.0f};
    for (const auto& [change, text] : std::vector<std::pair<std::function<void(Camera&)>, std::string>>{
             {[](Camera& c) { c.panorama->fisheye_fov = 2.5f; }, ", fisheye of 2.5 rad, not at "},
             {[](Camera& c) { c.panorama->mapping = Mapping::equisolid; }, ", equisolid of 2 rad, not at "},
             {[](Camera& c) { c.principal_offset.x = 0.5f; },
              ", fisheye of 2 rad, principal point 0.5 0 off the centre, not at "}}) {
        const std::string message =
            after([&apply = change](RenderSettings&, Scene& scene) { apply(scene.cameras.front()); });
        EXPECT_NE(message.find(text), std::string::npos) << message;
    }
}

TEST_F(PictureIdentity, AnotherSceneIsAnother) {
    const std::string another = "it shows another scene, or another version of it";
    EXPECT_EQ(after([](RenderSettings&, Scene& scene) { scene.meshes.at(0).positions[0].x += 0x1p-10f; }),
              another);
    EXPECT_EQ(after([](RenderSettings&, Scene& scene) { scene.meshes.at(0).origin.x += 0x1p-10; }), another);
    const std::string another_frame = after([](RenderSettings&, Scene& scene) {
        add_shape(scene, Sphere{.center = dvec3(0), .radius = 0.01}, 0);
    });
    EXPECT_EQ(another_frame.rfind(another + ", its frame is origin ", 0), 0u) << another_frame;
    EXPECT_EQ(after([](RenderSettings&, Scene& scene) { scene.environment->radiance[0].x += 0.25f; }),
              another);
    EXPECT_EQ(after([](RenderSettings&, Scene& scene) { scene.environment->rotation += 0.1f; }), another);
    EXPECT_EQ(after([](RenderSettings&, Scene& scene) { scene.environment->visible ^= true; }), another);
    EXPECT_EQ(after([](RenderSettings&, Scene& scene) { scene.lights = {{"", PointLight{}}}; }), another);
    EXPECT_EQ(after([](RenderSettings&, Scene& scene) {
                  for (Shape& shape : scene.shapes) {
                      if (shape.emission) shape.emission->radiance.factor *= 1.01f;
                  }
              }),
              another);
}

TEST_F(PictureIdentity, WhatChangesNoSampleIsNoPartOfIt) {
    const auto expect_same = [&](const std::function<void(RenderSettings&)>& change) {
        EXPECT_EQ(after([&](RenderSettings& settings, Scene&) { change(settings); }), "");
    };
    expect_same([](RenderSettings& s) { s.first_sample = 64; });
    expect_same([](RenderSettings& s) { s.aovs = true; });
    expect_same([](RenderSettings& s) { s.scene_access = SceneAccess::storage_buffers; });
    expect_same([](RenderSettings& s) { s.submission_seconds = 1.0; });
    expect_same([](RenderSettings& s) { s.pass_growth = EVEN_PASS_GROWTH; });
}

TEST_F(PictureIdentity, AnImageCarriesIt) {
    Image image{.full = uvec2(40, 30), .data = {10, 20, 13, 22}, .channels = {}, .attributes = {}};
    set_identity(image, identity());
    EXPECT_EQ(difference(identity_of(image, "a.exr"), identity()), "");
    image.data.x1 = 14;
    EXPECT_EQ(difference(identity_of(image, "a.exr"), identity()),
              "its crop is 10,20,14,22, not 10,20,13,22");

    // Before there were filters and limits, there was this one filter, and no limit.
    Image older = image;
    older.data.x1 = 13;
    older.attributes.erase("candela.filter");
    older.attributes.erase("candela.clampIndirect");
    EXPECT_EQ(difference(identity_of(older, "a.exr"), identity()), "");

    const std::string remedy = "; give a file that candela render wrote, unchanged";
    for (const char* name :
         {"candela.identity", "candela.seed", "candela.sampler", "candela.estimator", "candela.lightSampler",
          "candela.terminator", "candela.maxDepth", "candela.rrDepth", "candela.camera"}) {
        Image without = image;
        without.attributes.erase(name);
        EXPECT_EQ(error_of([&] { identity_of(without, "a.exr"); }),
                  std::string("a.exr: the attribute ") + name + " is missing" + remedy);
    }
    image.attributes["candela.identity"] = std::string("12x");
    EXPECT_EQ(error_of([&] { identity_of(image, "a.exr"); }),
              "a.exr: the attribute candela.identity is \"12x\"" + remedy);
}

}  // namespace
}  // namespace candela
