// Tests the sky on the device: the positions of its texels, and light samples of them.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "selftest/effort.h"
#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// A scene under that sky, with one shape far below, which hides hardly any of the sky.
Scene scene_under(const Environment& environment);

// The device's result for a direction.
struct SkyTexel {
    vec3 radiance;
    float pdf;
};
std::vector<SkyTexel> look_up(const vk::Device& device, const Environment& sky,
                              const std::vector<vec3>& directions);

// Skies of several sizes: every direction has the texel that the convention prescribes.
Evidence test_sky_lookup(const vk::Device& device);

// Texels are sampled in proportion to luminance above the mean times solid angle, and within a texel
// uniformly over its solid angle.
Evidence test_sky_samples(const vk::Device& device, Effort effort);

// The sky and another light are chosen by their power.
Evidence test_choice_of_sky(const vk::Device& device, Effort effort);

}  // namespace candela
