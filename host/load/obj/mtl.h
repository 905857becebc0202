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

// Reads a library; mtl_material() says how. The first definition of a name counts. The names of statements
// may be in upper or lower case. With a warning, unknown statements and some textures are ignored, numbers
// that are missing or not finite count as not stated, and those out of range as the nearest in it; Ka, map_Ka
// and sharpness are ignored without. Throws Error as FileReach::read() and parse_mtl_texture() do, and
// `file:line: cause` for a number that is malformed and for a statement before the first newmtl. Does not
// look for images.
MtlLibrary load_mtl(const std::filesystem::path& file, const FileReach& reach);

}  // namespace candela
