// Declares the options of `candela render` and combines them with what the scene file says.
#include "cli/render_options.h"

#include "base/error.h"
#include "cli/arguments.h"

namespace candela {

static std::optional<double> parse_error(const std::string& text) {
    const auto value = parse_number(text);
    return value && *value > 0.0 ? value : std::nullopt;
}

static constexpr const char* DURATIONS = "a duration such as 90, 90s, 1.5m or 2h";

void StoppingOptions::add_to(CLI::App& app) {
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
}

void OutputOptions::add_to(CLI::App& app) {
    app.option_defaults()->group("Output");
    images.add_to(app);
    images.add_aovs_to(app);
    images.denoising.add_to(app);
    images.screen.add_alpha_to(app);
    add_value(app, "--write-every", write_every, parse_duration, DURATIONS,
              "Also write the images while rendering (default: only at the end)")
        ->type_name("TIME");
    CLI::Option* const report_file =
        app.add_option(
               "--report", report,
               "Write statistics of the run as JSON; - is standard output, and FILE.jsonl gets a line "
               "for each picture")
            ->type_name("FILE|-");
    app.add_option("--reference", reference, "Report the error relative to this image (.exr) over time")
        ->type_name("FILE")
        ->needs(report_file);
}

static void add_checkpoint_options(CLI::App& app, CheckpointOptions& checkpoint) {
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

void ListOptions::add_scenes_to(CLI::App& app) {
    app.add_option("SCENE", scenes,
                   std::string(SCENE_FILES) +
                       "; repeat it for several, or give a list of them: @FILE, or - for standard input")
        ->required()
        ->type_name("")
        ->take_all();
}

void ListOptions::add_cameras_to(CLI::App& app) {
    app.option_defaults()->group("Picture");
    CLI::Option* const named =
        app.add_option("--camera", cameras,
                       "Camera by name (default: the scene's first); repeat it for a picture by each")
            ->type_name("NAME")
            ->take_all()
            ->allow_extra_args(false);
    const auto parse = [](const std::string& text) {
        return text == "all" ? std::optional(true) : std::nullopt;
    };
    add_value(app, "--cameras", all_cameras, parse, "all", "A picture by each camera of the scene")
        ->type_name("all")
        ->excludes(named);
    app.option_defaults()->group("Several pictures");
    app.add_flag("--skip-existing", skip_existing, "Leave out pictures whose files are all there");
    app.add_flag("--stop-on-error", stop_on_error,
                 "End at the first picture that fails (default: go on with the others)");
    add_value(app, "--batch-time", batch_time, parse_duration, DURATIONS,
              "End after this time for all pictures, such as 90, 90s, 1.5m or 2h, without those that are not "
              "whole (default: never); --skip-existing goes on")
        ->type_name("TIME");
}

void RenderOptions::add_to(CLI::App& app) {
    app.option_defaults()->take_last();  // Later options override a script's.
    list.add_scenes_to(app);
    outputs.add_to(app);
    rendering.add_to(app);
    app.get_option("--animation")->remove_needs(app.get_option("--time"));
    frames.add_to(app);
    list.add_cameras_to(app);
    cameras.add_to(app);
    stopping.add_to(app);
    add_checkpoint_options(app, checkpoint);
    messages.add_to(app);
}

RenderJob RenderOptions::job(const Scene& loaded, const std::optional<std::string>& camera_name) const {
    const std::optional<SampleRange>& samples = stopping.samples;
    const Camera& camera = choose_camera(loaded, camera_name, "--camera: ");
    RenderJob job{
        .camera = camera,
        .settings = rendering.settings(loaded, camera),
        .target = samples ? samples->count() : rendering.sampling.spp.value_or(loaded.integrator.spp),
        .adaptive = stopping.adaptive,
        .target_error = stopping.target_error,
        .time_limit = stopping.time_limit,
        .write_every = outputs.write_every,
        .aovs = outputs.images.rendered_aovs(),
        .checkpoint = checkpoint};
    job.camera = cameras.changed(camera, job.settings.size);
    job.settings.first_sample = samples ? samples->first : 0;
    job.settings.aovs = job.aovs.needs_layers();
    job.settings.guides = job.aovs.denoising;
    job.settings.layer_bytes = layer_bytes(job.aovs);
    if (outputs.images.denoising.is_on()) {
        job.settings.layer_bytes += DENOISED_BYTES;
        job.settings.later_bytes = DENOISER_BYTES;
    }
    job.settings.backdrop = outputs.images.screen.backdrop();
    job.settings.pass_growth = job.time_limit || job.write_every ? EVEN_PASS_GROWTH : PASS_GROWTH;
    if (job.adaptive && job.target % 2 != 0) {
        throw Error("--adaptive renders two halves: give an even number of samples per pixel (--spp), not " +
                        std::to_string(job.target),
                    ErrorKind::request);
    }
    return job;
}

}  // namespace candela
