// Images as text, so that a fuzzer need not invent OpenEXR files to change a number in them.
#pragma once

#include <string_view>
#include <vector>

#include "image/image.h"

namespace candela::fuzz {

// Images, each of lines:
//     size WIDTH HEIGHT [X0 Y0 X1 Y1]  begins an image: the picture, and the part of it that the image is
//     channel NAME [VALUE...]          its values, repeated for all pixels; half NAME: of 16 bits
//     text NAME WORDS...               an attribute
//     float NAME VALUE
// Other lines are skipped. What no reader of ours returns, such as a crop outside the picture, is made to
// fit; a picture is at most 16x16 pixels.
std::vector<Image> parse_images(std::string_view text);

}  // namespace candela::fuzz
