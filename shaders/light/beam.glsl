// The directions in which a surface emits: in a cone around an axis, or close to its normal.
#ifndef LIGHT_BEAM_GLSL
#define LIGHT_BEAM_GLSL

#include "base/math.glsl"
#include "light/sample.glsl"
#include "scene/scene_data.glsl"

// The factor of what leaves in the unit direction w, in a cone around the unit axis: t^2 with
// t = saturate((cone.x - h) cone.y), where h is 1 - cos of the angle between them, or smoothstep of the same number if
// cone.z is 1 instead of 0. h is half the squared chord, which keeps its digits in narrow cones.
// Ref: Khronos Group 2018, glTF extension KHR_lights_punctual, inner and outer cone angles.
float cone_falloff(vec3 axis, vec3 cone, vec3 w) {
    vec3 chord = w - axis;
    float t = clamp((cone.x - 0.5 * dot(chord, chord)) * cone.y, 0.0, 1.0);
    return t * t * (1.0 + cone.z * (2.0 - 2.0 * t));
}

// The factor of the radiance of a light with a surface in the unit direction w, which has that cosine to its normal.
float beam_falloff(LightRecord l, float cosine, vec3 w) {
    const float GRAZING = 1e-6;  // A cosine by which one may divide.
    float factor = 1.0;
    if (lights_spread()) {
        float tangent = sqrt(max(0.0, 1.0 - square(cosine))) / max(abs(cosine), GRAZING);
        factor = max(0.0, 1.0 - l.spread * tangent);
    }
    if (is_light(l, LIGHT_BEAM)) {
        vec3 cone = vec3(l.e2.x, abs(l.e2.y), l.e2.y < 0.0 ? 1.0 : 0.0);
        factor *= cone_falloff(vec3(l.e1.yz, l.e2.z), cone, w);
    }
    return factor;
}

#endif
