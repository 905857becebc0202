// See default_view.h.
#include "scene/default_view.h"

#include <cmath>

#include "scene/geometry.h"

namespace candela {

void add_default_view(Scene& scene) {
    const Box box = bounds(scene);
    const vec3 center = box.is_empty() ? vec3(0.0f) : box.centroid();
    // Radius of the sphere around the box [m]; any length where there is nothing to see.
    const float radius = box.is_empty() || box.extent() == vec3(0.0f) ? 1.0f : 0.5f * length(box.extent());
    const vec3 towards_viewer = normalize(vec3(0.5f, 0.4f, 1.0f));
    Camera camera;
    camera.name = "default";
    camera.look_at = center;
    camera.vertical_fov = 0.7f;
    camera.position = center + radius / std::sin(0.5f * camera.vertical_fov) * towards_viewer;
    scene.cameras.push_back(camera);
    if (emitter_count(scene) == 0) scene.environment = Environment{.radiance = {vec3(1.0f)}};
}

}  // namespace candela
