// Lights from a point: a sample is always that point, and no ray hits it.
#ifndef LIGHT_POINT_GLSL
#define LIGHT_POINT_GLSL

#include "light/sample.glsl"

// The light as seen from p_lit; no light arrives at the point itself. A shadow ray ends before a surface on which the
// light lies, so that rounding does not decide whether it is hidden.
LightSample point_light_sample_li(LightRecord l, vec3 p_lit) {
    LightSample s;
    s.shadow = l.p - p_lit;
    float distance_squared = dot(s.shadow, s.shadow);
    float inv_distance = inversesqrt(distance_squared);
    s.wi = s.shadow * inv_distance;
    s.Li = l.radiance * inv_distance * inv_distance;
    s.pdf = distance_squared > 0.0 ? 1.0 : 0.0;
    s.delta = true;
    s.t_max = LIGHT_T_MAX;
    return s;
}

#endif
