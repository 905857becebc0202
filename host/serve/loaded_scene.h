// A scene that a client has loaded, and its picture.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "load/load.h"
#include "serve/server.h"
#include "session/device_slot.h"
#include "session/live_picture.h"

namespace candela::serve {

// Each has a device of its own, so that a lost device takes no other picture along. If a function throws, the
// scene is as before. Everything of the scene is within the limit on memory.
class LoadedScene {
  public:
    // Throws Error if the scene cannot be read, or the call is cancelled.
    LoadedScene(DeviceSlot device, const std::filesystem::path& path, LoadOptions options, const Call& call);

    const Scene& scene() const { return picture_->scene().scene(); }
    void change(std::string_view json, const NamedArrays* arrays);
    void pose(std::optional<double> time, std::optional<std::string> animation);

    // Renders until the job is done or the call is cancelled.
    void render(RenderJob job, const Call& call, bool tells_progress);
    // How far the picture has got. Throws Error if there is none.
    Json outcome();
    // The picture so far, with its attributes. Throws Error if there is none.
    Image image(const std::string& command_line);
    // The device, which nothing uses between two calls.
    const vk::Device& open_device() { return device_.open(); }
    // What the numbers of its layers of ids mean.
    std::shared_ptr<const Labels> labels();

    // The warnings since the last call.
    std::vector<std::string> take_warnings();

    // The device of a scene that ends here.
    static DeviceSlot device_of(std::unique_ptr<LoadedScene> scene);

  private:
    Rendering& rendered();

    DeviceSlot device_;
    std::optional<LivePicture> picture_;    // Until the device is taken.
    std::shared_ptr<const Labels> labels_;  // Of the scene, if they have been asked for.
    const Call* call_ = nullptr;            // While the scene is loaded.
    std::vector<std::string> warnings_;
};

}  // namespace candela::serve
