// A picture of a scene that stays loaded: rendered on where it can be, otherwise anew.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/error.h"
#include "session/device_slot.h"
#include "session/live_scene.h"
#include "session/rendering.h"

namespace candela {

// The picture is a function of the scene and the job, regardless of what was rendered before.
class LivePicture {
  public:
    // The device serves no other picture, and outlives this one; it may be open.
    explicit LivePicture(DeviceSlot& device) : device_(&device) {}

    // The scene, which may be loaded and changed at any time.
    LiveScene& scene() { return scene_; }
    const LiveScene& scene() const { return scene_; }

    // Brings the records of the scene up to date, as render() also does. Throws what LiveScene::update()
    // throws.
    void update();
    // Renders the picture of the job, which asks for no files. Continues from the samples so far if they are
    // the first of this picture, and no more than it needs. Returns and throws what Rendering::run() does.
    std::optional<Error> render(RenderJob job, RenderCallbacks callbacks);

    // Whether anything has been rendered since the last failure to begin.
    bool has_picture() const { return rendering_ != nullptr; }
    // What was rendered last, if there is anything.
    Rendering& rendered() const { return *rendering_; }

  private:
    bool continues(const RenderJob& job, const RenderRecord& record) const;
    void prepare(RenderJob job);

    DeviceSlot* device_;
    LiveScene scene_;
    BufferSet changed_;         // The buffers of the scene that the device does not hold yet.
    uint64_t arrays_hash_ = 0;  // hash_arrays() of the records.
    bool has_failed_ = false;   // A rendering has not begun, so that the device may be lost.
    RenderJob job_;             // What rendering_ renders.
    std::unique_ptr<Rendering> rendering_;
};

}  // namespace candela
