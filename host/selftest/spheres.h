// Rays that leave round shapes do not meet them again where they began, and rays within a sphere do not slip
// out.
#pragma once

#include "selftest/effort.h"
#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// Spheres of all sizes, at the origin and far from it. A ray that leaves the outside does not meet the sphere
// again.
Evidence test_rays_outside_spheres(const vk::Device& device, Effort effort);
// A ray that goes in, or is reflected within, meets the far side.
Evidence test_rays_within_spheres(const vk::Device& device, Effort effort);
// Points of hits are on the sphere within the error that they state, and have its normal.
Evidence test_points_on_spheres(const vk::Device& device, Effort effort);
// A ray that leaves a disk does not meet it again.
Evidence test_rays_at_disks(const vk::Device& device, Effort effort);

}  // namespace candela
