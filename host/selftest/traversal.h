// Rays, and their hits on the device by the BVH and by brute force.
#pragma once

#include <vector>

#include "probe/probe.h"
#include "probe/probes.h"
#include "selftest/effort.h"
#include "selftest/evidence.h"

namespace candela {

inline constexpr float NO_HIT = 3.4028234e38f;  // FLOAT_MAX of base/math.glsl.

using Rays = std::vector<RayItem>;

void add(Rays& rays, vec3 o, vec3 d);

// From random points of a cube around `centre` of edge 2 `size`, in random directions.
Rays random_rays(size_t count, vec3 centre, float size, uint32_t seed);

// From random points of that cube towards vertices, midpoints of edges and centroids of random triangles.
Rays rays_at_features(const TriangleMesh& mesh, size_t count, vec3 centre, float size, uint32_t seed);

// `access` is not `automatic`.
std::vector<TraversalResult> trace(const vk::Device& device, const GpuScene& scene, const Rays& rays,
                                   SceneAccess access);

// Every ray must have the same hit as by brute force, and be occluded from its hit on, but not before.
Evidence compare_with_brute_force(const std::vector<TraversalResult>& results);

// Rays from inside closed meshes, towards vertices and edges and along the axes, at three scales and far from
// the origin, where floats are coarse: every ray has a hit, and the same as by brute force, through either
// kind of buffer.
Evidence test_closed_meshes(const vk::Device& device, Effort effort);

// The same for a nasty_mesh(), where rays may miss.
Evidence test_nasty_mesh(const vk::Device& device, Effort effort);

size_t hits(const std::vector<TraversalResult>& results);

}  // namespace candela
