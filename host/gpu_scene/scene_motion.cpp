// See scene_motion.h.
#include "gpu_scene/scene_motion.h"

#include <cassert>
#include <unordered_set>
#include <utility>

#include "gpu_scene/choose_frame.h"
#include "gpu_scene/flatten.h"

namespace candela {

SceneMotion make_scene_motion(const Scene& scene, const GpuScene& records, PlacesBefore&& before) {
    std::unordered_set<uint32_t> instances;
    for (const InstancePlace& place : records.instances)
        instances.insert(place.shape);
    SceneMotion motion{.cameras = std::move(before.cameras), .shapes = {}};
    for (PlaceBefore& place : before.shapes) {
        const Shape& shape = scene.shapes[place.shape];
        const auto& instance = std::get<MeshInstance>(shape.geometry);
        ShapeMotion moved{.now = instance.transform.matrix(), .before = place.transform};
        if (!place.positions.empty()) {
            const TriangleMesh& mesh = scene.meshes[instance.mesh];
            assert(place.positions.size() == mesh.positions.size());
            moved.corners =
                instances.contains(place.shape)
                    ? corners_by_id(mesh, Transform(), frame_around(mesh), shape.emission.has_value())
                    : corners_by_id(mesh, instance.transform, records.frame, shape.emission.has_value());
            moved.positions_now.reserve(mesh.positions.size());
            for (const vec3 p : mesh.positions)
                moved.positions_now.push_back(mesh.origin + dvec3(p));
            moved.positions_before = std::move(place.positions);
        } else if (moved.now == moved.before) {
            continue;
        }
        motion.shapes.emplace(place.shape, std::move(moved));
    }
    return motion;
}

}  // namespace candela
