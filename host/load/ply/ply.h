// Polygon meshes in PLY files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/file_reach.h"
#include "scene/mesh.h"

namespace candela {

// Reads the elements "vertex" (x y z, and what find_vertex_fields() finds), "face" and "tristrips" (each
// vertex_indices or vertex_index) of a file in any of the three formats, in the units of the file; everything
// else is skipped. Polygons are cut into triangles. Normals may have any length; length zero means that there
// is none. `warnings` gets what is odd but usable, each beginning with the file's name. Throws Error as
// FileReach::read(), read_ply_header() and finish_vertices() do, and `file: cause`, or `file:line: cause` in
// a header or an ASCII file, if the file lacks vertices or faces, ends early, or has rows that do not match
// the header, a face with more than MAX_CORNERS corners, or an index that is out of range.
TriangleMesh load_ply(const std::filesystem::path& file, MeshNormals normals, const FileReach& reach,
                      std::vector<std::string>& warnings);

// Reads a file as a scene of its own, of default_material(); see add_default_view(). Throws Error as
// load_ply() does.
Scene load_ply_scene(const std::filesystem::path& file);

}  // namespace candela
