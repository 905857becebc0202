// From the names in an OBJ file to their materials.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "load/obj/mtl.h"
#include "load/obj/obj.h"

namespace candela {

struct ObjLibraries {
    MtlLibrary materials;   // Materials of all libraries; the first definition of a name is used.
    bool all_there = true;  // Whether none is missing or out of reach.
};

// Reads the libraries that the OBJ file `obj` names. A name is relative to the folder of `obj`, perhaps in
// quotation marks; with spaces, it is one library if there is such a file, otherwise several. If a folder
// does not exist here or is out of reach, the name alone is looked up beside `obj`. A library that is missing
// or out of reach is a warning. Throws Error as load_mtl() does.
ObjLibraries load_mtl_libraries(const std::filesystem::path& obj, const std::vector<ObjName>& names,
                                const FileReach& reach);

// The end of the message about materials that no library has.
std::string materials_of(const MtlLibrary& library);

}  // namespace candela
