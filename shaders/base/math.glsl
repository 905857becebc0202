// Small pure functions that several files need.
#ifndef BASE_MATH_GLSL
#define BASE_MATH_GLSL

const float PI = 3.14159265358979;
const float INV_PI = 0.31830988618379;
const float FLOAT_MAX = 3.4028234e38;

float square(float x) {
    return x * x;
}

float max_component(vec3 v) {
    return max(v.x, max(v.y, v.z));
}

// True if no component is NaN or infinite. Looks at the exponent bits, since compilers may assume isnan() away.
bool is_finite(vec3 v) {
    return all(notEqual(floatBitsToUint(v) & 0x7F800000u, uvec3(0x7F800000u)));
}

// (cos x, sin x) for |x| <= pi/4, within 2^-23: Taylor's series, since the built-in functions may be as coarse as 2^-11
// and differ between drivers.
vec2 cos_sin_octant(float x) {
    float y = x * x;
    return vec2(1.0 + y * (-1.0 / 2.0 + y * (1.0 / 24.0 + y * (-1.0 / 720.0 + y * (1.0 / 40320.0)))),
                x * (1.0 + y * (-1.0 / 6.0 + y * (1.0 / 120.0 + y * (-1.0 / 5040.0 + y * (1.0 / 362880.0))))));
}

// Adds x to the compensated sum `sum - compensation`; no contraction, no reordering.
// Ref: Kahan 1965, Further Remarks on Reducing Truncation Errors.
void compensated_add(inout vec3 sum, inout vec3 compensation, vec3 x) {
    precise vec3 y = x - compensation;
    precise vec3 t = sum + y;
    precise vec3 c = (t - sum) - y;
    sum = t;
    compensation = c;
}

#endif
