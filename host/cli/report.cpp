// See report.h.
#include "cli/report.h"

#include <cstdio>
#include <map>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "cli/console.h"
#include "cli/json_text.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

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

Json facts_of(const RenderRecord& record) {
    const RenderSettings& settings = record.settings;
    const auto ratio = [](double a, double b) { return b > 0.0 ? a / b : 0.0; };
    const double samples = double(record.samples);
    Json report{{"version", record.maker.version},
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
                {"filter", name_of(settings.filter.shape, FILTER_SHAPE_NAMES)},
                {"filter_width", settings.filter.width},
                {"clamp_indirect", settings.clamp_indirect ? Json(*settings.clamp_indirect) : Json()},
                {"adaptive", record.adaptive},
                {"max_depth", settings.max_depth},
                {"rr_depth", settings.rr_depth},
                {"scene_buffers", to_text(record.array_map)},
                {"primitives", record.primitives},
                {"lights", record.lights},
                {"load_seconds", record.load_seconds},
                {"bvh_seconds", record.bvh_seconds},
                {"pipeline_seconds", record.pipeline_seconds},
                {"kernels_compiled", record.kernels_compiled},
                {"render_seconds", record.render_seconds},
                {"cpu_seconds", record.cpu_seconds},
                {"samples_per_second", ratio(samples, record.render_seconds)},
                {"rays_per_sample", ratio(double(record.counters.rays), samples)},
                {"device_bytes", record.device_bytes},
                {"nonfinite_samples", record.counters.nonfinite_samples},
                {"depth_limit_hits", record.counters.depth_limit_hits},
                {"device_failures", record.device_failures},
                {"validation_messages", record.validation_messages}};
    add_convergence(report, record);
    return report;
}

// What every entry says of its picture.
Json entry_of(const Picture& picture, const std::string& state) {
    Json entry{{"scene", picture.scene},
               {"camera", picture.camera ? Json(*picture.camera) : Json()},
               {"view", picture.view}};
    if (picture.frame) entry["frame"] = *picture.frame;
    entry["outputs"] = picture.files;
    entry["state"] = state;
    return entry;
}

void print_result(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    flush_results();
}

}  // namespace

Report::Report(const std::optional<std::string>& target, bool is_batch)
    : target_(target), has_lines_(target && (is_batch || is_lines(*target))) {
    if (target && *target != STDOUT) check_writable(*target);
    if (has_lines_ && *target != STDOUT) lines_.open(*target, std::ios::binary);
}

bool Report::is_lines(const std::string& target) {
    return extension_of(target) == ".jsonl";
}

void Report::add(const RenderedPicture& rendered, const std::optional<Error>& failure) {
    if (!target_) return;
    Json entry = entry_of(rendered.picture, failure ? "failed" : rendered.state);
    if (failure) entry["error"] = failure->what();
    entry.update(facts_of(rendered.record));
    entry["image_hash"] = hexadecimal(rendered.image_hash);
    entry["exposure"] = rendered.exposure;
    const std::optional<DenoisingRecord>& denoising = rendered.denoising;
    entry["denoiser"] = denoising ? Json(denoising->denoiser) : Json();
    entry["denoiser_version"] = denoising ? Json(denoising->description) : Json();
    entry["denoise_seconds"] = denoising ? Json(denoising->seconds) : Json();
    const OverheadTimes& overhead = rendered.overhead;
    entry["overhead_cpu_seconds"] = {{"scene", overhead.scene},
                                     {"kernels", overhead.kernels},
                                     {"host", overhead.host},
                                     {"develop", overhead.develop},
                                     {"encode", overhead.encode}};
    write(entry);
}

void Report::add(const Picture& picture, const std::string& state, const std::optional<Error>& failure) {
    if (!has_lines_) return;
    Json entry = entry_of(picture, state);
    if (failure) entry["error"] = failure->what();
    write(entry);
}

void Report::write(const Json& entry) {
    const std::string text = (has_lines_ ? json_line(entry) : json_text(entry)) + '\n';
    if (*target_ == STDOUT) {
        print_result(text);
    } else if (!has_lines_) {
        write_finished_work(*target_, text);
    } else if (!(lines_ << text << std::flush) && !failed_) {
        failed_ = true;  // One message is enough.
        throw Error("cannot write " + candela::quoted(*target_) +
                    ": a line of the report is lost; check the disk");
    }
}

}  // namespace candela
