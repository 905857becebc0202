// Files that no other user can have made or changed, such as a cache of executable code. They belong to this
// user, and are in a folder of this user where nobody else may write. A link in place of a file or of the
// folder is not followed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace candela {

// The bytes of such a file; nothing if it is missing, is not such a file, or has more than `max` bytes.
std::optional<std::string> read_private_file(const std::filesystem::path& folder, const std::string& name,
                                             size_t max);

// Writes such a file, whole or not at all; `folder` is absolute, and made if it is missing. Does nothing in a
// folder that others own or may write to, or if the name belongs to something other than a file. Throws
// std::system_error if writing fails.
void write_private_file(const std::filesystem::path& folder, const std::string& name, std::string_view bytes);

}  // namespace candela
