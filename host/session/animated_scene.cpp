// See animated_scene.h.
#include "session/animated_scene.h"

#include "load/gltf/poser.h"

namespace candela {

AnimatedScene::AnimatedScene(const std::filesystem::path& path, LoadOptions options) {
    options.gltf.frames = true;
    LoadedFiles files;
    scene_ = load_scene(path, options, files);
    poser_ = std::move(files.gltf.poser);
    warn(scene_.warnings);
    scene_.warnings.clear();
    warn(poser_->take_warnings());
}

std::pair<double, double> AnimatedScene::times() const {
    return poser_->times();
}

void AnimatedScene::pose(double time) {
    pending_.add(poser_->pose(scene_, time));
    warn(poser_->take_warnings());
}

const GpuScene& AnimatedScene::build() {
    if (stages_) {
        stages_->update(scene_, std::exchange(pending_, {}));
    } else {
        stages_ = SceneStages(scene_);
        pending_ = {};
    }
    warn(stages_->joined().warnings);
    return stages_->joined();
}

SceneMotion AnimatedScene::motion_since(double time) {
    PlacesBefore before = poser_->places_at(scene_, time);
    warn(poser_->take_warnings());
    return make_scene_motion(scene_, stages_->joined(), std::move(before));
}

std::vector<std::string> AnimatedScene::take_warnings() {
    return std::exchange(warnings_, {});
}

void AnimatedScene::warn(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
        if (told_.insert(warning).second) warnings_.push_back(warning);
    }
}

}  // namespace candela
