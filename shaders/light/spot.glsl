// Lights from a point into a cone, which is soft towards its edge.
// Ref: Khronos Group 2018, glTF extension KHR_lights_punctual, inner and outer cone angles.
#ifndef LIGHT_SPOT_GLSL
#define LIGHT_SPOT_GLSL

#include "base/math.glsl"
#include "light/point.glsl"

// The factor of the intensity in the unit direction w, away from the light. It is the reference's, or smoothstep of the
// same number, with 1 - cos as half the squared chord, which keeps its digits in narrow cones.
float spot_light_falloff(LightRecord l, vec3 w) {
    vec3 chord = w - l.e1;
    float t = clamp((l.e2.x - 0.5 * dot(chord, chord)) * l.e2.y, 0.0, 1.0);
    return t * t * (1.0 + l.e2.z * (2.0 - 2.0 * t));
}

// The light as seen from p_lit.
LightSample spot_light_sample_li(LightRecord l, vec3 p_lit) {
    LightSample s = point_light_sample_li(l, p_lit);
    s.Li *= spot_light_falloff(l, -s.wi);
    return s;
}

#endif
