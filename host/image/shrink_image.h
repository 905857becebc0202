// Smaller versions of texel images.
#pragma once

#include "image/texel_image.h"

namespace candela {

// What the numbers of an image's colour channels are: shares of light, or codes of sRGB or, if the image has
// a gamma, of that.
enum class TexelCodes { linear, encoded };

// The image, with `longest` texels along its longer side, at least 1, and the other side in proportion; as it
// is if it is not longer. A texel is the mean of the image over its area: of the light, if that is encoded.
TexelImage shrink(TexelImage image, uint32_t longest, TexelCodes codes);

}  // namespace candela
