// The result of sampling a light.
#ifndef LIGHT_SAMPLE_GLSL
#define LIGHT_SAMPLE_GLSL

#include "shared/kernel_constants.h"
#include "shared/light.h"

// True if the light is of that kind. Kinds that the scene does not have leave no code in the kernel, and a scene of one
// kind needs no branch.
bool is_light(LightRecord l, const uint kind) {
    if ((LIGHTS & 1u << kind) == 0u) return false;
    return (LIGHTS & ~(1u << kind)) == 0u || l.kind == kind;
}

// True if the light is a sphere.
bool is_sphere(LightRecord l) {
    return is_light(l, LIGHT_SPHERE) || is_light(l, LIGHT_BEAM);
}

// True if the light has a surface, which rays may hit.
bool light_has_surface(LightRecord l) {
    return !is_light(l, LIGHT_ENVIRONMENT) && !is_light(l, LIGHT_POINT) && !is_light(l, LIGHT_SPOT) &&
           !is_light(l, LIGHT_DIRECTIONAL) && !is_light(l, LIGHT_SUN);
}

// A point in the middle of a light with a place.
vec3 light_middle(LightRecord l) {
    if (is_light(l, LIGHT_TRIANGLE)) return l.p + (l.e1 + l.e2) * (1.0 / 3.0);
    if (is_light(l, LIGHT_PARALLELOGRAM)) return l.p + 0.5 * (l.e1 + l.e2);
    return l.p;
}

// How far it reaches from there, roughly; 0 for a point.
float light_size(LightRecord l) {
    if (is_light(l, LIGHT_POINT) || is_light(l, LIGHT_SPOT)) return 0.0;
    if (is_sphere(l)) return l.e1.x;
    return (is_light(l, LIGHT_DISK) ? 1.0 : 0.5) * sqrt(max(dot(l.e1, l.e1), dot(l.e2, l.e2)));
}

// Shadow rays end earlier by this fraction of their length, a bound on the error of the distance at which a light is
// hit from far away.
const float LIGHT_T_MAX = 1.0 - 1.0 / 524288.0;

// How far before a light, along its normal, a ray from that distance must end, so that it does not hit it: error is the
// light's own; some roundings of the distance come from the differences that an intersection test begins with.
float light_end_error(float error, float distance) {
    return error + 8.0 / 16777216.0 * distance;
}

// A point on a light, as seen from a point that is lit.
struct LightSample {
    vec3 wi;     // Unit direction from the lit point.
    vec3 Li;     // Radiance that arrives if nothing is in between [W/(m^2 sr)]; if delta, its integral over directions.
    float pdf;   // Density over solid angle at the lit point [1/sr]; 0 means that no light arrives.
    bool delta;  // Only light sampling can find it: pdf is the probability of choosing the light.
    vec3 shadow;  // Direction, of any length, of the shadow ray from the lit point.
    float t_max;  // The light is hidden if the shadow ray hits something with t in (0, t_max).
    uint light;   // Its place in the table of lights,
    uint lamp;    // and that of the lamp that has it, or NO_LIGHT.
    vec2 u;       // The random numbers that chose the point on it.
};

#endif
