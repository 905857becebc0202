// Albedo without its noise. That of what is seen in mirrors and through glass differs from sample to sample,
// and a denoiser would take the noise for a texture.
#pragma once

#include <vector>

#include "denoise/denoiser.h"

namespace candela {

// The albedo of a picture that has one, for each pixel of `rect`, row-major. Where its variance is known and
// not 0, it is a mean over 5 x 5 pixels, weighted by how far their 3 x 3 pixels differ beyond what the
// variances explain (nonlocal means); elsewhere, and where it is not finite, it is the picture's own, bit by
// bit. A pixel's result does not depend on `rect`.
//
// Ref: Rousselle, Manzi, Zwicker, "Robust Denoising using Feature and Color Information" (2013), on the
// prefiltering of features.
std::vector<vec3> smooth_albedo(const NoisyPicture& picture, const PixelRect& rect);

}  // namespace candela
