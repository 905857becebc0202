// Declares the options of `candela render` and combines them with what the scene file says.
#include "cli/render_options.h"

#include <algorithm>
#include <cmath>

#include "base/image_io.h"
#include "base/printable.h"
#include "cli/loading.h"
#include "shared/constants.h"

namespace candela {

static std::optional<uint32_t> parse_spp(const std::string& text) {
    return parse_uint(text, 1, MAX_SPP);
}

static std::optional<uint32_t> parse_seed(const std::string& text) {
    return parse_uint(text, 0, UINT32_MAX);
}

static std::optional<uint32_t> parse_depth(const std::string& text) {
    return parse_uint(text, 0, DEPTH_SAFETY_LIMIT);
}

static std::optional<uint32_t> parse_max_depth(const std::string& text) {
    return text == "unlimited" ? DEPTH_SAFETY_LIMIT : parse_depth(text);
}

static_assert(MAX_EXPOSURE_EV == 100.0f, "the message on --exposure says so");

static std::optional<double> parse_exposure(const std::string& text) {
    const auto value = parse_number(text);
    return value && std::abs(*value) <= double(MAX_EXPOSURE_EV) ? value : std::nullopt;
}

static std::optional<double> parse_error(const std::string& text) {
    const auto value = parse_number(text);
    return value && *value > 0.0 ? value : std::nullopt;
}

static constexpr const char* DURATIONS = "a duration such as 90, 90s, 1.5m or 2h";
static constexpr const char* SAMPLING_GROUP = "Sampling (defaults: the scene's)";

void RenderOptions::add_to(CLI::App& app) {
    app.option_defaults()->take_last();  // Later options override a script's.
    app.add_option("SCENE", scene_file, SCENE_FILES)->required()->type_name("");
    add_output_options(app);
    add_rendering_to(app);
    add_camera_to(app);
    app.option_defaults()->group(SAMPLING_GROUP);
    add_value(app, "--target-error", target_error, parse_error, "a number above 0, such as 0.02",
              "Stop at this estimated relative error, such as 0.02; --spp is the maximum")
        ->type_name("E");
    add_value(app, "--time-limit", time_limit, parse_duration, DURATIONS,
              "Stop after 90, 90s, 1.5m or 2h, even before --spp (default: never)")
        ->type_name("TIME");
    add_value(app, "--samples", samples, parse_samples, SAMPLES_EXPECTED,
              "Render only the samples A to B-1, as a part for candela merge")
        ->type_name("A..B")
        ->excludes(app.get_option("--spp"));
    app.add_flag("--adaptive", adaptive,
                 "Put samples where the error is; --spp is their mean, and must be even")
        ->excludes(app.get_option("--samples"));
    add_checkpoint_options(app);
    add_message_options(app);
}

void RenderOptions::add_rendering_to(CLI::App& app) {
    app.option_defaults()->group("Picture");
    picture.add_to(app);
    loading.add_to(app);
    add_sampling_options(app);
    app.option_defaults()->group("Device");
    app.add_option("--device", device, "Index or part of the name (default: the best; see candela devices)")
        ->type_name("D");
    add_choice(app, "--scene-buffers", scene_access, SCENE_ACCESS_NAMES,
               "How kernels read the scene; the image is the same (default: auto)");
}

void RenderOptions::add_development_to(CLI::App& app) {
    add_value(app, "--exposure", images.exposure, parse_exposure, "a number from -100 to 100",
              "PNG: multiply by 2^EV before the tone map (default: 0)")
        ->type_name("EV");
    add_choice(app, "--tonemap", images.tonemap, TONEMAP_NAMES,
               "PNG: tone map (default: linear, which clamps)");
}

void RenderOptions::add_camera_to(CLI::App& app) {
    app.option_defaults()->group("Picture");
    app.add_option("--camera", camera, "Camera by name (default: the scene's first)")->type_name("NAME");
}

void RenderOptions::add_output_options(CLI::App& app) {
    app.option_defaults()->group("Output");
    add_images_to(app);
    add_value(app, "--aov", images.aovs, parse_aovs, std::string("all, none or a list of ") + AOV_NAMES,
              "EXR: none, all (default) or a list of " + std::string(AOV_NAMES))
        ->type_name("LIST");
    add_value(app, "--write-every", write_every, parse_duration, DURATIONS,
              "Also write the images while rendering (default: only at the end)")
        ->type_name("TIME");
    CLI::Option* const report_file =
        app.add_option("--report", report, "Write statistics of the run as JSON; - is standard output")
            ->type_name("FILE|-");
    app.add_option("--reference", reference, "Report the error relative to this image (.exr) over time")
        ->type_name("FILE")
        ->needs(report_file);
}

void RenderOptions::add_images_to(CLI::App& app) {
    app.add_option("-o,--output", images.files, "Image to write, .exr or .png; repeat it for several")
        ->type_name("FILE")
        ->take_all()
        ->allow_extra_args(false);
    app.add_flag("--half", images.half, "EXR: R G B A and Albedo as 16-bit floats (default: 32-bit)");
    add_development_to(app);
}

void RenderOptions::add_checkpoint_options(CLI::App& app) {
    app.option_defaults()->group("Checkpoints");
    CLI::Option* const file =
        app.add_option("--checkpoint", checkpoint.file,
                       "Save the state to this file, also at the end and when interrupted")
            ->type_name("FILE");
    add_value(app, "--checkpoint-every", checkpoint.every, parse_duration, DURATIONS,
              "How often, such as 90, 90s, 1.5m, 2h (default: 60s)")
        ->type_name("TIME")
        ->needs(file);
    app.add_flag("--resume", checkpoint.resume, "Continue from the checkpoint, if there is one yet")
        ->needs(file);
}

void RenderOptions::add_sampling_options(CLI::App& app) {
    app.option_defaults()->group(SAMPLING_GROUP);
    add_value(app, "--spp", spp, parse_spp, "a whole number from 1 to " + std::to_string(MAX_SPP),
              "Samples per pixel")
        ->type_name("N");
    add_value(app, "--seed", seed, parse_seed, "a whole number from 0 to 4294967295",
              "Seed of the random numbers; each gives different noise")
        ->type_name("S");
    const std::string depths = "a whole number from 0 to " + std::to_string(DEPTH_SAFETY_LIMIT);
    add_value(app, "--max-depth", max_depth, parse_max_depth, depths + ", or unlimited",
              "Maximum number of bounces, or unlimited; 0 shows only lights")
        ->type_name("D");
    add_value(app, "--rr-depth", rr_depth, parse_depth, depths, "Bounces before Russian roulette begins")
        ->type_name("N");
    add_choice(app, "--estimator", estimator, ESTIMATOR_NAMES,
               "How direct light is sampled; mis has the least noise, bsdf misses lights without a surface");
    add_choice(app, "--sampler", sampler, SAMPLER_NAMES, "Random numbers; sobol has the least noise");
    add_choice(app, "--terminator", terminator, TERMINATOR_NAMES,
               "Where light ends on meshes with smooth normals: along the smooth surface, or along the flat "
               "triangles");
}

void RenderOptions::add_message_options(CLI::App& app) {
    app.option_defaults()->group("Messages");
    CLI::Option* const quiet_flag =
        app.add_flag("-q,--quiet", messages.quiet, "No progress, no summary, only warnings and errors");
    add_choice(app, "--progress", messages.progress, PROGRESS_NAMES,
               "Progress on stderr: for people, as JSON, or none (default: auto)")
        ->excludes(quiet_flag);
    app.add_flag("-v,--verbose", messages.verbose, "Also describe device, scene and memory")
        ->excludes(quiet_flag);
}

AovSelection ImageOutputs::written_aovs() const {
    const bool exr = std::ranges::any_of(
        files, [](const std::string& path) { return image_format(path) == ImageFormat::exr; });
    return exr ? aovs : AovSelection{};
}

const Camera& RenderOptions::choose_camera(const Scene& scene) const {
    return candela::choose_camera(scene, camera, "--camera: ");
}

RenderJob RenderOptions::job(const Scene& scene) const {
    RenderJob job{.camera = choose_camera(scene),
                  .settings = settings(scene),
                  .target = samples ? samples->count() : spp.value_or(scene.integrator.spp),
                  .adaptive = adaptive,
                  .target_error = target_error,
                  .time_limit = time_limit,
                  .write_every = write_every,
                  .aovs = images.written_aovs(),
                  .checkpoint = checkpoint};
    if (adaptive && job.target % 2 != 0) {
        throw Error("--adaptive renders two halves: give an even number of samples per pixel (--spp), not " +
                        std::to_string(job.target),
                    ExitCode::usage);
    }
    return job;
}

RenderSettings RenderOptions::settings(const Scene& scene) const {
    RenderSettings result = proposed_settings(scene, choose_camera(scene));
    result.size = picture.size.value_or(result.size);
    result.crop = picture.crop_within(result.size);
    result.estimator = estimator.value_or(result.estimator);
    result.sampler = sampler.value_or(result.sampler);
    result.terminator = terminator.value_or(result.terminator);
    result.seed = seed.value_or(result.seed);
    result.first_sample = samples ? samples->first : 0;
    result.max_depth = max_depth.value_or(result.max_depth);
    result.rr_depth = rr_depth.value_or(result.rr_depth);
    result.aovs = images.written_aovs().needs_layers();
    result.scene_access = scene_access;
    result.pass_growth = time_limit || write_every ? EVEN_PASS_GROWTH : PASS_GROWTH;
    return result;
}

}  // namespace candela
