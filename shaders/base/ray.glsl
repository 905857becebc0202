// Rays and where they may start.
#ifndef BASE_RAY_GLSL
#define BASE_RAY_GLSL

// Points o + t d with t > 0. World space [m]; d need not have unit length, and t is in units of its length.
struct Ray {
    vec3 o;
    vec3 d;
};

// Reciprocals of a direction's components. A component near 0 is replaced by a tiny number: planes that the ray would
// never reach are then very far away on either side, and 0 * infinity does not arise.
vec3 reciprocals(vec3 d) {
    const float tiny = 1e-18;
    return 1.0 / mix(d, vec3(tiny), lessThan(abs(d), vec3(tiny)));
}

// Moves p, computed on a surface with the unit normal n, to the side that n points to: by a number of representable
// floats, so that the step grows with the rounding error of p; near 0, where that error is not relative, by a fixed
// step. Ref: Waechter and Binder 2019, A Fast and Robust Method for Avoiding Self-Intersection.
vec3 offset_origin(vec3 p, vec3 n) {
    const float near_zero = 1.0 / 32.0;
    const float near_zero_step = 1.0 / 65536.0;
    const float steps = 256.0;
    ivec3 offset = ivec3(steps * n);
    vec3 moved = intBitsToFloat(floatBitsToInt(p) + mix(offset, -offset, lessThan(p, vec3(0.0))));
    return mix(moved, p + near_zero_step * n, lessThan(abs(p), vec3(near_zero)));
}

// How far off a sphere a point computed on it may lie, and how far off an intersection may be found [m]: some rounding
// errors of centre and radius, which near the coordinate planes are greater than the point's own coordinates tell.
float sphere_error(vec3 center, float radius) {
    vec3 c = abs(center);
    return (max(c.x, max(c.y, c.z)) + radius) * (1.0 / 262144.0);
}

#endif
