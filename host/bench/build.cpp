// See build.h.
#include "bench/build.h"

#include <string>
#include <utility>

#include "bench/meshes.h"
#include "bench/tracer.h"
#include "bench/triangles.h"
#include "gpu_scene/flatten.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/triangle_pairs.h"
#include "scene/geometry.h"
#include "scene/mesh.h"

namespace candela {
namespace {

TimedBvh build_ours(std::span<const Box> boxes) {
    const Stopwatch watch;
    Bvh bvh = build_bvh(boxes);
    return {std::move(bvh), watch.elapsed()};
}

// The time to pair the triangles of a scene.
Clocks time_pairing(const Scene& scene) {
    const Stopwatch watch;
    for (const TriangleMesh& mesh : scene.meshes)
        pair_triangles(mesh);
    return watch.elapsed();
}

void add_speed(const Clocks& clocks, size_t triangles, std::vector<double>& values,
               std::vector<double>& wall_values) {
    const double millions = 1e-6 * double(triangles);
    values.push_back(millions * cores() / clocks.cpu);
    wall_values.push_back(millions / clocks.wall);
}

// Adds the speed and cost of the trees over a scene's triangles.
void add_builds(const std::string& subject, const Scene& scene, uint32_t runs, std::vector<Row>& rows) {
    std::vector<Box> triangles, pairs;
    for (const Primitive& p : flatten(scene, SceneFrame{}).primitives) {
        pairs.push_back(bounds(p));
        for (const auto& [b, c] : {std::pair(p.b, p.c), std::pair(p.c, p.d)}) {
            if (b == c) continue;  // There is no second triangle.
            triangles.emplace_back();
            for (const vec3 corner : {p.a, b, c})
                triangles.back().extend(corner);
        }
    }

    Row whole{.subject = subject, .what = "pairs and tree", .unit = "Mtri/s"};
    Row speed{.subject = subject, .what = "tree over pairs", .unit = "Mtri/s"};
    Row cost{.subject = subject, .what = "SAH cost of it"};
    for (uint32_t run = 0; run <= runs; ++run) {
        const Clocks pairing = time_pairing(scene);
        const TimedBvh ours = build_ours(pairs);
        const std::optional<TimedBvh> theirs = build_with_embree(pairs);
        const std::optional<TimedBvh> of_triangles = build_with_embree(triangles);
        if (run == 0) {  // A warm-up. The trees are always the same.
            cost.ours.push_back(double(ours.bvh.sah_cost));
            if (theirs) cost.rival.push_back(double(theirs->bvh.sah_cost));
            continue;
        }
        const Clocks both{.cpu = pairing.cpu + ours.clocks.cpu, .wall = pairing.wall + ours.clocks.wall};
        add_speed(both, triangles.size(), whole.ours, whole.ours_wall);
        if (of_triangles) add_speed(of_triangles->clocks, triangles.size(), whole.rival, whole.rival_wall);
        add_speed(ours.clocks, triangles.size(), speed.ours, speed.ours_wall);
        if (theirs) add_speed(theirs->clocks, triangles.size(), speed.rival, speed.rival_wall);
    }
    rows.insert(rows.end(), {whole, speed, cost});
}

double bytes_per_triangle(Scene scene) {
    for (TriangleMesh& mesh : scene.meshes)
        smooth_normals(mesh);
    const GpuScene gpu = build_gpu_scene(scene);
    return double(gpu.bytes()) / gpu.id_count;
}

}  // namespace

std::vector<Row> bench_build(const BenchOptions& options) {
    std::vector<Row> rows;
    for (const uint32_t triangles : options.triangles) {
        Scene scene = displaced_scene(triangles);
        const std::string subject = triangles_text(triangle_count(scene));
        options.progress("build: " + subject);
        add_builds(subject, scene, options.runs, rows);
        rows.push_back({.subject = subject,
                        .what = "device memory",
                        .unit = "B/triangle",
                        .ours = {bytes_per_triangle(std::move(scene))}});
    }
    return rows;
}

}  // namespace candela
