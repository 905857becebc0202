// See choose_frame.h.
#include "gpu_scene/choose_frame.h"

#include <algorithm>
#include <cmath>

#include "scene/geometry.h"

namespace candela {

SceneFrame frame_around(const DoubleBox& box) {
    if (box.is_empty()) return {};
    const dvec3 extent = box.extent();
    const double size = std::max({extent.x, extent.y, extent.z});
    SceneFrame frame{.origin = box.centroid()};
    if (size > 0.0) {
        int exponent = 0;
        std::frexp(size, &exponent);
        frame.unit = std::ldexp(1.0, exponent);
    }
    return frame;
}

SceneFrame choose_frame(const Scene& scene) {
    return frame_around(bounds(scene));
}

SceneFrame frame_around(const TriangleMesh& mesh) {
    DoubleBox box;
    for (const vec3 p : mesh.positions)
        box.extend(mesh.origin + dvec3(p));
    return frame_around(box);
}

}  // namespace candela
