// Scenes and meshes for tests, made in a few words.
#pragma once

#include <functional>
#include <optional>

#include "scene/scene.h"

namespace candela {

// Scenes of the folder scenes/.
Scene cornell_box();
// A closed box that emits radiance 1 everywhere and reflects `albedo` of what it receives.
Scene furnace(float albedo);

// Adds a material and returns its index.
uint32_t add_diffuse(Scene& scene, vec3 reflectance);

// A quad with corners p, p + e1, p + e1 + e2, p + e2.
Quad parallelogram(vec3 p, vec3 e1, vec3 e2);

// A scene that a camera at `position` sees through a narrow vertical field of view [rad]; no shapes yet.
Scene scene_with_camera(vec3 position, vec3 look_at, float vertical_fov);

// A sphere of rings * segments quads, two triangles each; unit radius, centre 0, closed, the front outside.
TriangleMesh sphere_mesh(uint32_t rings, uint32_t segments);

// Triangles whose corners lie in a cube of edge 2 `size` around a random centre in [-1, 1]^3. Independent of
// each other.
TriangleMesh triangle_soup(uint32_t count, float size, uint32_t seed);

// The mesh with every position p replaced by f(p).
TriangleMesh transformed(TriangleMesh mesh, const std::function<vec3(vec3)>& f);

// A scene of that mesh alone, with one material and a camera at the origin.
Scene scene_of_mesh(TriangleMesh mesh);

}  // namespace candela
