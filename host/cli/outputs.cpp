// Writes images with their attributes, and the report.
#include "cli/outputs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "cli/attempts.h"
#include "cli/console.h"
#include "cli/json_text.h"
#include "image/image_io.h"
#include "image/tonemap.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* STDOUT = "-";

// Marks R G B A and Albedo as 16-bit. A channel whose values exceed 16 bits keeps 32, with a warning: no
// sample may be lost.
void use_half(Image& image) {
    constexpr float LARGEST_HALF = 65504.0f;
    constexpr std::string_view COLOUR_CHANNELS[] = {"R", "G", "B", "A", "Albedo.R", "Albedo.G", "Albedo.B"};
    for (Channel& channel : image.channels) {
        if (std::ranges::find(COLOUR_CHANNELS, channel.name) == std::end(COLOUR_CHANNELS)) continue;
        channel.half = std::ranges::all_of(
            channel.values, [](float v) { return !std::isfinite(v) || std::abs(v) <= LARGEST_HALF; });
        if (!channel.half) {
            print_warning("channel " + channel.name +
                          " holds values beyond 65504, the largest 16-bit float; it is written with 32 bits");
        }
    }
}

void write_image(const ImageOutputs& outputs, const std::string& path, const Image& image, FileWriter write) {
    if (image_format(path) == ImageFormat::exr) {
        write_exr(path, image, write);
    } else {
        write_png(path, image.data.width(), image.data.height(),
                  develop(image, outputs.development.tonemap, float(outputs.development.exposure)), write);
    }
}

Json or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

// Adds the results of --target-error and --reference to the report.
void add_convergence(Json& report, const RenderRecord& record) {
    if (record.target_error) {
        report["target_error"] = *record.target_error;
        report["estimated_error"] = or_null(record.estimated_error);
    }
    if (record.reference) report["reference"] = *record.reference;
    if (!record.target_error && !record.reference) return;
    report["convergence"] = Json::array();
    for (const ConvergencePoint& point : record.convergence) {
        report["convergence"].push_back({{"spp", point.spp},
                                         {"seconds", point.seconds},
                                         {"relmse", or_null(point.relmse)},
                                         {"estimated_error", or_null(point.estimate)}});
    }
}

Json make_report(const RenderRecord& record) {
    const RenderSettings& settings = record.settings;
    const auto ratio = [](double a, double b) { return b > 0.0 ? a / b : 0.0; };
    const double samples = double(record.samples);
    Json report{{"version", record.maker.version},
                {"scene", record.scene_file},
                {"scene_attributes", std::map<std::string, std::string>(record.scene_attributes.begin(),
                                                                        record.scene_attributes.end())},
                {"device", record.maker.device},
                {"driver", record.maker.driver},
                {"width", settings.size.x},
                {"height", settings.size.y},
                {"crop", {settings.crop.x0, settings.crop.y0, settings.crop.x1, settings.crop.y1}},
                {"spp", record.spp},
                {"samples", samples_text(record)},
                {"rendered_samples", record.samples - record.resumed_samples},
                {"complete", record.complete},
                {"seed", settings.seed},
                {"estimator", name_of(settings.estimator, ESTIMATOR_NAMES)},
                {"sampler", name_of(settings.sampler, SAMPLER_NAMES)},
                {"light_sampler", name_of(settings.light_sampler, LIGHT_SAMPLER_NAMES)},
                {"terminator", name_of(settings.terminator, TERMINATOR_NAMES)},
                {"adaptive", record.adaptive},
                {"max_depth", settings.max_depth},
                {"rr_depth", settings.rr_depth},
                {"scene_buffers", to_text(record.array_map)},
                {"primitives", record.primitives},
                {"lights", record.lights},
                {"load_seconds", record.load_seconds},
                {"bvh_seconds", record.bvh_seconds},
                {"pipeline_seconds", record.pipeline_seconds},
                {"render_seconds", record.render_seconds},
                {"cpu_seconds", record.cpu_seconds},
                {"samples_per_second", ratio(samples, record.render_seconds)},
                {"rays_per_sample", ratio(double(record.counters.rays), samples)},
                {"device_bytes", record.device_bytes},
                {"nonfinite_samples", record.counters.nonfinite_samples},
                {"depth_limit_hits", record.counters.depth_limit_hits},
                {"device_failures", record.device_failures},
                {"image_hash", hexadecimal(record.image_hash)},
                {"validation_messages", record.validation_messages}};
    add_convergence(report, record);
    return report;
}

void write_report(const std::string& target, const Json& report) {
    const std::string text = json_text(report) + '\n';
    if (target == STDOUT) {
        std::fputs(text.c_str(), stdout);
        flush_results();
    } else {
        write_finished_work(target, text);
    }
}

}  // namespace

void check_outputs(const ImageOutputs& outputs) {
    if (outputs.files.empty()) {
        throw Error("no output given; use -o FILE.exr, -o FILE.png, or both", ErrorKind::request);
    }
    for (const std::string& path : outputs.files)
        image_format(path);
    for (const std::string& path : outputs.files)
        check_writable(path);
}

void check_report(const std::optional<std::string>& file) {
    if (file && *file != STDOUT) check_writable(*file);
}

void write_images(const ImageOutputs& outputs, Image image) {
    if (outputs.half) use_half(image);
    Attempts attempts;
    for (const std::string& path : outputs.files)
        attempts.attempt([&] { write_image(outputs, path, image, write_finished_work); });
    attempts.finish();
}

void write_current_images(const ImageOutputs& outputs, const RenderRecord& record, Image image) {
    add_attributes(image, record);
    if (outputs.half) use_half(image);
    for (const std::string& path : outputs.files) {
        try {
            write_image(outputs, path, image, write_file_atomically);
        } catch (const Error& error) {
            print_warning(std::string(error.what()) + "; rendering continues without this image");
        }
    }
}

void write_outputs(const ImageOutputs& outputs, const std::optional<std::string>& report,
                   const RenderRecord& record, Image image) {
    add_attributes(image, record);
    Attempts attempts;
    attempts.attempt([&] { write_images(outputs, std::move(image)); });
    if (report) attempts.attempt([&] { write_report(*report, make_report(record)); });
    attempts.finish();
}

}  // namespace candela
