// See traversal.h.
#include "bench/traversal.h"

#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "bench/meshes.h"
#include "probe/scenes.h"

namespace candela {
namespace {

// A run repeats its rays for about this long, so that the clocks' resolution and idle threads at its end do
// not matter.
constexpr double RUN_SECONDS = 0.1;
constexpr double MAX_REPEATS = 1000;

// One in this many rays may have a different hit in the rival.
constexpr size_t RAYS_PER_OTHER_HIT = 1000;

// A tracer with a set of rays, and its speed.
class Contender {
  public:
    // Traces the rays twice: some drivers compile the first time, and the second determines how often a run
    // repeats them.
    Contender(RayTracer& tracer, const RaySet& set) : tracer_(&tracer), rays_(double(set.rays.size())) {
        tracer_->prepare(set);
        tracer_->trace(1);
        const double seconds = tracer_->trace(1).wall;
        repeats_ = uint32_t(std::clamp(std::ceil(RUN_SECONDS / seconds), 1.0, MAX_REPEATS));
    }

    // Adds the speed of one run [Mrays/s].
    void run(bool by_cpu_time, std::vector<double>& values, std::vector<double>& wall_values) {
        const Clocks clocks = tracer_->trace(repeats_);
        const double millions = 1e-6 * rays_ * repeats_;
        values.push_back(millions / counted_seconds(clocks, by_cpu_time));
        if (by_cpu_time) wall_values.push_back(millions / clocks.wall);
    }

  private:
    RayTracer* tracer_;
    double rays_;
    uint32_t repeats_ = 1;
};

size_t count_differing(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.size(); ++i)
        count += a[i] != b[i];
    return count;
}

void add_rows(const vk::Device& device, const BenchOptions& options, const std::string& subject,
              const Scene& scene, const GpuScene& gpu, const BenchTriangles& triangles,
              std::vector<Row>& rows) {
    const auto ours = make_device_tracer(device, gpu, options.scene_access);
    const auto rival = make_embree_tracer(triangles);

    const auto triangle = [&](uint32_t id) { return triangles.at(id); };
    const auto closest_hits = [&](const RaySet& set) {
        ours->prepare(set);
        ours->trace(1);
        return ours->results();
    };
    size_t differing = 0, rays = 0;
    for (const RaySet& set : make_ray_sets(scene, triangle, triangles.bounds(), options.rays, closest_hits)) {
        rows.push_back(
            time_rays(subject, set, *ours, rival.get(), options.runs, works_on_cpu(device.info())));
        if (rival == nullptr) continue;
        const size_t others = count_differing(ours->results(), rival->results());
        check_same_hits(subject + ", " + set.name, others, set.rays.size());
        differing += others;
        rays += set.rays.size();
    }
    if (rival != nullptr)
        rows.push_back({subject,
                        "rays with another hit",
                        "of 10^6",
                        {1e6 * double(differing) / double(rays)},
                        {},
                        {},
                        {}});
}

void add_rows(const vk::Device& device, const BenchOptions& options, const std::string& name,
              const Scene& scene, std::vector<Row>& rows) {
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    const BenchTriangles triangles(gpu);
    const std::string subject = (name.empty() ? "" : name + ", ") + triangles_text(triangles.count());
    options.progress("traversal: " + subject);
    add_rows(device, options, subject, scene, gpu, triangles, rows);
}

// The time to make the records of a scene whose meshes have one tree each, and the bytes of each instance.
void add_build_rows(const BenchOptions& options, std::vector<Row>& rows) {
    const std::string subject = "scattered, " + std::to_string(options.instances) + " instances";
    options.progress("instances: " + subject);
    const Scene scene = scattered_scene(options.instances);
    Row seconds{.subject = subject, .what = "build", .unit = "s"};
    uint64_t bytes = 0;
    for (uint32_t run = 0; run < options.runs; ++run) {
        const Stopwatch watch;
        bytes = build_gpu_scene(scene, SceneFrame{}).bytes();
        const Clocks clocks = watch.elapsed();
        seconds.ours.push_back(clocks.cpu / cores());
        seconds.ours_wall.push_back(clocks.wall);
    }
    rows.push_back(seconds);
    rows.push_back({.subject = subject,
                    .what = "device memory",
                    .unit = "B/instance",
                    .ours = {double(bytes) / options.instances}});
}

}  // namespace

std::vector<Row> bench_traversal(const vk::Device& device, const BenchOptions& options) {
    std::vector<Row> rows;
    add_rows(device, options, "Cornell box", cornell_box(), rows);
    for (const uint32_t triangles : options.triangles)
        add_rows(device, options, "", displaced_scene(triangles), rows);
    return rows;
}

std::vector<Row> bench_instances(const vk::Device& device, const BenchOptions& options) {
    std::vector<Row> rows;
    const Scene scene = forest_scene(options.trees);
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    const BenchTriangles triangles(gpu);
    const std::string subject =
        std::to_string(options.trees) + " trees, " + triangles_text(triangles.count());
    options.progress("instances: " + subject);
    add_rows(device, options, subject, scene, gpu, triangles, rows);
    rows.push_back({.subject = subject,
                    .what = "device memory",
                    .unit = "MiB",
                    .ours = {double(gpu.bytes()) / (1 << 20)}});
    add_build_rows(options, rows);
    return rows;
}

Row time_rays(const std::string& subject, const RaySet& set, RayTracer& ours, RayTracer* rival, uint32_t runs,
              bool by_cpu_time) {
    Row row{.subject = subject, .what = set.name, .unit = "Mrays/s"};
    Contender us(ours, set);
    std::optional<Contender> them;
    if (rival != nullptr) them.emplace(*rival, set);
    for (uint32_t run = 0; run < runs; ++run) {
        us.run(by_cpu_time, row.ours, row.ours_wall);
        if (them) them->run(by_cpu_time, row.rival, row.rival_wall);
    }
    return row;
}

void check_same_hits(const std::string& what, size_t differing, size_t rays) {
    if (differing <= 1 + rays / RAYS_PER_OTHER_HIT) return;
    throw Error(concat(what, ": ", differing, " of ", rays,
                       " rays hit something else than in Embree, so the speeds cannot be compared; run "
                       "`candela selftest` on this device"));
}

}  // namespace candela
