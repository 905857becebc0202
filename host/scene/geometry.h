// Questions about a whole scene.
#pragma once

#include "base/math.h"
#include "scene/scene.h"

namespace candela {

// The least box around all shapes; empty for a scene without shapes.
Box bounds(const Scene& scene);

// How many triangles the shapes have; a quad counts as two.
uint64_t triangle_count(const Scene& scene);

// How many shapes emit light.
size_t emitter_count(const Scene& scene);

}  // namespace candela
