// Tests light samples on the device against their distributions, densities and radiance.
#pragma once

#include <string>
#include <vector>

#include "probe/probe.h"
#include "probe/probes.h"
#include "selftest/effort.h"
#include "selftest/evidence.h"

namespace candela {

// Light samples of a scene. `access` is not `automatic`.
std::vector<LightSample> sample_lights(const vk::Device& device, const GpuScene& scene,
                                       const std::vector<LightItem>& items,
                                       SceneAccess access = SceneAccess::texel_buffers);

// `count` items with random bits, all from one point.
std::vector<LightItem> random_light_items(vec3 from, size_t count, uint32_t seed);

// Flat lights, one in each of the planes z = 0, 1, 2, ...: parallelograms and triangles of very different
// power.
Scene scene_of_flat_lights();
// Lights are chosen by their power, and points uniformly by area.
Evidence test_flat_light_points(const vk::Device& device, Effort effort);
// Samples have the right radiance and density, and their shadow rays end just before the light.
Evidence test_flat_light_values(const vk::Device& device, SceneAccess access);

// Spheres are sampled uniformly over the solid angle that they subtend, from inside over their area; disks
// over their area. Densities and radiance match the points, and nothing occludes them.
Evidence test_spheres_from_outside(const vk::Device& device, Effort effort);
Evidence test_spheres_from_inside(const vk::Device& device, Effort effort);
Evidence test_disks(const vk::Device& device, Effort effort);

// Point, spot and directional lights, beside an emitter and alone, are chosen by their power; their samples
// have the light that arrives, and a pdf that says that nothing else finds them; a square in between hides
// them.
Evidence test_punctual_lights(const vk::Device& device, Effort effort);

}  // namespace candela
