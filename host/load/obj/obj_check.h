// What tinyobjloader lets through and should not: it reads a malformed number as 0 and takes any index.
#pragma once

#include <string>
#include <string_view>

namespace candela {

// Checks the text of a Wavefront OBJ file; `file` is its name in messages. Throws Error `file:line: cause`
// for a vertex or normal without three finite numbers, a face with fewer than 3 or more than 1024 corners, a
// malformed index or one that is out of range, and Error `file: cause` if there is no face at all.
void check_obj(std::string_view text, const std::string& file);

}  // namespace candela
