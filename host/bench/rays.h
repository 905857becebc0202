// The rays that all tracers are timed with: those of a path tracer, of one kind at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/meshes.h"
#include "scene/scene.h"

namespace candela {

// A ray as the kernels read it, two texels. World space [m]; d is of unit length.
struct BenchRay {
    vec3 o;
    float t_max;  // Hits count below it.
    vec3 d;
    float unused = 0.0f;
};
static_assert(sizeof(BenchRay) == 32);

// What a tracer answers to a ray that meets nothing. To one that does, it answers with the triangle's
// the position in triangles_of(), or, where any hit will do, with ANY_HIT.
inline constexpr uint32_t NO_TRIANGLE = 0xFFFFFFFFu;
inline constexpr uint32_t ANY_HIT = 0u;

struct RaySet {
    std::string name;       // "primary rays".
    bool any_hit = false;   // Any hit will do; else the closest is asked for.
    bool coherent = false;  // Neighbours are alike.
    std::vector<BenchRay> rays;
};

// The closest hits of rays.
using ClosestHits = std::function<std::vector<uint32_t>(const RaySet&)>;

// Four sets, each from what the ones before it hit in `triangles` (the scene's, by id), as `trace` says:
// primary rays, one through a random point of each pixel of a square picture of at least `count` pixels and
// of whole tiles; the first and the second bounce of those, by the cosine; and shadow rays from the hits of
// the primary rays to random points of the first emitting quad, which the scene must have. Rays stand in the
// order of pixels: tiles of 8x8, row-major, as are the pixels of each, so that neighbours are as alike as a
// renderer's. Random numbers have a fixed seed.
std::vector<RaySet> make_ray_sets(const Scene& scene, std::span<const BenchTriangle> triangles,
                                  uint32_t count, const ClosestHits& trace);

}  // namespace candela
