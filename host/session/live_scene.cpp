// See live_scene.h.
#include "session/live_scene.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/error.h"

namespace candela {

// What messages about changes begin with.
static constexpr const char* CHANGE = "change";

void LiveScene::load(const std::filesystem::path& path, const LoadOptions& options) {
    LoadedFiles files;
    scene_ = load_scene(path, options, files);
    path_ = path;
    options_ = options;
    has_arrays_ = std::exchange(options_.arrays, nullptr) != nullptr;
    files_ = std::move(files);
    edits_ = {};
    pending_.reset();
    keep_warnings(scene_.warnings);
}

void LiveScene::change(std::string_view json, const NamedArrays* arrays) {
    const SceneChange change = change_scene(scene_, json, CHANGE, path_.parent_path(), edits_, arrays);
    if (pending_) pending_->add(change);
    keep_warnings(scene_.warnings);
}

void LiveScene::pose(std::optional<double> time, std::optional<std::string> animation) {
    if (has_arrays_)
        throw Error(
            "the scene was made from arrays, and cannot be read at another time; load it at that time");
    LoadOptions options = options_;
    options.gltf.time = time;
    options.gltf.animation = std::move(animation);
    Scene posed = load_scene(path_, options, files_);
    carry_edits(edits_, scene_, CHANGE, posed);
    const std::optional<SceneChange> change = difference(scene_, posed);
    if (pending_ && change) {
        pending_->add(*change);
    } else {
        pending_.reset();
    }
    scene_ = std::move(posed);
    options_ = std::move(options);
    keep_warnings(scene_.warnings);
}

BufferSet LiveScene::update() {
    BufferSet changed;
    if (!pending_) {
        stages_ = SceneStages(scene_);
        changed.set();
    } else if (pending_->any()) {
        const SceneChange change = *std::exchange(pending_, std::nullopt);  // If this fails, all is pending.
        changed = stages_->update(scene_, change);
    } else {
        return changed;
    }
    pending_.emplace();
    std::vector<std::string> warnings = records().warnings;
    keep_warnings(warnings);
    return changed;
}

void LiveScene::keep_warnings(std::vector<std::string>& warnings) {
    std::ranges::move(warnings, std::back_inserter(warnings_));
    warnings.clear();
}

}  // namespace candela
