// Where the tree over lights is chosen by itself: where it spares more noise than it costs time.
#include "gpu_scene/light_sampler_rule.h"

#include <gtest/gtest.h>

#include "gpu_scene/gpu_scene.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

// A floor of 2 m, and lamps.
struct Room {
    Scene scene = scene_with_camera(dvec3(0, 1, 5), dvec3(0), 1.0f);

    Room() {
        add_shape(scene, parallelogram(vec3(-1, 0, 1), vec3(2, 0, 0), vec3(0, 0, -2)),
                  add_diffuse(scene, vec3(0.5f)));
    }
    void add_sphere(dvec3 center, double radius, float radiance) {
        add_shape(scene, Sphere{center, radius}, 0, Emission{.radiance = vec3(radiance), .two_sided = true});
    }
    LightSampler chosen() const {
        return chosen_light_sampler(LightSampler::automatic, build_gpu_scene(scene));
    }
};

TEST(LightSamplerRule, ASingleLightIsNotChosen) {
    Room room;
    room.add_sphere({0, 1, 0}, 0.1, 1.0f);
    EXPECT_EQ(room.chosen(), LightSampler::power);
    EXPECT_EQ(chosen_light_sampler(LightSampler::uniform, build_gpu_scene(room.scene)), LightSampler::power);
}

// Both lamps send the same to the floor's middle, and about the same everywhere.
TEST(LightSamplerRule, PowerServesForLampsThatAreAlike) {
    Room room;
    room.add_sphere({-0.2, 3, 0}, 0.1, 1.0f);
    room.add_sphere({0.2, 3, 0}, 0.2, 0.25f);
    EXPECT_EQ(room.chosen(), LightSampler::power);
    EXPECT_EQ(chosen_light_sampler(LightSampler::tree, build_gpu_scene(room.scene)), LightSampler::tree);
}

// The sphere around the scene has 10^5 times the power of the lamp, and lights the floor as much as it does.
TEST(LightSamplerRule, TheTreeServesBesideALargeDimSphere) {
    Room room;
    room.add_sphere({0, 1, 0}, 0.1, 1.0f);
    room.add_sphere({0, 0, 0}, 50, 0.01f);
    EXPECT_EQ(room.chosen(), LightSampler::tree);
}

TEST(LightSamplerRule, TheTreeServesForALampNearbyBesideAStrongOneAfar) {
    Room room;
    room.add_sphere({0, 0.5, 0}, 0.01, 1.0f);
    room.add_sphere({0, 100, 0}, 1, 10.0f);
    EXPECT_EQ(room.chosen(), LightSampler::tree);
}

TEST(LightSamplerRule, TheTreeServesForManyLights) {
    Room room;
    for (int i = 0; i < 65; ++i)
        room.add_sphere({0.001 * i, 3, 0}, 0.1, 1.0f);
    EXPECT_EQ(room.chosen(), LightSampler::tree);
}

}  // namespace
}  // namespace candela
