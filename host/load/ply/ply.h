// Polygon meshes in PLY files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace candela {

// Reads the elements "vertex" (x y z, and nx ny nz for normals) and "face" (vertex_indices or vertex_index)
// of a file in any of the three formats, in the units of the file; all else is skipped. Polygons are cut into
// triangles. Normals may have any length, and one of length zero stands for none. Bytes after the last
// element are odd but harmless: a warning says how many. Throws Error `file: cause`, or `file:line: cause` in
// a header or an ASCII file, for a file that read_file() or read_ply_header() refuses; that lacks these
// elements; that ends early; whose rows do not match the header; with a coordinate or a used normal that is
// not finite, a face with fewer than 3 or more than MOST_CORNERS corners, or an index that is out of range.
TriangleMesh load_ply(const std::filesystem::path& file, MeshNormals normals,
                      std::vector<std::string>& warnings);

// Reads a file as a scene of its own, in grey; see add_default_view(). Throws Error as load_ply() does.
Scene load_ply_scene(const std::filesystem::path& file);

}  // namespace candela
