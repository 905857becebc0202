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

// The lesser and the greater of two numbers that are not NaN. With `precise`, each is one instruction on software
// Vulkan; min and max are three, to handle NaN.
float lesser(float a, float b) {
    precise float x = a < b ? a : b;
    return x;
}

float greater(float a, float b) {
    precise float x = a < b ? b : a;
    return x;
}

vec2 lesser(vec2 a, vec2 b) {
    return vec2(lesser(a.x, b.x), lesser(a.y, b.y));
}

vec2 greater(vec2 a, vec2 b) {
    return vec2(greater(a.x, b.x), greater(a.y, b.y));
}

// True if no component is NaN or infinite. Tests the exponent bits, since compilers may optimise isnan() away.
bool is_finite(vec3 v) {
    return all(notEqual(floatBitsToUint(v) & 0x7F800000u, uvec3(0x7F800000u)));
}

// Signs of numbers that are not NaN; 0 has no sign. On software Vulkan, comparing bits is one instruction, comparing
// floats three, to handle NaN.
bool all_positive(vec4 v) {
    ivec4 bits = floatBitsToInt(v);
    return min(min(bits.x, bits.y), min(bits.z, bits.w)) > 0;
}

bool all_negative(vec4 v) {
    uvec4 bits = floatBitsToUint(v);
    return min(min(bits.x, bits.y), min(bits.z, bits.w)) > 0x80000000u;
}

bool any_positive(vec3 v) {
    ivec3 bits = floatBitsToInt(v);
    return max(bits.x, max(bits.y, bits.z)) > 0;
}

bool any_negative(vec3 v) {
    uvec3 bits = floatBitsToUint(v);
    return max(bits.x, max(bits.y, bits.z)) > 0x80000000u;
}

// (cos x, sin x) for |x| <= pi/4, within 2^-23: Taylor's series, since the built-in functions may be as coarse as 2^-11
// and differ between drivers.
vec2 cos_sin_octant(float x) {
    float y = x * x;
    return vec2(1.0 + y * (-1.0 / 2.0 + y * (1.0 / 24.0 + y * (-1.0 / 720.0 + y * (1.0 / 40320.0)))),
                x * (1.0 + y * (-1.0 / 6.0 + y * (1.0 / 120.0 + y * (-1.0 / 5040.0 + y * (1.0 / 362880.0))))));
}

// (cos, sin) of 2 pi t for t in [0, 1], as precise as cos_sin_octant.
vec2 cos_sin_turn(float t) {
    float quarter = floor(4.0 * t + 0.5);
    vec2 w = cos_sin_octant((2.0 * PI) * (t - 0.25 * quarter));
    switch (uint(quarter) & 3u) {
        case 0u: return w;
        case 1u: return vec2(-w.y, w.x);
        case 2u: return -w;
        default: return vec2(w.y, -w.x);
    }
}

// The angle of the point (x, y) in turns: atan(y, x) / 2 pi, in [0, 1]; within 2^-23; 0 for the origin. The built-in
// function may be as coarse as 2^-12. The polynomial is the Chebyshev interpolant of atan(q) / q in q^2 on [0, 1], with
// a relative error of 2e-8.
float angle_turn(float y, float x) {
    vec2 a = abs(vec2(x, y));
    float q = min(a.x, a.y) / max(max(a.x, a.y), 1e-37);
    float z = q * q;
    // clang-format off
    float atan_q = q * (0.999999982 + z * (-0.333330367 + z * (0.19991872 + z * (-0.141977978 + z * (0.106183706 +
                   z * (-0.0745685483 + z * (0.0421376236 + z * (-0.0157312491 + z * 0.0027662835))))))));
    // clang-format on
    float turn = atan_q * (0.5 * INV_PI);
    if (a.y > a.x) turn = 0.25 - turn;
    if (x < 0.0) turn = 0.5 - turn;
    return y < 0.0 ? 1.0 - turn : turn;
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
