// Material libraries (MTL) of Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/file_reach.h"
#include "load/obj/mtl_material.h"

namespace candela {

struct MtlLibrary {
    std::map<std::string, MtlMaterial, std::less<>> materials;
    std::vector<std::filesystem::path> files;
    std::vector<std::string> warnings;  // `file: ...` or `file:line: ...`.
};

// Reads a library; mtl_material() says how. The first definition of a name is used. The names of statements
// may be in upper or lower case. With a warning, unknown statements, some textures, and numbers that are
// missing or not finite are ignored, and numbers out of range are clamped; Ka, map_Ka and sharpness are
// ignored without a warning. Throws Error as FileReach::read() and parse_mtl_texture() do, and `file:line:
// cause` for a number that is malformed and for a statement before the first newmtl. Does not look for
// images.
MtlLibrary load_mtl(const std::filesystem::path& file, const FileReach& reach);

}  // namespace candela
