// Questions about a whole scene.
#pragma once

#include "base/math.h"
#include "scene/scene.h"

namespace candela {

// The least box around all shapes; empty for a scene without shapes.
DoubleBox bounds(const Scene& scene);

DoubleBox bounds(const Scene& scene, const Shape& shape);

// How many triangles the shapes have; a quad counts as two, a sphere or disk as none.
uint64_t triangle_count(const Scene& scene);

// How many shapes emit light; the environment is not one of them.
size_t emitter_count(const Scene& scene);

// Whether an environment is brighter than 0 anywhere.
bool gives_light(const Environment& environment);

// Whether a light is not black.
bool gives_light(const Light& light);

// Whether the picture shows anything but black: light, or a shape that shows its colour without any.
bool has_light(const Scene& scene);

}  // namespace candela
