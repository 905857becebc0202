// What is done for a scene before its pictures are rendered, without a device, so that another thread can do
// it while the scene before is rendered.
#pragma once

#include <cstddef>
#include <cstdint>
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

struct PreparedScene {
    std::string file{};
    std::vector<PreparedPicture> pictures{};
    std::optional<Error> failure{};  // Why none of them can be rendered, unless it is skipped.
    Scene scene{};
    GpuScene records{};        // Of no use if there is no job.
    uint64_t arrays_hash = 0;  // Of the records.
    double load_seconds = 0.0;
    double cpu_seconds = 0.0;             // Of all of this.
    std::vector<std::string> warnings{};  // Not yet printed.
};

// Reads and builds scene i of the plan, unless all its pictures are skipped. Checks that their files can be
// written. Progress is shown in a style, which lets signals end the program, or without one not at all. The
// warnings of a single picture are printed at once. No error is thrown.
PreparedScene prepare_scene(PicturePlan& plan, size_t i, const RenderOptions& options,
                            std::optional<ProgressStyle> style);

}  // namespace candela
