// See scene_builders.h.
#include "support/scene_builders.h"

namespace candela {

Scene floor_seen_closely(vec3 reflectance) {
    constexpr float FIELD_OF_VIEW = 1e-3f;
    Scene scene = scene_with_camera(dvec3(0, 1, 5), dvec3(0), FIELD_OF_VIEW);
    add_diffuse(scene, reflectance);
    add_diffuse(scene, vec3(0));
    add_shape(scene, parallelogram(vec3(-50, 0, 50), vec3(100, 0, 0), vec3(0, 0, -100)), 0);
    return scene;
}

}  // namespace candela
