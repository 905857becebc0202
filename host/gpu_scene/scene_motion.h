// How the shapes of a frame of an animation have moved since the frame before.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "scene/places_before.h"
#include "scene/scene.h"

namespace candela {

// Of a shape that shows a mesh.
struct ShapeMotion {
    glm::dmat4 now{1.0}, before{1.0};  // From the mesh's space to the world's.
    // If the mesh deforms: by corners_by_id(), vertices; and where they are and were, in the mesh's space.
    std::vector<uvec3> corners{};
    std::vector<dvec3> positions_now{}, positions_before{};
};

struct SceneMotion {
    std::vector<Camera> cameras{};                       // As they were; as Scene::cameras.
    std::unordered_map<uint32_t, ShapeMotion> shapes{};  // By index; the others are still.
};

// `records` are those of `scene`, whose parts were at `before`.
SceneMotion make_scene_motion(const Scene& scene, const GpuScene& records, PlacesBefore&& before);

}  // namespace candela
