// What kernels are compiled for, and who says so.
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "unit/packed_scene.h"

namespace candela {
namespace {

// So that identities, which ask for these constants alone, are the same on every device.
TEST(KernelConstants, WhatTheDeviceSetsHasItsDefaultUntilThereIsOne) {
    Scene scene = scene_of({emitter(SQUARE, vec3(1))});
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(1), vec3(2)}, .visible = false};
    RenderSettings settings;
    settings.estimator = Estimator::light;
    settings.sampler = SamplerKind::independent;
    const KernelConstants constants = make_constants(build_gpu_scene(scene), Camera{}, settings);
    const KernelConstants defaults;
    for (uint32_t i = 0; i < CONSTANT_COUNT; ++i) {
        if (CONSTANT_OWNERS[i] != ConstantOwner::DEVICE) continue;
        EXPECT_EQ(constants.values[i], defaults.values[i]) << i;
    }
    EXPECT_EQ(constants[CONSTANT_ENVIRONMENT], ENVIRONMENT_HIDDEN);
    EXPECT_EQ(constants[CONSTANT_ESTIMATOR], ESTIMATOR_LIGHT);
    EXPECT_EQ(constants[CONSTANT_SAMPLER], SAMPLER_INDEPENDENT);
}

}  // namespace
}  // namespace candela
