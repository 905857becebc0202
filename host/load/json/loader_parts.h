// The parts of the scene loader, each of which reads one value of the scene file into structs. All throw
// Error, at the place of what is wrong.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "load/json/keys.h"
#include "load/json/loader_textures.h"
#include "load/json/shape_list.h"
#include "load/node.h"
#include "scene/load_progress.h"
#include "scene/scene.h"

namespace candela {

// Reads a camera, whose key is its name; its film must have the aspect ratio of `film`.
Camera read_camera(const Node& node, const Film& film);

// Reads a material, whose key is its name.
Material read_material(const Node& node, const ImageFolder& images);

// Reads some values of a material, which has the others of `before`. The images of its textures are those of
// images.scene.
Material read_changed_material(const Node& node, const ImageFolder& images, const Material& before);

// The same for the values of its model.
void change_values(const Node& node, const ImageFolder& images, PrincipledMaterial& material);

// Reads the keys of a medium, if there is any of them: "absorption" and "scattering".
std::optional<Medium> find_medium(const Node& node);

// Reads the object "subsurface" into the material's diffuse transmission; returns the medium inside, if the
// surface is no thin wall.
std::optional<Medium> read_subsurface(const Node& node, bool thin, PrincipledMaterial& material);

// Reads the object "medium": the medium around everything.
Medium read_medium(const Node& node);

using MaterialModel = decltype(Material::model);

// Each reads a PrincipledMaterial: with all of its keys, or as a metal or glass with a few.
MaterialModel read_principled(const Node& node, const ImageFolder& images);
MaterialModel read_rough_conductor(const Node& node, const ImageFolder& images);
MaterialModel read_rough_dielectric(const Node& node, const ImageFolder& images);

// A direction of any length but 0.
dvec3 direction_of(const Node& node);

// Reads the keys of a cone that an object has.
Cone read_cone(const Node& node);

// Reads the list of lights without a surface, in its order. scene.warnings gets what is odd.
std::vector<Light> read_lights(const Node& node, Scene& scene);

// Reads the light from infinitely far away that an object has, "environment" or "sky". A file is relative to
// `folder` and goes to scene.files; what is odd goes to scene.warnings.
std::optional<Environment> read_distant_light(const Node& root, const std::filesystem::path& folder,
                                              Scene& scene);

// Reads the list of shapes into the scene, with their meshes, files and warnings; and the objects, if there
// are any, that instances among the shapes place. Files are relative to `folder`. scene.materials must hold
// the scene file's; it gets those that the shapes bring: black for emitters without a material, and those of
// OBJ files.
void read_shapes(const Node& node, const std::optional<Node>& objects, const std::filesystem::path& folder,
                 Scene& scene, const LoadProgress& progress);

// Reads the triangles of a mesh, and what their corners have, in the space of its shape. Arrays are the
// scene's.
TriangleMesh read_triangle_mesh(const Node& node, const Scene& scene);

// Round shapes: "sphere" and "disk".
void read_sphere(const Node& node, ShapeList& shapes);
void read_disk(const Node& node, ShapeList& shapes);

// Shapes that are read from files of their own.
void read_obj(const Node& node, ShapeList& shapes);
void read_ply(const Node& node, ShapeList& shapes);

}  // namespace candela
