// See default_view.h.
#include "scene/default_view.h"

#include <cmath>

#include "scene/geometry.h"

namespace candela {

void add_default_camera(Scene& scene) {
    const DoubleBox box = bounds(scene);
    // Radius of the sphere around the box [m]; arbitrary if there is nothing to see.
    const double radius = box.is_empty() || box.extent() == dvec3(0.0) ? 1.0 : 0.5 * length(box.extent());
    const dvec3 towards_viewer = normalize(dvec3(0.5, 0.4, 1.0));
    Camera camera;
    camera.name = "default";
    camera.look_at = box.is_empty() ? dvec3(0.0) : box.centroid();
    camera.vertical_fov = 0.7f;
    camera.position = camera.look_at + radius / std::sin(0.5 * double(camera.vertical_fov)) * towards_viewer;
    scene.cameras.push_back(camera);
}

void add_default_view(Scene& scene) {
    add_default_camera(scene);
    if (emitter_count(scene) == 0) scene.environment = Environment{.radiance = {vec3(1.0f)}};
}

}  // namespace candela
