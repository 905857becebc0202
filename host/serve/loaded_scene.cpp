// See loaded_scene.h.
#include "serve/loaded_scene.h"

#include <chrono>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/memory_limit.h"
#include "scene/label_scene.h"
#include "session/interval.h"

namespace candela::serve {
namespace {

// The seconds between two reports of progress.
constexpr double BETWEEN_REPORTS = 0.05;

// Returns action() within the limit on memory, which the scene is said to need.
template <class Action>
auto within_memory(const Action& action) {
    const LimitedMemory limited;
    return with_memory_for(
        "the scene", [] { return std::string("request"); }, action);
}

}  // namespace

LoadedScene::LoadedScene(DeviceSlot device, const std::filesystem::path& path, LoadOptions options,
                         const Call& call)
    : device_(std::move(device)), picture_(device_) {
    // The scene keeps the options, and poses report their progress, too.
    options.progress = [this](const char*, size_t, size_t) {
        if (call_ != nullptr && call_->is_cancelled()) throw Error("the scene: cancelled");
    };
    call_ = &call;
    try {
        within_memory([&] { picture_->scene().load(path, options); });
    } catch (const Error&) {
        if (!call.is_cancelled()) throw;
        throw RequestError(Code::cancelled, "the scene: cancelled while it was loaded");
    }
    call_ = nullptr;
}

void LoadedScene::change(std::string_view json, const NamedArrays* arrays) {
    within_memory([&] { picture_->scene().change(json, arrays); });
}

void LoadedScene::pose(std::optional<double> time, std::optional<std::string> animation) {
    within_memory([&] { picture_->scene().pose(time, std::move(animation)); });
    labels_.reset();
}

void LoadedScene::render(RenderJob job, const Call& call, bool tells_progress) {
    within_memory([&] {
        picture_->update();
        if (job.aovs.needs_coverage()) job.labels = labels();
    });
    Interval reports(BETWEEN_REPORTS);
    const auto report = [&](double done, std::optional<double> error) {
        if (!tells_progress || !reports.over()) return;
        Json progress{{"done", done}};
        if (error) progress["error"] = *error;
        call.progress(progress);
        reports.restart();
    };
    const std::optional<Error> failure = picture_->render(
        std::move(job), {.progress = report,
                         .keep_going = [&] { return !call.is_cancelled(); },
                         .warn = [this](const std::string& warning) { warnings_.push_back(warning); },
                         .device_failed =
                             [this](const Error& error, uint32_t, double) {
                                 warnings_.push_back(std::string(error.what()) + "; reopening the device");
                             },
                         .write = {}});
    if (failure) throw Error(*failure);
}

std::shared_ptr<const Labels> LoadedScene::labels() {
    if (!labels_) labels_ = std::make_shared<const Labels>(label_scene(scene()));
    return labels_;
}

Rendering& LoadedScene::rendered() {
    if (!picture_->has_picture())
        throw RequestError(Code::failed, "nothing of this scene has been rendered yet; render it first");
    return picture_->rendered();
}

Json LoadedScene::outcome() {
    const Rendering& rendering = rendered();
    const RenderRecord& record = rendering.record();
    Json result{{"complete", record.complete},
                {"spp", rendering.spp()},
                {"seconds", record.render_seconds},
                {"error", nullptr}};
    if (record.estimated_error) result["error"] = *record.estimated_error;
    return result;
}

Image LoadedScene::image(const std::string& command_line) {
    Image image = rendered().image();
    RenderRecord record = rendered().record();
    record.command_line = command_line;
    add_attributes(image, record);
    return image;
}

std::vector<std::string> LoadedScene::take_warnings() {
    std::vector<std::string> warnings = picture_->scene().take_warnings();
    std::ranges::move(std::exchange(warnings_, {}), std::back_inserter(warnings));
    return warnings;
}

DeviceSlot LoadedScene::device_of(std::unique_ptr<LoadedScene> scene) {
    scene->picture_.reset();
    return std::move(scene->device_);
}

}  // namespace candela::serve
