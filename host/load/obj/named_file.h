// Files that are named by other files.
#pragma once

#include <filesystem>
#include <string>

#include "base/file_reach.h"

namespace candela {

struct NamedFile {
    std::filesystem::path path;  // The file, or where it would be.
    bool is_there = false;       // False for files out of reach, whether they exist or not.
};

// The file that an OBJ or MTL file in `folder` calls by this name, as programs write names: relative or
// absolute, with backslashes, in quotation marks, before a comment. If its folder does not exist here, such
// as C:\models, or is out of reach, the name alone is looked up in `folder`.
NamedFile find_named_file(const std::filesystem::path& folder, std::string name, const FileReach& reach);

}  // namespace candela
