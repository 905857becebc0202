// Tests warps on the device: points and directions are distributed according to their densities.
#pragma once

#include <vector>

#include "probe/probes.h"
#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// Applies all warps to 400 000 random points of the unit square.
std::vector<WarpResult> run_warps(const vk::Device& device, uint32_t seed, const WarpItem& parameters = {});

// Disk, cosine-weighted hemisphere, triangle.
Evidence test_basic_warps(const vk::Device& device);
// Powers of the cosine, with exponents from 0 to 10^5.
Evidence test_power_cosines(const vk::Device& device);
// The sphere, and cones from narrow ones to the whole sphere.
Evidence test_sphere_and_cones(const vk::Device& device);
// Regular polygons of 3 to 64 corners.
Evidence test_polygons(const vk::Device& device);
// Filters of pixels.
Evidence test_pixel_filters(const vk::Device& device);
// Visible normals of GGX for three views and roughnesses.
Evidence test_visible_normals(const vk::Device& device);

}  // namespace candela
