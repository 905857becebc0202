// Scenes and meshes for tests and benchmarks, and functions that make them.
#pragma once

#include <functional>
#include <optional>

#include "scene/scene.h"

namespace candela {

// Scenes from the folder scenes/, as embedded when the program was built.
Scene cornell_box();
// A closed box that emits radiance 1 everywhere and reflects the fraction `albedo` of its incoming light.
Scene furnace(float albedo);

// Adds a material and returns its index.
uint32_t add_material(Scene& scene, const decltype(Material::model)& model);
uint32_t add_diffuse(Scene& scene, vec3 reflectance);

// Adds a shape of that geometry; a mesh is placed as it is.
void add_shape(Scene& scene, const decltype(Shape::geometry)& geometry, uint32_t material,
               std::optional<Emission> emission = {});
void add_shape(Scene& scene, TriangleMesh mesh, uint32_t material, std::optional<Emission> emission = {});

// The same radiance from all directions.
Environment constant_environment(vec3 radiance);
// An environment that is black except for one texel, at the column and row (x, y).
Environment one_bright_texel(uvec2 size, uvec2 texel, vec3 radiance);

// A quad with corners p, p + e1, p + e1 + e2, p + e2.
Quad parallelogram(dvec3 p, dvec3 e1, dvec3 e2);
Quad parallelogram(vec3 p, vec3 e1, vec3 e2);

// A scene without shapes, with a camera of that vertical field of view [rad].
Scene scene_with_camera(dvec3 position, dvec3 look_at, float vertical_fov);

// A grey room without lights, open in front and at the sides; its floor is at y = 0.
Scene open_room();

// One of everything in a room that opens to the sky: materials, shapes, lights, a lens with a polygonal
// aperture, smooth normals.
Scene scene_of_everything();

// A sphere of rings * segments quads, two triangles each, at the poles one; unit radius, centre 0, closed,
// the front outside.
TriangleMesh sphere_mesh(uint32_t rings, uint32_t segments);

// Independent triangles; the corners of each lie in a cube of edge 2 `size`, centred at random in [-1, 1]^3.
TriangleMesh triangle_soup(uint32_t count, float size, uint32_t seed);

void add_triangle(TriangleMesh& mesh, vec3 a, vec3 b, vec3 c);

// Difficult triangles, a quarter each: slivers a million times longer than wide; triangles that overlap in 20
// planes; triangles of sizes from 10^-3 to 10^3; and copies of some of these, every second one with rotated
// corners.
TriangleMesh nasty_mesh(uint32_t count);

// The mesh with every position p replaced by f(p).
TriangleMesh transformed(TriangleMesh mesh, const std::function<vec3(vec3)>& f);

// A scene of that mesh alone, with one material and a camera at the origin.
Scene scene_of_mesh(TriangleMesh mesh);

}  // namespace candela
