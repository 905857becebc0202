// Developing: from radiance to a picture for the screen.
#pragma once

#include "image/background.h"
#include "image/image.h"
#include "image/texel_image.h"
#include "image/tonemap.h"

namespace candela {

struct Development {
    Tonemap curve = Tonemap::linear;
    float exposure_ev = 0.0f;
    TexelType type = TexelType::unorm8;      // Or unorm16.
    const Background* background = nullptr;  // None: the picture shows what the image does; A is ignored.
};

// Develops the channels R, G and B: multiplies by 2^exposure_ev, applies the curve, encodes as sRGB. Throws
// Error if the image lacks one of the channels, or the channel A for a background.
//
// Before a background, R, G and B are premultiplied: they hold the light of the share c of camera rays that
// hit something (FirstHit.A, or A), and A also that of the background which they keep out. The curve applies
// to the mean of these rays, rgb / c, so that an edge is as bright as what it belongs to: D = c
// curve(2^exposure_ev rgb / c). A pixel shows D + (1 - A) B before the light B of a background, at most
// white. Before none it gets the alpha a = max(A, the largest component of D), and the colour D / a: so
// reflections in glass that are brighter than its alpha stay as bright.
TexelImage develop(const Image& image, const Development& development);

// The exposure [EV] that brings the percentile AUTO_PERCENTILE of luminance to AUTO_LUMINANCE, where white is
// 1, before the curve. A pixel has the luminance of rgb / c, as above, and the weight c; those without light
// have none. 0 for an image without light.
inline constexpr double AUTO_PERCENTILE = 95.0, AUTO_LUMINANCE = 0.8;
float auto_exposure(const Image& image);

}  // namespace candela
