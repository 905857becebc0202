// Develops the accumulation image for a window: the mean of each pixel's samples, exposure, tone curve and sRGB, under
// an overlay. A pixel without samples keeps its previous colour.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "base/tonemap.glsl"
#include "shared/constants.h"
#include "shared/display.h"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(constant_id = DISPLAY_CONSTANT_CURVE) const uint CURVE = TONEMAP_LINEAR;
layout(constant_id = DISPLAY_CONSTANT_BLUE_FIRST) const bool BLUE_FIRST = false;

layout(binding = DISPLAY_BINDING_IMAGE, rgba32f) uniform readonly image2DArray accumulation;
layout(std430, binding = DISPLAY_BINDING_OVERLAY) readonly buffer OverlayBlock {
    uint overlay[];
};
layout(std430, binding = DISPLAY_BINDING_PICTURE) buffer PictureBlock {
    uint picture[];
};
layout(std430, binding = DISPLAY_BINDING_SCREEN) writeonly buffer ScreenBlock {
    uint screen[];
};
layout(push_constant) uniform DisplayBlock {
    DisplayPush push;
};

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.size))) return;
    uint index = at.y * push.size.x + at.x;

    uvec2 pixel = at * push.image_size / push.size;
    vec4 sum = imageLoad(accumulation, ivec3(pixel, LAYER_L));
    vec4 compensation = imageLoad(accumulation, ivec3(pixel, LAYER_L_COMPENSATION));
    if (compensation.a > 0.0) {
        vec3 mean = (sum.rgb - compensation.rgb) / compensation.a;
        picture[index] = packUnorm4x8(vec4(encode_srgb(tonemap(CURVE, push.exposure_scale * mean)), 1.0));
    }

    vec4 colour = unpackUnorm4x8(picture[index]);
    uvec2 under = at - push.overlay_origin;  // Wraps to a huge number left of the overlay and above it.
    if (all(lessThan(under, push.overlay_size))) {
        vec4 above = unpackUnorm4x8(overlay[under.y * push.overlay_size.x + under.x]);
        colour.rgb = above.rgb + (1.0 - above.a) * colour.rgb;
    }
    if (BLUE_FIRST) colour = colour.bgra;
    screen[index] = packUnorm4x8(colour);
}
