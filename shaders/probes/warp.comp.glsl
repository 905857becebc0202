// For selftest/warps.h: item (u, exponent n, h_max; direction w, alpha; number of corners). All warps of the point u of
// the unit square.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 3u
#define RESULT_WORDS 28u
#include "base/pixel_filter.glsl"
#include "base/warp.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    vec4 v = item_floats(0u);
    vec3 direction = warp_cosine_hemisphere(v.xy);
    put(warp_disk(v.xy));
    put(direction);
    put(warp_cosine_hemisphere_pdf(direction.z));
    put(warp_triangle(v.xy));
    put(warp_power_cosine(v.xy, v.z));
    put(warp_sphere(v.xy));
    put(warp_cone(v.xy, v.w));
    put(warp_ggx_visible_normal(v.xy, item_floats(1u).w, item_floats(1u).xyz));
    put(warp_polygon(v.xy, item(2u).x));
    put(filter_tent(v.xy));
    put(filter_gaussian(v.xy));
    put(filter_blackman_harris(v.xy));
}
