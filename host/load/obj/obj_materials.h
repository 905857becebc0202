// From the names in an OBJ file to the materials that they stand for.
#pragma once

#include <filesystem>
#include <vector>

#include "load/obj/mtl.h"
#include "load/obj/obj.h"

namespace candela {

// Reads the libraries that the OBJ file `obj` names, each relative to the file's folder, and merges them: the
// first definition of a name counts. A name with spaces is one library if there is such a file, else several.
// Throws Error `file:line: cause` for a library that is missing or out of reach, and as load_mtl() does.
MtlLibrary load_mtl_libraries(const std::filesystem::path& obj, const std::vector<ObjName>& names,
                              const FileReach& reach);

// The material that the OBJ file `obj` calls by this name. Throws Error `file:line: cause` if there is none.
const MtlMaterial& find_mtl_material(const MtlLibrary& library, const std::filesystem::path& obj,
                                     const ObjName& name);

}  // namespace candela
