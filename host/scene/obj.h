// Wavefront OBJ files.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace candela {

enum class ObjNormals {
    file,    // As the file says (`vn`), flat where it says nothing.
    smooth,  // Averages, as smooth_normals() says.
    flat,
};

// Reads all faces of a file as one mesh, in the units of the file; groups, materials and texture coordinates
// are ignored. Polygons are cut into triangles; corners with equal position and normal share a vertex; unused
// vertices are dropped. Normals may have any length, and one of length zero stands for none; there are no
// normals if no corner has one. Throws Error `file:line: cause` or `file: cause` as read_file() and
// check_obj() do.
TriangleMesh load_obj(const std::filesystem::path& file, ObjNormals normals);

}  // namespace candela
