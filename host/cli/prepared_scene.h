// What is done for a scene before its pictures are rendered, without a device, so that another thread can do
// it while the scene before is rendered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/message_options.h"
#include "cli/picture_plan.h"
#include "cli/render_options.h"
#include "gpu_scene/gpu_scene.h"
#include "image/image.h"
#include "scene/scene.h"
#include "session/animated_scene.h"
#include "session/job.h"

namespace candela {

struct PreparedPicture {
    Picture picture;
    bool is_skipped = false;           // Its files are there.
    bool is_metered = false;           // It is rendered nevertheless, for the exposure of the others.
    std::optional<Error> failure{};    // Why it cannot be rendered;
    std::optional<RenderJob> job{};    // otherwise how.
    std::optional<Image> reference{};  // To measure the error against.
};

// An animated scene, which is posed for one frame after the other.
struct KeptScene {
    size_t number;  // PlannedScene::number.
    AnimatedScene scene;
    std::optional<std::vector<Camera>> cameras{};  // Those that the options ask for, fitted to all frames.
    bool was_checked = false;                      // The warnings about what its pictures show are given.
    std::shared_ptr<const Labels> labels{};
};

struct PreparedScene {
    std::string file{};
    std::vector<PreparedPicture> pictures{};
    std::optional<Error> failure{};  // Why none of them can be rendered, unless it is skipped.
    Scene scene{};                   // Of a frame, only what is not in the records.
    GpuScene records{};              // Of no use if there is no job.
    uint64_t arrays_hash = 0;        // Of the records.
    double load_seconds = 0.0;
    double cpu_seconds = 0.0;             // Of all of this.
    std::vector<std::string> warnings{};  // Not yet printed.
};

// Reads and builds scene i of the plan, unless all its pictures are skipped. Checks that their files can be
// written. A frame poses the scene in `kept`, if that is its own, and otherwise puts it there. Progress is
// shown in a style, which lets signals end the program, or without one not at all. The warnings of a single
// picture are printed at once. No error is thrown.
PreparedScene prepare_scene(PicturePlan& plan, size_t i, const RenderOptions& options,
                            std::optional<ProgressStyle> style, std::unique_ptr<KeptScene>& kept);

}  // namespace candela
