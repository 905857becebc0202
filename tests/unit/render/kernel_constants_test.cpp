// The constants that kernels are compiled with, and who sets them.
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "unit/gpu_scene/packed_scene.h"

namespace candela {
namespace {

// So identities, which use these constants alone, are the same on every device.
TEST(KernelConstants, WhatTheDeviceSetsHasItsDefaultUntilThereIsOne) {
    Scene scene = scene_of_shapes({emitter(SQUARE, vec3(1))});
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(1), vec3(2)}, .visible = false};
    RenderSettings settings;
    settings.estimator = Estimator::light;
    settings.sampler = SamplerKind::independent;
    const KernelConstants constants = make_constants(build_gpu_scene(scene), Camera{}, settings);
    for (const ConstantEntry& entry : CONSTANT_ENTRIES) {
        if (entry.owner != ConstantOwner::device) continue;
        EXPECT_EQ(constants[entry.number], entry.initial) << entry.number;
    }
    EXPECT_EQ(constants[CONSTANT_ENVIRONMENT], ENVIRONMENT_HIDDEN);
    EXPECT_EQ(constants[CONSTANT_ESTIMATOR], ESTIMATOR_LIGHT);
    EXPECT_EQ(constants[CONSTANT_SAMPLER], SAMPLER_INDEPENDENT);
}

// A box of one pixel is the pixel itself, whoever asks for it, with the code for that.
TEST(KernelConstants, OnlyOtherFiltersThanThePixelHaveCode) {
    const GpuScene scene = build_gpu_scene(scene_of_shapes({emitter(SQUARE, vec3(1))}));
    RenderSettings settings;
    const auto filter = [&](const PixelFilter& wanted) {
        settings.filter = wanted;
        return make_constants(scene, Camera{}, settings)[CONSTANT_PIXEL_FILTER];
    };
    EXPECT_EQ(filter({}), PIXEL_FILTER_SQUARE);
    EXPECT_EQ(filter({FilterShape::box, 1.0f}), PIXEL_FILTER_SQUARE);
    EXPECT_EQ(filter({FilterShape::box, 2.0f}), PIXEL_FILTER_BOX);
    EXPECT_EQ(filter({FilterShape::tent, 1.0f}), PIXEL_FILTER_TENT);
    EXPECT_EQ(make_constants(scene, Camera{}, settings)[CONSTANT_CLAMP_INDIRECT], 0u);
}

TEST(KernelConstants, AreNumberedInTheOrderOfTheList) {
    for (uint32_t i = 0; i < CONSTANT_COUNT; ++i)
        EXPECT_EQ(CONSTANT_ENTRIES[i].number, i);
    for (uint32_t i = 0; i < ARRAY_COUNT; ++i)
        EXPECT_EQ(SCENE_ARRAYS[i].number, i);
    EXPECT_EQ(CONSTANT_SLOT_NODES + BUFFER_COUNT, CONSTANT_DENOISING_LAYER);  // Which follows them.
}

}  // namespace
}  // namespace candela
