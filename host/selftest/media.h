// Tests on the device how far light comes in media.
#pragma once

#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// Distances must follow their density, and weights be transmittance over density, times scattering; through
// optical depths from 10^-3 to 80, in media and for paths of any colour.
Evidence test_distances(const vk::Device& device);

}  // namespace candela
