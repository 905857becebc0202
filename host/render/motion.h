// Motion of what pixels show, from one frame of an animation to the next.
//
// The motion is where a point is in the picture minus where it was [pixels], x to the right and y down the
// rows. What the rays miss is infinitely far away, and moves as the camera turns; parallel rays see it
// without motion, and where a fisheye sees nothing there is none. A point that the camera of the frame before
// could not show in any place, since it was behind it, has an infinite motion.
#pragma once

#include <memory>

#include "gpu_scene/scene_motion.h"
#include "scene/scene.h"

namespace candela {

// What is known of the frame before.
struct MotionSince {
    Camera camera;  // That of the picture, as it was.
    std::shared_ptr<const SceneMotion> scene;
};

}  // namespace candela
