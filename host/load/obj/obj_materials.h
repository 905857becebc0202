// From the names in an OBJ file to the materials that they stand for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "load/obj/mtl.h"
#include "load/obj/obj.h"

namespace candela {

struct ObjLibraries {
    MtlLibrary materials;   // Of all libraries; the first definition of a name counts.
    bool all_there = true;  // Whether none is missing or out of reach.
};

// Reads the libraries that the OBJ file `obj` names. A name is relative to the folder of `obj`, perhaps in
// quotation marks; with spaces, it is one library if there is such a file, else several. Where a folder does
// not exist here or is out of reach, the name alone is looked up beside `obj`. A library that is missing or
// out of reach is a warning. Throws Error as load_mtl() does.
ObjLibraries load_mtl_libraries(const std::filesystem::path& obj, const std::vector<ObjName>& names,
                                const FileReach& reach);

// What to say of materials that no library has, after their names.
std::string materials_of(const MtlLibrary& library);

}  // namespace candela
