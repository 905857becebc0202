// What the kernel that shows the accumulation image shares with the host: push constants, bindings and
// specialization constants.
#ifndef SHARED_DISPLAY_H
#define SHARED_DISPLAY_H

#include "shared/types.h"

#ifdef __cplusplus
namespace candela {
#endif

// Pictures are row-major from the top, one word per pixel: four bytes, red lowest, alpha highest.
struct DisplayPush {
    uvec2 size;            // Pixels of the window.
    uvec2 image_size;      // Pixels of the accumulation image, which is stretched over the window.
    uvec2 overlay_origin;  // The rectangle of the window that the overlay covers.
    uvec2 overlay_size;
    float exposure_scale;  // Factor of the radiance before the tone curve.
};

const uint DISPLAY_BINDING_IMAGE = 0u;    // The accumulation image.
const uint DISPLAY_BINDING_OVERLAY = 1u;  // overlay_size pixels, sRGB codes premultiplied by alpha.
const uint DISPLAY_BINDING_PICTURE = 2u;  // The developed picture without the overlay.
const uint DISPLAY_BINDING_SCREEN = 3u;   // The picture with the overlay, its bytes in the window's order.

// Specialization constants.
const uint DISPLAY_CONSTANT_CURVE = 0u;       // TONEMAP_*
const uint DISPLAY_CONSTANT_BLUE_FIRST = 1u;  // 1: the screen's lowest byte is blue.
const uint DISPLAY_CONSTANT_COUNT = 2u;

// Tone curves.
const uint TONEMAP_LINEAR = 0u;
const uint TONEMAP_REINHARD = 1u;
const uint TONEMAP_ACES = 2u;
const uint TONEMAP_AGX = 3u;
const uint TONEMAP_NEUTRAL = 4u;

#ifdef __cplusplus
}  // namespace candela
#endif

#endif
