// Tests of whole images on the device: closed forms, estimators against each other, identical bits, an
// independent renderer.
#pragma once

#include "selftest/effort.h"
#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// A closed box that emits radiance 1 and reflects a: every ray sees 1 / (1 - a), for a from 0 to 0.95.
Evidence test_furnace(const vk::Device& device, Effort effort);

// The estimators bsdf, light and mis have the same expectation in a room of several materials and kinds of
// light.
Evidence test_estimators(const vk::Device& device, Effort effort);

// The same samples give the same bits however the work is cut and however the scene is read.
Evidence test_identical_bits(const vk::Device& device);

// The Cornell box agrees with an independent renderer's.
Evidence test_cornell_box(const vk::Device& device, Effort effort);

}  // namespace candela
