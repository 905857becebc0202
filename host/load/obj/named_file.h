// Files that other files name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace candela {

// The file that an OBJ or MTL file in `folder` calls by this name, as programs write names: relative or
// absolute, with backslashes, in quotation marks, before a comment. Of a folder that does not exist here,
// such as C:\models, the name alone is looked up in `folder`. Nothing if there is no such file.
std::optional<std::filesystem::path> find_named_file(const std::filesystem::path& folder, std::string name);

}  // namespace candela
