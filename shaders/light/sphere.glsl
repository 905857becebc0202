// Spherical lights, sampled uniformly over solid angle from outside, and over area from inside.
// Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, section 6.2.4.
#ifndef LIGHT_SPHERE_GLSL
#define LIGHT_SPHERE_GLSL

#include "base/frame.glsl"
#include "light/area.glsl"

// 1 - cos of half the angle that a sphere subtends from that squared distance to its centre, which is greater than the
// squared radius. (The quotient may round up to more than 1.)
float sphere_light_cap(float radius, float distance_squared) {
    float sin2_max = min(1.0, square(radius) / distance_squared);
    return sin2_max / (1.0 + sqrt(1.0 - sin2_max));
}

// Whether a point with that squared distance to the centre lies inside. A point on the sphere itself is treated as
// inside, regardless of its rounding: the whole sphere is then in view, not only the near side.
bool sphere_light_encloses(float radius, float distance_squared) {
    const float ROUNDING = 1e-5;
    return distance_squared <= square(radius) * (1.0 + ROUNDING);
}

// A point on the light from u in [0,1)^2.
LightSample sphere_light_sample_li(LightRecord l, vec3 p_lit, vec2 u) {
    float radius = l.e1.x;
    vec3 to_center = l.p - p_lit;
    float distance_squared = dot(to_center, to_center);
    if (sphere_light_encloses(radius, distance_squared)) {
        vec3 n = warp_sphere(u);
        return area_light_sample_at(l, p_lit, l.p + radius * n, n);
    }
    float cap = sphere_light_cap(radius, distance_squared);
    vec3 w = warp_cone(u, cap);
    Frame frame = frame_from_z(to_center * inversesqrt(distance_squared));
    LightSample s;
    s.wi = frame_to_world(frame, w);
    s.pdf = warp_cone_pdf(cap);
    s.delta = false;
    // The normal where wi first hits the sphere, without a difference of two points that are far away.
    float distance = sqrt(distance_squared);
    float sin2_theta = dot(w.xy, w.xy);
    float half_chord = sqrt(max(0.0, square(radius) - distance_squared * sin2_theta));
    float t = distance * w.z - half_chord;
    vec3 n = frame_to_world(frame, vec3(t * w.xy, -distance * sin2_theta - half_chord * w.z) / radius);
    s.Li = area_light_le(l, true, dot(s.wi, n), -s.wi);
    s.shadow = to_center + (radius + light_end_error(l.error, distance)) * n;
    s.t_max = LIGHT_T_MAX;
    return s;
}

// Density [1/sr] with which sphere_light_sample_li finds, from p_lit, the point at that squared distance [m^2] whose
// normal has the cosine cos_light to the ray; `front`: whether the ray meets it from outside.
float sphere_light_pdf_li(LightRecord l, vec3 p_lit, float distance_squared, float cos_light, bool front) {
    vec3 to_center = l.p - p_lit;
    float radius = l.e1.x;
    float center_squared = dot(to_center, to_center);
    if (sphere_light_encloses(radius, center_squared)) return area_light_pdf_li(l, distance_squared, cos_light);
    return front ? warp_cone_pdf(sphere_light_cap(radius, center_squared)) : 0.0;
}

#endif
