// See build.h.
#include "bench/build.h"

#include <array>
#include <string>
#include <utility>
#include <variant>

#include "bench/meshes.h"
#include "bench/tracer.h"
#include "render/flatten.h"
#include "render/gpu_scene.h"
#include "scene/mesh.h"

namespace candela {
namespace {

// What Embree is told: it never splits ranges of up to `whole`.
struct Rival {
    uint32_t whole;
    const char* name;
};
constexpr std::array<Rival, 2> RIVALS{{{1, "finer rival"}, {BVH_LEAF_SIZE, "like leaves"}}};

TimedBvh build_ours(std::span<const Box> boxes) {
    const Stopwatch watch;
    Bvh bvh = build_bvh(boxes);
    return {std::move(bvh), watch.elapsed()};
}

void add_speed(const Clocks& clocks, size_t triangles, std::vector<double>& values,
               std::vector<double>& wall_values) {
    const double millions = 1e-6 * double(triangles);
    values.push_back(millions * cores() / clocks.cpu);
    wall_values.push_back(millions / clocks.wall);
}

// Speed and cost beside one rival, which may be missing.
void add_builds(const std::string& subject, std::span<const Box> boxes, const Rival& rival, uint32_t runs,
                std::vector<Row>& rows) {
    const std::string beside = embree_version() ? std::string(", ") + rival.name : "";
    Row speed{.subject = subject, .what = "build" + beside, .unit = "Mtri/s"};
    Row cost{.subject = subject, .what = "SAH cost" + beside};
    for (uint32_t run = 0; run <= runs; ++run) {
        const TimedBvh ours = build_ours(boxes);
        const std::optional<TimedBvh> theirs = build_with_embree(boxes, rival.whole, BVH_LEAF_SIZE);
        if (run == 0) {  // A warm-up. The trees are always the same.
            cost.ours.push_back(double(ours.bvh.sah_cost));
            if (theirs) cost.rival.push_back(double(theirs->bvh.sah_cost));
            continue;
        }
        add_speed(ours.clocks, boxes.size(), speed.ours, speed.ours_wall);
        if (theirs) add_speed(theirs->clocks, boxes.size(), speed.rival, speed.rival_wall);
    }
    rows.push_back(speed);
    rows.push_back(cost);
}

double bytes_per_triangle(Scene scene) {
    for (Shape& shape : scene.shapes) {
        if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) smooth_normals(*mesh);
    }
    const GpuScene gpu = build_gpu_scene(scene);
    return double(gpu.bytes()) / gpu.primitive_count;
}

}  // namespace

std::vector<Row> bench_build(const BenchOptions& options) {
    std::vector<Row> rows;
    for (const uint32_t triangles : options.triangles) {
        Scene scene = displaced_scene(triangles);
        std::vector<Box> boxes;
        for (const Primitive& primitive : flatten(scene).primitives)
            boxes.push_back(bounds(primitive));
        const std::string subject = triangles_text(boxes.size());
        options.progress("build: " + subject);
        for (const Rival& rival : std::span(RIVALS).first(embree_version() ? RIVALS.size() : 1))
            add_builds(subject, boxes, rival, options.runs, rows);
        rows.push_back({.subject = subject,
                        .what = "device memory",
                        .unit = "B/triangle",
                        .ours = {bytes_per_triangle(std::move(scene))}});
    }
    return rows;
}

}  // namespace candela
