// Lights from a point into a cone, which is soft towards its edge.
#ifndef LIGHT_SPOT_GLSL
#define LIGHT_SPOT_GLSL

#include "base/math.glsl"
#include "base/ray.glsl"
#include "light/beam.glsl"
#include "light/point.glsl"

// From where to where a ray with a unit direction is in the cone, in lengths of the ray; the ends are equal if nowhere.
vec2 spot_light_chord(LightRecord l, Ray ray) {
    // Points o + t d with (v . axis)^2 - cos^2 v^2 > 0, v = o + t d - l.p, where v . axis > 0.
    float cosine = max(1.0 - l.e2.x, 0.0);
    vec3 v = ray.o - l.p;
    float along = dot(ray.d, l.e1), height = dot(v, l.e1), c2 = cosine * cosine;
    float a = along * along - c2, b = height * along - c2 * dot(v, ray.d), c = height * height - c2 * dot(v, v);
    float square_of_root = b * b - a * c;
    if (square_of_root <= 0.0 || a == 0.0) return vec2(0.0);
    float root = sqrt(square_of_root);
    vec2 t = vec2(-b - root, -b + root) / a;
    if (a < 0.0) {
        t = t.yx;
        return height + 0.5 * (t.x + t.y) * along > 0.0 ? t : vec2(0.0);
    }
    return along > 0.0 ? vec2(t.y, FLOAT_MAX) : vec2(-FLOAT_MAX, t.x);
}

// The light as seen from p_lit.
LightSample spot_light_sample_li(LightRecord l, vec3 p_lit) {
    LightSample s = point_light_sample_li(l, p_lit);
    s.Li *= cone_falloff(l.e1, l.e2, -s.wi);
    return s;
}

#endif
