// A scene whose animation is shown frame by frame: what does not move is read and built once.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gpu_scene/scene_motion.h"
#include "gpu_scene/scene_stages.h"
#include "load/load.h"
#include "scene/scene.h"

namespace candela {

// Scene and records at a time do not depend on the times shown before.
class AnimatedScene {
  public:
    // Reads the scene, for its frames whatever the options say. Throws what load_scene() throws, and Error
    // (usage) if nothing of it is animated.
    AnimatedScene(const std::filesystem::path& path, LoadOptions options);

    // The times of the animation's first and last key [s].
    std::pair<double, double> times() const;
    // Shows it at that time [s]. Throws what load_scene() throws. It is then unusable.
    void pose(double time);
    // Before the first pose, all that is ever visible is where the file has it.
    const Scene& scene() const { return scene_; }
    // Makes the records of the last pose. Throws what build_gpu_scene() throws. It is then unusable.
    const GpuScene& build();
    // How cameras and shapes have moved since that time [s], after build().
    SceneMotion motion_since(double time);
    // The warnings since the last call, each only once.
    std::vector<std::string> take_warnings();

  private:
    void warn(const std::vector<std::string>& warnings);

    std::shared_ptr<gltf::Poser> poser_;
    Scene scene_;
    SceneChange pending_;
    std::optional<SceneStages> stages_;
    std::set<std::string> told_;
    std::vector<std::string> warnings_;
};

}  // namespace candela
