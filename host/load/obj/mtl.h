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

// Reads a library; mtl_material() says how. The first definition of a name counts. Unknown statements and
// some textures are ignored with a warning; Ka, Tf and sharpness without. Throws Error as FileReach::read()
// and parse_mtl_texture() do, `file:line: cause` for a number that is malformed or out of range and for a
// statement before the first newmtl, and `file: cause` if there is no material. Does not look for images.
MtlLibrary load_mtl(const std::filesystem::path& file, const FileReach& reach);

}  // namespace candela
