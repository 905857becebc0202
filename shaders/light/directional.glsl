// Lights from infinitely far away in a single direction.
#ifndef LIGHT_DIRECTIONAL_GLSL
#define LIGHT_DIRECTIONAL_GLSL

#include "base/math.glsl"
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

#endif
