// Lights from infinitely far away: in a single direction, or from a disk.
#ifndef LIGHT_DIRECTIONAL_GLSL
#define LIGHT_DIRECTIONAL_GLSL

#include "base/frame.glsl"
#include "base/math.glsl"
#include "base/warp.glsl"
#include "light/sample.glsl"

// The light as seen from anywhere. Its radiance only has an integral over directions, which is its irradiance across
// the direction.
LightSample directional_light_sample_li(LightRecord l) {
    LightSample s;
    s.wi = l.e1;
    s.Li = l.radiance;
    s.pdf = 1.0;
    s.delta = true;
    s.shadow = s.wi;
    s.t_max = FLOAT_MAX;
    return s;
}

// A direction towards the disk of a sun, uniform over its solid angle, from u in [0,1)^2.
LightSample sun_light_sample_li(LightRecord l, vec2 u) {
    LightSample s;
    s.wi = frame_to_world(frame_from_z(l.e1), warp_cone(u, l.e2.x));
    s.Li = l.radiance;
    s.pdf = warp_cone_pdf(l.e2.x);
    s.delta = false;
    s.shadow = s.wi;
    s.t_max = FLOAT_MAX;
    return s;
}

// Whether the unit direction w is one of those; 1 - cos is half the squared chord, which keeps its digits.
bool sun_light_covers(LightRecord l, vec3 w) {
    vec3 chord = w - l.e1;
    return 0.5 * dot(chord, chord) <= l.e2.x;
}

#endif
