// `candela bench`: how fast this program is on this device, and compared with Embree.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/printable.h"
#include "bench/build.h"
#include "bench/clocks.h"
#include "bench/first_pixel.h"
#include "bench/render.h"
#include "bench/tracer.h"
#include "bench/traversal.h"
#include "cli/bench_options.h"
#include "cli/bench_report.h"
#include "cli/command.h"
#include "cli/command_files.h"
#include "cli/console.h"
#include "cli/json_text.h"
#include "cli/loading.h"
#include "cli/vulkan.h"
#include "image/image_io.h"
#include "os/process.h"
#include "os/program.h"
#include "probe/scenes.h"
#include "session/version.h"
#include "vk/device.h"
#include "vk/instance.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

// How long a run of the group `render` lasts unless --spp is given [s].
constexpr double DEFAULT_SECONDS = 3.0;

// A run is limited by time unless the command line limits it by samples.
RenderTask make_task(const BenchArguments& arguments, const std::string& name, Scene scene) {
    RenderTask task{.name = name, .scene = std::move(scene)};
    task.settings = arguments.rendering.settings(task.scene, task.scene.cameras.front());
    task.spp = arguments.rendering.sampling.spp.value_or(MAX_SPP);
    task.seconds = arguments.seconds;
    if (!task.seconds && !arguments.rendering.sampling.spp) task.seconds = DEFAULT_SECONDS;
    return task;
}

std::vector<RenderTask> make_tasks(const BenchArguments& arguments) {
    std::vector<RenderTask> tasks;
    for (const std::string& file : arguments.scenes)
        tasks.push_back(make_task(arguments, file, load_with_progress(file, arguments.rendering.loading)));
    if (tasks.empty()) tasks.push_back(make_task(arguments, "Cornell box", cornell_box()));
    return tasks;
}

std::string size_text(uvec2 size) {
    return std::to_string(size.x) + 'x' + std::to_string(size.y);
}

// The colours of the reference of the only task. Throws Error if its size differs, or it lacks R, G or B.
RgbPlanes reference_planes(const std::string& file, const Image& image, const RenderTask& task) {
    const PixelRect& crop = task.settings.crop;
    const uvec2 size(crop.width(), crop.height()), found(image.data.width(), image.data.height());
    if (found != size) {
        throw Error(file + ": the reference has " + size_text(found) + " pixels, but " + task.name +
                    " is rendered with " + size_text(size) + "; use --size or --crop as for the reference");
    }
    const auto planes = image.find_rgb();
    if (!planes)
        throw Error(file + ": the reference lacks the channels R, G and B; render it with candela render");
    return *planes;
}

// Prints on stderr what is running: on a terminal, in a line that is cleared later; elsewhere, only if no
// table is printed.
void print_progress(const std::string& text, bool table) {
    const bool terminal = os::stderr_is_terminal();
    if (terminal) std::fputs("\r\x1b[K", stderr);
    if (text.empty() || !(terminal || !table)) return;
    std::fprintf(stderr, "%s%s", printable(text, MAX_PATH_BYTES).c_str(), terminal ? "" : "\n");
}

std::string rival_text() {
    return embree_version().value_or(
        "none; to compare with Embree, install libembree-dev and build with cmake -DCANDELA_EMBREE=ON");
}

void print_heading(const vk::DeviceInfo& device, const BenchOptions& options) {
    std::printf("candela %s bench\n", CANDELA_VERSION);
    std::printf("device   %u: %s (%s)\n", device.index, printable(device.name, MAX_NAME_BYTES).c_str(),
                vk::to_string(device.type));
    std::printf("driver   %s\n", printable(device.driver, MAX_NAME_BYTES).c_str());
    std::printf("system   %s, %.0f cores\n", os::system_text().c_str(), cores());
    std::printf("rival    %s\n\n", rival_text().c_str());
    std::printf("Median (least .. largest) of %u run(s); ratio: candela over Embree, run by run.\n",
                options.runs);
    if (works_on_cpu(device)) {
        std::printf(
            "Speeds are by CPU time, times the cores; times are CPU seconds. The median by wall time, which\n"
            "other work on the machine disturbs, is beside them.\n\n");
    } else {
        std::printf(
            "Rays and samples are by wall time, those of candela on the device, Embree's on all cores.\n"
            "Building and first images are by CPU time, with the median by wall time beside it.\n\n");
    }
}

Json settings_json(const BenchArguments& arguments, const RenderTask& task) {
    const RenderSettings& settings = task.settings;
    const std::optional<uint32_t>& spp = arguments.rendering.sampling.spp;
    return {{"runs", arguments.bench.runs},
            {"rays", arguments.bench.rays},
            {"triangles", arguments.bench.triangles},
            {"trees", arguments.bench.trees},
            {"instances", arguments.bench.instances},
            {"scene_buffers", name_of(arguments.bench.scene_access, SCENE_ACCESS_NAMES)},
            {"seconds", task.seconds ? Json(*task.seconds) : Json(nullptr)},
            {"spp", spp ? Json(*spp) : Json(nullptr)},
            {"reference", arguments.reference ? Json(*arguments.reference) : Json(nullptr)},
            {"width", settings.crop.width()},
            {"height", settings.crop.height()},
            {"max_depth", settings.max_depth},
            {"rr_depth", settings.rr_depth},
            {"estimator", name_of(settings.estimator, ESTIMATOR_NAMES)},
            {"sampler", name_of(settings.sampler, SAMPLER_NAMES)},
            {"light_sampler", name_of(settings.light_sampler, LIGHT_SAMPLER_NAMES)},
            {"terminator", name_of(settings.terminator, TERMINATOR_NAMES)},
            {"seed", settings.seed}};
}

Json report_json(const BenchArguments& arguments, const vk::DeviceInfo& device,
                 const std::vector<RenderTask>& tasks, const std::vector<BenchTable>& tables) {
    Json settings = Json::object();
    for (const RenderTask& task : tasks)
        settings[task.name] = settings_json(arguments, task);
    Json groups = Json::array();
    for (const BenchTable& table : tables)
        groups.push_back(to_json(table));
    return {{"version", CANDELA_VERSION},
            {"device", device.name},
            {"type", vk::to_string(device.type)},
            {"driver", device.driver},
            {"vulkan", vk::version_text(device.api_version)},
            {"system", os::system_text()},
            {"cores", uint32_t(cores())},
            {"clock", works_on_cpu(device) ? "cpu" : "wall"},
            {"embree", embree_version() ? Json(*embree_version()) : Json(nullptr)},
            {"settings", settings},
            {"groups", groups}};
}

// To a file, or to stdout for "-".
void write_json(const std::string& target, const Json& report) {
    const std::string text = json_text(report) + '\n';
    if (target != "-") return write_finished_work(target, text);
    std::printf("%s", text.c_str());
    flush_results();
}

std::vector<Row> run_group(BenchGroup group, const vk::Device& device, const BenchArguments& arguments,
                           const std::vector<RenderTask>& tasks) {
    std::vector<Row> rows;
    const auto append = [&rows](const std::vector<Row>& more) {
        rows.insert(rows.end(), more.begin(), more.end());
    };
    switch (group) {
        case BenchGroup::traversal:
            append(bench_traversal(device, arguments.bench));
            break;
        case BenchGroup::instances:
            append(bench_instances(device, arguments.bench));
            break;
        case BenchGroup::build:
            append(bench_build(arguments.bench));
            break;
        case BenchGroup::render:
            for (const RenderTask& task : tasks)
                append(bench_render(device, arguments.bench, task));
            break;
        case BenchGroup::first_pixel: {
            const auto program = os::program_file();
            const auto first_pixel = [&](const std::optional<std::filesystem::path>& scene) {
                append(bench_first_pixel(arguments.bench, program, scene, arguments.rendering.device.name));
            };
            for (const std::string& scene : arguments.scenes)
                first_pixel(scene);
            if (arguments.scenes.empty()) first_pixel(std::nullopt);
            break;
        }
    }
    return rows;
}

ExitCode bench(const BenchArguments& arguments) {
    const bool table = arguments.json != "-";
    CommandFiles files;
    for (const std::string& scene : arguments.scenes)
        files.read("SCENE", scene);
    if (arguments.reference) files.read("--reference", *arguments.reference);
    if (arguments.json) files.write("--json", *arguments.json);
    if (arguments.json && table) check_writable(*arguments.json);
    if (arguments.reference && arguments.scenes.size() > 1)
        throw Error("--reference: one image cannot be the reference of " +
                        std::to_string(arguments.scenes.size()) + " scenes; give one scene",
                    ErrorKind::request);
    std::vector<RenderTask> tasks = make_tasks(arguments);
    for (const RenderTask& task : tasks)
        files.read_all("the scene's file", task.scene.files);
    Image reference;  // The task refers to it.
    if (arguments.reference) {
        reference = read_exr(*arguments.reference, {.channels = {"R", "G", "B"}});
        tasks[0].reference = reference_planes(*arguments.reference, reference, tasks[0]);
    }

    const vk::Instance instance(instance_options());
    const std::vector<vk::DeviceInfo> devices = instance.devices();
    const vk::Device device(instance, vk::select_device(devices, arguments.rendering.device.name),
                            pipeline_cache_folder());
    BenchArguments told = arguments;
    told.bench.scene_access = arguments.rendering.device.scene_access;
    told.bench.progress = [table](const std::string& text) { print_progress(text, table); };
    if (table) print_heading(device.info(), told.bench);
    std::vector<BenchTable> tables;
    for (const BenchGroup group : told.only) {
        tables.push_back({name_of(group, BENCH_GROUP_NAMES), run_group(group, device, told, tasks)});
        print_progress("", table);
        if (table) std::printf("%s\n", table_text(tables.back()).c_str());
        flush_results();
    }
    if (arguments.json) write_json(*arguments.json, report_json(told, device.info(), tasks, tables));
    check_validation(instance);
    return ExitCode::done;
}

}  // namespace

Command add_bench_command(CLI::App& app) {
    CLI::App* const command =
        app.add_subcommand("bench", "Measure speed on this device; takes three minutes on a CPU");
    const auto arguments = std::make_shared<BenchArguments>();
    arguments->add_to(*command);
    command->footer(
        "traversal: only rays, in the Cornell box and in meshes; compared with Embree if built with it.\n"
        "instances: the same in a forest of trees, 100 000 triangles each; and building instances of a small "
        "mesh.\n"
        "build: pairing the triangles of those meshes and building their BVH, compared with Embree's over "
        "the\n"
        "triangles; both builders over the pairs, with the SAH cost; and all bytes on the device.\n"
        "render: samples per second and rays per sample of SCENE.\n"
        "first-pixel: all of `candela render SCENE --spp 1 --size 64x64`, with and without caches.\n"
        "relMSE: mean over pixels and channels of (x - r)^2 / (r^2 + 0.01 m^2), r the reference and m\n"
        "its mean.\n\n"
        "Example:\n"
        "  candela bench --only traversal --triangles 190k,1M,10M --json bench.json");
    return {command, [arguments] { return bench(*arguments); }};
}

}  // namespace candela
