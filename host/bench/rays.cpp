// See rays.h.
#include "bench/rays.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "probe/random.h"
#include "render/renderer.h"
#include "shared/constants.h"

namespace candela {
namespace {

// Bounces start above the surface by this fraction of the scene's extent: a hundred times the rounding of its
// coordinates, so that no tracer hits the surface that a ray leaves.
constexpr double START_ABOVE = 1e-5;
// Shadow rays end before the light by this fraction of their length.
constexpr float END_BEFORE = 1e-3f;

std::vector<BenchRay> primary_rays(const Camera& camera, uint32_t count, Random& random) {
    const auto tiles = uint32_t(std::ceil(std::sqrt(double(count)) / WORKGROUP_SIZE));
    const uint32_t edge = tiles * WORKGROUP_SIZE;
    const RenderSettings settings{.size = {edge, edge}, .crop = {0, 0, edge, edge}};
    const Parameters view = make_parameters(GpuScene{}, camera, settings);
    std::vector<BenchRay> rays;
    rays.reserve(size_t{edge} * edge);
    for (uint32_t i = 0; i < edge * edge; ++i) {
        const uint32_t tile = i / (WORKGROUP_SIZE * WORKGROUP_SIZE);
        const uvec2 in_tile(i % WORKGROUP_SIZE, i / WORKGROUP_SIZE % WORKGROUP_SIZE);
        const uvec2 pixel = WORKGROUP_SIZE * uvec2(tile % tiles, tile / tiles) + in_tile;
        const vec2 p = 2.0f * (vec2(pixel) + random.square()) / float(edge) - 1.0f;
        rays.push_back({view.position, INFINITE, normalize(view.forward + p.x * view.right - p.y * view.up)});
    }
    return rays;
}

// Where a ray hits the plane of its triangle, moved slightly off the surface, and the unit normal there, both
// on the ray's side.
struct Vertex {
    vec3 p;
    vec3 n;
};

Vertex vertex_of(const BenchRay& ray, const BenchTriangle& triangle, double above) {
    const dvec3 o(ray.o), d(ray.d), a(triangle.a);
    dvec3 n = normalize(cross(dvec3(triangle.b) - a, dvec3(triangle.c) - a));
    if (dot(n, d) > 0.0) n = -n;
    const double t = dot(a - o, n) / dot(d, n);
    return {vec3(o + t * d + above * n), vec3(n)};
}

// The vertices at the hits of a set; rays that miss have none.
std::vector<Vertex> vertices_of(const RaySet& set, const TriangleById& triangle, double above,
                                const ClosestHits& trace) {
    const std::vector<uint32_t> hits = trace(set);
    std::vector<Vertex> vertices;
    vertices.reserve(hits.size());
    for (size_t i = 0; i < hits.size(); ++i) {
        if (hits[i] != NO_TRIANGLE) vertices.push_back(vertex_of(set.rays[i], triangle(hits[i]), above));
    }
    return vertices;
}

// The normal plus a random point of the unit sphere is distributed by the cosine.
std::vector<BenchRay> bounces(const std::vector<Vertex>& vertices, Random& random) {
    std::vector<BenchRay> rays;
    rays.reserve(vertices.size());
    for (const Vertex& vertex : vertices)
        rays.push_back({vertex.p, INFINITE, normalize(vertex.n + random.direction())});
    return rays;
}

std::vector<BenchRay> shadow_rays(const std::vector<Vertex>& vertices, const Quad& light, Random& random) {
    const vec3 corner(light.corners[0]);
    const vec3 e1(light.corners[1] - light.corners[0]);
    const vec3 e2(light.corners[3] - light.corners[0]);
    std::vector<BenchRay> rays;
    rays.reserve(vertices.size());
    for (const Vertex& vertex : vertices) {
        const vec2 u = random.square();
        const vec3 to_light = corner + u.x * e1 + u.y * e2 - vertex.p;
        const float distance = length(to_light);
        rays.push_back({vertex.p, (1.0f - END_BEFORE) * distance, to_light / distance});
    }
    return rays;
}

const Quad& light_of(const Scene& scene) {
    const auto shape =
        std::ranges::find_if(scene.shapes, [](const Shape& s) { return s.emission.has_value(); });
    assert(shape != scene.shapes.end());
    return std::get<Quad>(shape->geometry);
}

}  // namespace

std::vector<RaySet> make_ray_sets(const Scene& scene, const TriangleById& triangle, const Box& bounds,
                                  uint32_t count, const ClosestHits& trace) {
    Random random(1);
    const vec3 extent = bounds.extent();
    const double above = START_ABOVE * double(std::max({extent.x, extent.y, extent.z}));
    RaySet primary{.name = "primary rays", .coherent = true, .rays = {}};
    primary.rays = primary_rays(scene.cameras.front(), count, random);
    const std::vector<Vertex> seen = vertices_of(primary, triangle, above, trace);
    RaySet first{.name = "first bounce", .rays = bounces(seen, random)};
    RaySet second{.name = "second bounce",
                  .rays = bounces(vertices_of(first, triangle, above, trace), random)};
    RaySet shadow{.name = "shadow rays", .any_hit = true, .rays = shadow_rays(seen, light_of(scene), random)};
    std::vector<RaySet> sets;
    for (RaySet* set : {&primary, &first, &second, &shadow})
        sets.push_back(std::move(*set));
    return sets;
}

}  // namespace candela
