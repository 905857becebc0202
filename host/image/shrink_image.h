// Smaller versions of texel images.
#pragma once

#include "image/texel_image.h"

namespace candela {

// The meaning of an image's colour channels: fractions of light, or codes of sRGB or of the image's own
// gamma.
enum class TexelCodes { linear, encoded };

// The image, with `longest` texels along its longer side, at least 1, and the other side in proportion;
// unchanged if it is not longer. A texel is the mean of the image over its area: of light, if the image is
// encoded.
TexelImage shrink(TexelImage image, uint32_t longest, TexelCodes codes);

}  // namespace candela
