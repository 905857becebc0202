// See render.h.
#include "bench/render.h"

#include "bench/clocks.h"
#include "image/relative_error.h"

namespace candela {
namespace {

// A run of limited time is cut into at least this many submissions, so that it ends in time. None is longer
// than on a GPU.
constexpr double SUBMISSIONS = 50.0;
constexpr double LONGEST_SUBMISSION = 0.075;

struct Outcome {
    Clocks clocks;
    uint64_t samples = 0;
    uint64_t rays = 0;
    double relmse = 0.0;  // If there is a reference.
};

Outcome run_once(const vk::Device& device, const GpuScene& scene, const RenderTask& task,
                 const RenderSettings& settings) {
    const bool by_cpu_time = works_on_cpu(device.info());
    Renderer renderer(device, scene, task.scene.cameras.front(), settings);
    const Stopwatch watch;
    renderer.render(task.spp, [&](double) {
        return !task.seconds || counted_seconds(watch.elapsed(), by_cpu_time) < *task.seconds;
    });
    Outcome outcome{.clocks = watch.elapsed()};
    const Accumulation state = renderer.download();
    outcome.samples = state.total_samples();
    outcome.rays = renderer.counters().rays;
    if (task.reference) outcome.relmse = relative_mse(*make_image(state, {}, {}).find_rgb(), *task.reference);
    return outcome;
}

}  // namespace

std::vector<Row> bench_render(const vk::Device& device, const BenchOptions& options, const RenderTask& task) {
    options.progress("render: " + task.name);
    const bool by_cpu_time = works_on_cpu(device.info());
    const GpuScene scene = build_gpu_scene(task.scene);
    RenderSettings settings = task.settings;
    if (task.seconds) {
        settings.submission_seconds = std::min(LONGEST_SUBMISSION, *task.seconds / SUBMISSIONS);
        settings.pass_growth = EVEN_PASS_GROWTH;
    }

    Row speed{.subject = task.name, .what = "samples", .unit = "Msamples/s"};
    Row rays{.subject = task.name, .what = "rays per sample"};
    Row relmse{.subject = task.name, .what = "relMSE"};
    for (uint32_t run = 0; run < options.runs; ++run) {
        const Outcome outcome = run_once(device, scene, task, settings);
        ++settings.seed;
        const double millions = 1e-6 * double(outcome.samples);
        speed.ours.push_back(millions / counted_seconds(outcome.clocks, by_cpu_time));
        if (by_cpu_time) speed.ours_wall.push_back(millions / outcome.clocks.wall);
        rays.ours.push_back(double(outcome.rays) / double(outcome.samples));
        relmse.ours.push_back(outcome.relmse);
    }
    std::vector<Row> rows{speed, rays};
    if (task.reference) rows.push_back(relmse);
    return rows;
}

}  // namespace candela
