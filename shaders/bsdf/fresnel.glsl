// The reflectance of boundaries.
#ifndef BSDF_FRESNEL_GLSL
#define BSDF_FRESNEL_GLSL

#include "base/math.glsl"

// (1 - cos(theta))^5: 0 at normal incidence, 1 at grazing.
float schlick_weight(float cos_theta) {
    float x = clamp(1.0 - cos_theta, 0.0, 1.0);
    return square(square(x)) * x;
}

// Reflectance of a metal whose reflectance at normal incidence is given; cos_theta in [0, 1].
// Ref: Schlick 1994, An Inexpensive BRDF Model for Physically-based Rendering, equation 15.
vec3 fresnel_conductor_schlick(vec3 reflectance, float cos_theta) {
    return reflectance + (vec3(1.0) - reflectance) * schlick_weight(cos_theta);
}

// Cosine of the refracted ray to the normal, positive; 0 at and beyond the critical angle. `sin2_theta` is of the
// incident ray, eta the index of refraction beyond the boundary over that before it. Ref: Snell's law.
float refracted_cosine(float sin2_theta, float eta) {
    return sqrt(max(0.0, 1.0 - sin2_theta / square(eta)));
}

// Reflectance of a dielectric boundary for unpolarised light: Schlick's approximation, with the angle on the side of
// the lower index. That angle reaches 90 degrees when the other one reaches the critical angle, so both sides reflect
// equally. 1 beyond the critical angle, where cos_t is 0.
float fresnel_dielectric_schlick(float cos_o, float cos_t, float eta) {
    float normal = square((eta - 1.0) / (eta + 1.0));
    return mix(normal, 1.0, schlick_weight(eta >= 1.0 ? cos_o : cos_t));
}

// The same by Fresnel's equations.
float fresnel_dielectric_exact(float cos_o, float cos_t, float eta) {
    if (cos_t == 0.0) return 1.0;
    float parallel = (eta * cos_o - cos_t) / (eta * cos_o + cos_t);
    float perpendicular = (cos_o - eta * cos_t) / (cos_o + eta * cos_t);
    return 0.5 * (square(parallel) + square(perpendicular));
}

#endif
