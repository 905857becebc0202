// The benchmark's own meshes: of any size, and the same on every machine.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace candela {

// A closed sphere of radius 1 around 0 whose surface rises and falls by up to a fifth, from broad bumps to
// fine ones; the front is outside. Each of the six faces of a cube is cut into n * n quads of two triangles
// and projected onto the sphere: 12 n^2 triangles. `seed` chooses the bumps.
TriangleMesh displaced_sphere(uint32_t n, uint32_t seed);

// A scene of about that many triangles (60 n^2 + 12 with the nearest n; at least 72), all but 12 of them in
// displaced surfaces: four displaced_sphere()s on a hilly floor, in a closed room of plain walls under a
// rectangular light, so that every ray hits something and bounces remain incoherent. The camera stands in a
// corner; all materials are diffuse, all shading is flat.
Scene displaced_scene(uint32_t triangles);

// A tree of about that many triangles, at least ten, that stands at 0 and grows along +y to about 8 m: a stem
// that branches up to four times, and leaves of two triangles around its twigs.
TriangleMesh tree_mesh(uint32_t triangles, uint32_t seed);

// `trees` instances of up to twenty trees of 100 000 triangles (one kind for every 500), turned, scaled and
// so close that their crowns overlap, on a square of ground under a rectangular light. The camera looks over
// the crowns from a corner. One material.
Scene forest_scene(uint32_t trees);

// `count` instances of a mesh of 48 triangles, turned at random in a cube.
Scene scattered_scene(uint32_t instances);

}  // namespace candela
