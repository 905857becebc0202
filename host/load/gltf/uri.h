// URIs of glTF files: the names of other files, or data in line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/file_reach.h"
#include "load/node.h"

namespace candela::gltf {

// What a `data:` URI holds, decoded from base64; nothing if the URI is of another kind. Throws Error at the
// place of `uri` if it is not base64.
std::optional<std::string> inline_data(const Node& uri);

// The file that a relative URI names, in `folder`: percent-encoded characters are decoded, unless there is a
// file of the undecoded name alone. Throws Error at the place of `uri` for absolute paths, for URIs with a
// scheme (`https:`), for bad encoding, and for files that are out of reach.
std::filesystem::path file_of(const Node& uri, const std::filesystem::path& folder, const FileReach& reach);

}  // namespace candela::gltf
