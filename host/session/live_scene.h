// A loaded scene with its records: after a change, only the records that depend on it are remade.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gpu_scene/scene_stages.h"
#include "load/json/change.h"
#include "load/load.h"
#include "scene/scene.h"
#include "scene/scene_change.h"

namespace candela {

// Scene and records are functions of the state alone, regardless of how it was reached. If a function throws,
// the scene is unchanged.
class LiveScene {
  public:
    // Reads a scene, which replaces any previous one. Throws what load_scene() throws.
    void load(const std::filesystem::path& path, const LoadOptions& options);
    // Changes it as change_scene() does. Throws what that throws.
    void change(std::string_view json, const NamedArrays* arrays = nullptr);
    // Shows the glTF files at another time, without reading them again; changes stay. Throws what
    // load_scene() and change_scene() throw, and Error for a scene that was read from arrays.
    void pose(std::optional<double> time, std::optional<std::string> animation);

    // Has no camera before the first load().
    const Scene& scene() const { return scene_; }
    // The changes of the scene that are not yet in the records; none: all of it.
    const std::optional<SceneChange>& pending() const { return pending_; }
    // Brings the records up to date. Returns the buffers whose words have changed. Throws what
    // build_gpu_scene() throws; the next call then makes all records.
    BufferSet update();
    // The records of the last update(), always in the same place.
    const GpuScene& records() const { return stages_->joined(); }
    // The warnings about files and records since the last call.
    std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

  private:
    void keep_warnings(std::vector<std::string>& warnings);

    std::filesystem::path path_;
    LoadOptions options_;
    LoadedFiles files_;
    SceneEdits edits_;
    Scene scene_;
    std::optional<SceneStages> stages_;
    std::optional<SceneChange> pending_;
    std::vector<std::string> warnings_;
    bool has_arrays_ = false;  // Which are gone.
};

}  // namespace candela
