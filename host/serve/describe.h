// Scenes and devices as JSON.
#pragma once

#include <span>

#include "scene/scene.h"
#include "serve/message.h"
#include "vk/device_info.h"

namespace candela::serve {

// Cameras as in scene files, the names of everything else, the box around all in metres, and what the scene
// proposes for a picture.
Json describe_scene(const Scene& scene);

// A camera as in scene files, for a picture of that size.
Json describe_camera(const Camera& camera, uvec2 size);

// What `candela devices` prints of them.
Json describe_devices(std::span<const vk::DeviceInfo> devices);

}  // namespace candela::serve
