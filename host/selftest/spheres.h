// Tests that rays which leave round shapes do not hit them again at their origin, and that rays inside a
// sphere do not escape.
#pragma once

#include "selftest/effort.h"
#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// Spheres of all sizes, at the origin and far from it. A ray that leaves the outside does not hit the sphere
// again.
Evidence test_rays_outside_spheres(const vk::Device& device, Effort effort);
// A ray that enters, or is reflected inside, hits the far side.
Evidence test_rays_within_spheres(const vk::Device& device, Effort effort);
// Hit points are on the sphere within their stated error, and have its normal.
Evidence test_points_on_spheres(const vk::Device& device, Effort effort);
// A ray that leaves a disk does not hit it again.
Evidence test_rays_at_disks(const vk::Device& device, Effort effort);

}  // namespace candela
