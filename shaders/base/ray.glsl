// Rays.
#ifndef BASE_RAY_GLSL
#define BASE_RAY_GLSL

// Points o + t d with t > 0. In the frame of the scene; d need not have unit length, and t is in units of its length.
struct Ray {
    vec3 o;
    vec3 d;
};

// Reciprocals of a direction's components. A component near 0 is replaced by a tiny number: planes that the ray never
// reaches are then very far away on either side, and 0 * infinity does not occur.
vec3 reciprocals(vec3 d) {
    const float tiny = 1e-18;
    return 1.0 / mix(d, vec3(tiny), lessThan(abs(d), vec3(tiny)));
}

#endif
