// The rays with which all tracers are timed: the rays of a path tracer, one kind at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/triangles.h"
#include "scene/scene.h"

namespace candela {

// A ray as the kernels read it, two texels. World space [m]; d is of unit length.
struct BenchRay {
    vec3 o;
    float t_max;  // Only hits below it count.
    vec3 d;
    float unused = 0.0f;
};
static_assert(sizeof(BenchRay) == 32);

// A tracer's result for a ray that misses. For a hit, it is the triangle's id or, if any hit suffices,
// ANY_HIT.
inline constexpr uint32_t NO_TRIANGLE = 0xFFFFFFFFu;
inline constexpr uint32_t ANY_HIT = 0u;

struct RaySet {
    std::string name;       // "primary rays".
    bool any_hit = false;   // Any hit suffices; otherwise the closest is needed.
    bool coherent = false;  // Neighbouring rays are similar.
    std::vector<BenchRay> rays;
};

// The closest hits of rays.
using ClosestHits = std::function<std::vector<uint32_t>(const RaySet&)>;
// A triangle by its id.
using TriangleById = std::function<BenchTriangle(uint32_t)>;

// Four sets, each made from the hits of the sets before it, which `trace` finds. `bounds` is the box around
// all triangles. They are: primary rays, one through a random point of each pixel of a square picture of at
// least `count` pixels and of whole tiles; their first and second bounces, distributed by the cosine; and
// shadow rays from the hits of the primary rays to random points of the first emitting quad, which the scene
// must have. Rays are in the order of pixels: tiles of 8x8, row-major, as are the pixels of each, so that
// neighbours are as alike as in a renderer. Random numbers have a fixed seed.
std::vector<RaySet> make_ray_sets(const Scene& scene, const TriangleById& triangle, const Box& bounds,
                                  uint32_t count, const ClosestHits& trace);

}  // namespace candela
