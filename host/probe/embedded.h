// Files of the repository, embedded byte for byte, so that the program needs no other files.
#pragma once

#include <string_view>

namespace candela::embedded {

extern const std::string_view cornell_box_json, furnace_json;
// The Cornell box by an independent renderer: R G B and Variance.
extern const std::string_view cornell_box_exr;

}  // namespace candela::embedded
