// What a picture for the screen stands before, where it shows nothing of its scene.
#pragma once

#include <variant>
#include <vector>

#include "image/image.h"
#include "image/texel_image.h"
#include "image/tonemap.h"

namespace candela {

// The picture gets an alpha channel.
struct Transparent {};

// Nothing; a colour as light of the display, linear Rec.709 in [0, 1]; or an image that covers the picture.
using Background = std::variant<Transparent, vec3, TexelImage>;

// The light of the display behind the pixels of `rect`, row-major, in a whole picture of `full` pixels. The
// image keeps its proportions, fills the whole picture, and is cut evenly on both sides where it is longer.
// It is scaled in linear light, by a triangle as wide as two texels or two pixels, whichever is more. Codes
// of integers are sRGB, unless the image has a gamma; halves are light like the scene's, which is multiplied
// by `scale` and developed with the curve. Transparent texels are black.
std::vector<vec3> background_light(const TexelImage& image, uvec2 full, const PixelRect& rect, Tonemap curve,
                                   float scale);

}  // namespace candela
