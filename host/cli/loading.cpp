// See loading.h.
#include "cli/loading.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include <nlohmann/json.hpp>

#include "base/memory_limit.h"
#include "cli/blend_file.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/progress_line.h"
#include "scene/geometry.h"
#include "scene/seen_from_behind.h"

namespace candela {

namespace {

// The progress of loading, a stage at a time.
class LoadingLine {
  public:
    explicit LoadingLine(ProgressStyle style) : style_(style) {}

    void update(const std::string& what, size_t done, size_t of) {
        if (what != what_ || done < done_) line_.emplace(style_, 0.0);
        what_ = what;
        done_ = done;
        const double fraction = of == 0 ? 0.0 : double(done) / double(of);
        if (!line_->is_due(fraction)) return;
        line_->print(line_->is_json() ? json_text(of) : text(of), fraction);
    }

  private:
    std::string json_text(size_t of) const {
        nlohmann::ordered_json json{{"state", "loading"}, {what_, done_}};
        if (of > 0) json["of_" + what_] = of;
        return json.dump();
    }
    std::string text(size_t of) const {
        const auto number = [this](size_t n) { return what_ == "bytes" ? bytes_text(n) : std::to_string(n); };
        return (what_ == "bytes" ? "read: " : what_ + ": ") + number(done_) +
               (of > 0 ? " of " + number(of) : "");
    }

    ProgressStyle style_;
    std::optional<ProgressLine> line_;
    std::string what_;
    size_t done_ = 0;
};

}  // namespace

LoadOptions load_options(const LoadingOptions& given, const LoadProgress& progress) {
    set_memory_limit(given.memory_limit.value_or(default_memory_limit()));
    LoadOptions options{.gltf = given.gltf,
                        .lighting = given.lighting,
                        .double_sided = given.double_sided,
                        .progress = progress};
    options.images.if_missing = given.missing_images;
    options.reach = {.folders = {given.folders.begin(), given.folders.end()}, .anywhere = given.any_folder};
    if (given.texture_limit) options.images.texture_limit = *given.texture_limit;
    return options;
}

Scene load_quietly(const std::string& file, const LoadingOptions& given, const LoadProgress& progress) {
    const LoadOptions options = load_options(given, progress);
    std::optional<ExportedBlend> blend;
    std::error_code missing;
    if (is_blend_file(file) && std::filesystem::exists(file, missing)) blend.emplace(file);
    const LimitedMemory limited;
    return with_memory_for(
        "the scene", [&] { return file; },
        [&] { return load_scene(blend ? blend->gltf() : std::filesystem::path(file), options); });
}

void show_progress(ProgressStyle style, const std::function<void(const LoadProgress&)>& load) {
    const QuittingGuard guard;
    LoadingLine line(style);
    load([&line](const char* what, size_t done, size_t of) { line.update(what, done, of); });
}

Scene load_showing_progress(const std::string& file, const LoadingOptions& options, ProgressStyle style) {
    Scene scene;
    show_progress(style,
                  [&](const LoadProgress& progress) { scene = load_quietly(file, options, progress); });
    return scene;
}

Scene load_with_progress(const std::string& file, const LoadingOptions& options, ProgressStyle style) {
    Scene scene = load_showing_progress(file, options, style);
    print_warnings(scene.warnings);
    return scene;
}

GpuScene build_quietly(Scene& scene) {
    const LimitedMemory limited;
    return with_memory_for(
        "the tree and the records of what it shows", [] { return std::string("the scene"); },
        [&] { return build_gpu_scene_freeing_images(scene); });
}

GpuScene build_showing_progress(Scene& scene, ProgressStyle style) {
    const QuittingGuard guard;
    ProgressLine line(style, 0.0);
    if (line.is_live()) line.print("building the tree", 0.0);
    return build_quietly(scene);
}

GpuScene build_with_progress(Scene& scene, ProgressStyle style) {
    GpuScene gpu_scene = build_showing_progress(scene, style);
    print_warnings(gpu_scene.warnings);
    return gpu_scene;
}

std::vector<std::string> warnings_of_unseen_backs(const Scene& scene, const Camera& camera, uvec2 size) {
    constexpr double LEAST = 0.005;
    const std::optional<double> share = share_seen_from_behind(scene, camera, size);
    if (!share || *share < LEAST) return {};
    return {"single-sided surfaces are seen from behind, and are invisible, in about " +
            fixed(100.0 * *share, 1) + " % of the picture; if something looks hollow, use --double-sided"};
}

std::vector<std::string> warnings_of_unseen_lights(const Scene& scene, Estimator estimator) {
    const auto lit = [](const Light& light) { return gives_light(light); };
    if (estimator != Estimator::bsdf || !std::ranges::any_of(scene.lights, lit)) return {};
    return {
        "the estimator bsdf cannot find the point, spot and directional lights of this scene, which have "
        "no surface; use mis or light"};
}

}  // namespace candela
