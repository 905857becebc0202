// Questions about a whole scene.
#pragma once

#include <optional>
#include <vector>

#include "base/math.h"
#include "scene/scene.h"

namespace candela {

// The box around all shapes; empty for a scene without shapes. It is the smallest one, except if copied
// meshes have many triangles in all: it then contains the boxes around their placed boxes. Of a frame of an
// animation, it is the box around all frames.
DoubleBox bounds(const Scene& scene);

// The same for some of the shapes of a scene, one by one.
class ShapeBounds {
  public:
    explicit ShapeBounds(const Scene& scene);
    DoubleBox operator()(const Shape& shape) const;

  private:
    const Scene& scene_;
    std::vector<std::optional<DoubleBox>> mesh_boxes_;  // In the meshes' spaces, of copied ones.
};

// The number of triangles of the shapes; a quad has two, a sphere or disk none.
uint64_t triangle_count(const Scene& scene);

// The number of shapes that emit light; the environment is not included.
size_t emitter_count(const Scene& scene);

// Whether an environment is brighter than 0 anywhere.
bool gives_light(const Environment& environment);

// Whether a light is not black.
bool gives_light(const Light& light);

// Whether the picture is not all black: there is light, or a shape that shows its colour without light.
bool has_light(const Scene& scene);

}  // namespace candela
