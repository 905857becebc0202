// Flat area lights: triangles and parallelograms, sampled uniformly by area.
#ifndef LIGHT_AREA_GLSL
#define LIGHT_AREA_GLSL

#include "base/warp.glsl"
#include "shared/light.h"

// A point on a light, as seen from a reference point.
struct LightSample {
    vec3 p;      // World space [m].
    vec3 n;      // Unit normal of the light on the reference point's side.
    vec3 wi;     // Unit direction from the reference point.
    vec3 Li;     // Radiance that arrives if nothing is between [W/(m^2 sr)].
    float pdf;   // Density over solid angle at the reference point [1/sr]; 0 says that nothing arrives.
};

// Radiance that leaves the light on its front or back side.
vec3 area_light_le(Light l, bool front) {
    return front || l.two_sided != 0u ? l.radiance : vec3(0.0);
}

// A point on the light from u in [0,1)^2; pdf includes the probability of having chosen this light.
LightSample area_light_sample_li(Light l, vec3 p_reference, vec2 u) {
    vec2 b = l.kind == LIGHT_TRIANGLE ? warp_triangle(u) : u;
    LightSample s;
    s.p = l.p + b.x * l.e1 + b.y * l.e2;
    vec3 to_light = s.p - p_reference;
    float distance_squared = dot(to_light, to_light);
    s.wi = to_light * inversesqrt(distance_squared);
    s.n = normalize(cross(l.e1, l.e2));
    float cos_light = -dot(s.wi, s.n);
    s.Li = area_light_le(l, cos_light > 0.0);
    if (cos_light < 0.0) s.n = -s.n;
    s.pdf = distance_squared > 0.0 && cos_light != 0.0 ? l.pdf_area * distance_squared / abs(cos_light) : 0.0;
    return s;
}

// Density [1/sr] with which area_light_sample_li finds the point at that squared distance [m^2], seen under that
// cosine of its normal.
float area_light_pdf_li(Light l, float distance_squared, float cos_light) {
    return cos_light != 0.0 ? l.pdf_area * distance_squared / abs(cos_light) : 0.0;
}

#endif
