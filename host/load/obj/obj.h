// Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/file_reach.h"
#include "load/obj/obj_file.h"
#include "scene/mesh.h"
#include "scene/scene_builder.h"

namespace candela {

// Reads all faces of a file as one mesh, in the units of the file; objects, groups and materials are ignored.
// Polygons are cut into triangles; corners with the same indices share a vertex, unless many others lie
// there; unused vertices are dropped. A corner without texture coordinates gets (0, 0), but a mesh has none
// if all of its corners lack them. With MeshNormals::file, a corner without a normal gets one of length zero,
// and a file without normals gives a mesh without normals. `warnings` gets what is odd but usable. Throws
// Error as FileReach::read() and parse_obj() do.
TriangleMesh load_obj(const std::filesystem::path& file, MeshNormals normals, const FileReach& reach,
                      std::vector<std::string>& warnings);

// The faces of one material.
struct ObjPart {
    std::optional<ObjName> material;  // The `usemtl` of its first face; nothing if there is none, or if it
                                      // has no name.
    uint64_t faces = 0;
    TriangleMesh mesh;  // Has at least one triangle.
};

struct ObjParts {
    std::vector<ObjName> libraries;   // The names after each `mtllib`, in the order of the file.
    std::vector<ObjPart> parts;       // One for each material in use, in the order of first use.
    std::vector<std::string> groups;  // As in ObjFile; the meshes say which triangles belong to which.
    std::vector<std::string> warnings;
};

// Reads a file as load_obj() does, but into one mesh per material; smooth normals are averaged across them.
// Does not read the libraries.
ObjParts load_obj_parts(const std::filesystem::path& file, MeshNormals normals, const FileReach& reach);

// A file with the materials that it names.
struct ObjShape {
    std::vector<MeshPart> parts{};
    std::vector<std::string> groups{};    // As in ObjParts.
    bool has_materials = false;           // Whether any face has one; if not, all are grey.
    std::vector<std::string> warnings{};  // `file:line: ...` or `file: ...`.
};

// Reads a file as load_obj_parts() does, and its libraries. Adds the materials to the scene as
// `name`/material, unless a shape of that name has already done so, and the files to Scene::files. Faces are
// grey, or have the colours of their vertices, if their material is not in any library (with a warning) or if
// they have none (with a warning if other faces have one). A library that is missing or out of reach is a
// warning, too. For missing images or texture coordinates, see ImageFile and SceneBuilder. Throws Error as
// load_mtl() does.
ObjShape load_obj_shape(const std::filesystem::path& file, MeshNormals normals, const std::string& name,
                        SceneBuilder& builder);

// Reads a file as a scene of its own, as load_obj_shape() does; see add_default_view(). `reach` allows files
// outside its folder.
Scene load_obj_scene(const std::filesystem::path& file, const ReachOptions& reach = {});

}  // namespace candela
