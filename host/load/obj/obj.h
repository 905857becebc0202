// Wavefront OBJ files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace candela {

// Reads all faces of a file as one mesh, in the units of the file; groups, materials and texture coordinates
// are ignored. Polygons are cut into triangles; corners with equal position and normal share a vertex; unused
// vertices are dropped. Normals may have any length, and one of length zero stands for none; there are no
// normals if no corner has one. Throws Error `file:line: cause` or `file: cause` as read_file() and
// check_obj() do.
TriangleMesh load_obj(const std::filesystem::path& file, MeshNormals normals);

// A name that an OBJ file mentions, and the line where it does, counted from 1.
struct ObjName {
    std::string name;
    uint64_t line = 0;
};

// The faces of one material.
struct ObjPart {
    std::optional<ObjName> material;  // Its first `usemtl`; none: the faces stand before any `usemtl`.
    uint64_t faces = 0;
    TriangleMesh mesh;  // Has at least one triangle.
};

struct ObjParts {
    std::vector<ObjName> libraries;  // What each `mtllib` names, in the order of the file.
    std::vector<ObjPart> parts;      // For each material that a face uses, in the order of first use.
};

// Reads a file as load_obj() does, but one mesh for each material; smooth normals are averaged over all of
// them together. The libraries are not read. Throws Error for `usemtl` and `mtllib` without a name, too.
ObjParts load_obj_parts(const std::filesystem::path& file, MeshNormals normals);

}  // namespace candela
