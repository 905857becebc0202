// The benchmark's own meshes: of any size, and the same on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

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

// World space [m].
struct BenchTriangle {
    vec3 a, b, c;
};

// The triangles, by id, of a scene that has no other shapes.
std::vector<BenchTriangle> triangles_of(const Scene& scene);

// "190 k triangles", "1 M triangles", "72 triangles": a number of triangles for people, to three digits.
std::string triangles_text(uint64_t triangles);

}  // namespace candela
