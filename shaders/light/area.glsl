// Flat area lights: triangles, parallelograms and disks, sampled uniformly by area.
#ifndef LIGHT_AREA_GLSL
#define LIGHT_AREA_GLSL

#include "base/ray.glsl"
#include "base/warp.glsl"
#include "light/beam.glsl"
#include "light/sample.glsl"
#include "shared/light.h"

// Radiance that leaves a light on its front or back side in the unit direction w, which has that cosine to the normal.
vec3 area_light_le(LightRecord l, bool front, float cosine, vec3 w) {
    return front || l.two_sided != 0u ? l.radiance * beam_falloff(l, cosine, w) : vec3(0.0);
}

// Density [1/sr] with which area_light_sample_li finds the point at that squared distance [m^2] whose normal has the
// cosine cos_light to the ray.
float area_light_pdf_li(LightRecord l, float distance_squared, float cos_light) {
    return cos_light != 0.0 ? l.pdf_area * distance_squared / abs(cos_light) : 0.0;
}

// The sample that is the point p of a light, chosen uniformly by area; n is the unit normal of the front there.
LightSample area_light_sample_at(LightRecord l, vec3 p_lit, vec3 p, vec3 n) {
    LightSample s;
    s.delta = false;
    vec3 to_light = p - p_lit;
    float distance_squared = dot(to_light, to_light);
    float inv_distance = inversesqrt(distance_squared);
    s.wi = to_light * inv_distance;
    float cos_light = -dot(s.wi, n);
    s.Li = area_light_le(l, cos_light > 0.0, cos_light, -s.wi);
    if (cos_light < 0.0) n = -n;
    s.pdf = distance_squared > 0.0 ? area_light_pdf_li(l, distance_squared, cos_light) : 0.0;
    s.shadow = to_light + light_end_error(l.error, distance_squared * inv_distance) * n;
    s.t_max = LIGHT_T_MAX;
    return s;
}

// Surface coordinates of the point on the light that u in [0,1)^2 chooses.
vec2 area_light_coordinates(LightRecord l, vec2 u) {
    if (is_light(l, LIGHT_TRIANGLE)) return warp_triangle(u);
    if (is_light(l, LIGHT_DISK)) return warp_disk(u);
    return u;
}

// A point on the light from u in [0,1)^2.
LightSample area_light_sample_li(LightRecord l, vec3 p_lit, vec2 u) {
    vec2 b = area_light_coordinates(l, u);
    return area_light_sample_at(l, p_lit, l.p + b.x * l.e1 + b.y * l.e2, normalize(cross(l.e1, l.e2)));
}

#endif
