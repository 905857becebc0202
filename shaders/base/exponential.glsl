// Exponential and logarithm to the last digits of a float: the built-in functions are too coarse for narrow lobes (at
// an exponent of 10^5 an error of 2^-22 in the logarithm is one of 2 % in the power), and differ between drivers.
// Errors are stated for sums and products that are rounded to the nearest number; Vulkan lets a device take either
// neighbour, which may double them.
#ifndef BASE_EXPONENTIAL_GLSL
#define BASE_EXPONENTIAL_GLSL

// log(1 + x) for x in [-1, 0], within 8 * 2^-24 of itself also where x is tiny (5 of them are what Vulkan grants a
// division); about -88 in the place of minus infinity, at x = -1.
//
// Where 1 + x needs no reduction its rounding is avoided: with s = f / (2 + f) and 1 + f the mantissa,
// log(1 + f) = 2 (s + s^3/3 + s^5/5 + ...), |s| < 0.172.
float log1p_nonpositive(float x) {
    const float ln2_high = 0.693145751953125;  // 17 bits: its multiples up to 127 are exact.
    const float ln2_low = 1.42860682030941723e-6;
    float f = x;
    float exponent = 0.0;
    if (x < -0.2929) {  // 1 + x below sqrt(1/2).
        uint bits = floatBitsToUint(1.0 + x);
        uint shifted = bits - 0x3F3504F3u;  // Steps of the exponent at sqrt(1/2), so that the mantissa is around 1.
        int steps = int(shifted) >> 23;
        f = uintBitsToFloat(bits - (uint(steps) << 23u)) - 1.0;
        exponent = float(steps);
    }
    float s = f / (2.0 + f);
    float z = s * s;
    float series = z * (1.0 / 3.0 + z * (1.0 / 5.0 + z * (1.0 / 7.0 + z * (1.0 / 9.0))));
    return exponent * ln2_high + (2.0 * (s + s * series) + exponent * ln2_low);
}

// exp(x) = (1 + p) 2^k with k whole and |log(1 + p)| <= log(2) / 2, for x in [-87, 0].
struct ExpParts {
    float p;
    float scale;  // 2^k
};

ExpParts exp_parts(float x) {
    const float ln2_high = 0.693145751953125;
    const float ln2_low = 1.42860682030941723e-6;
    float k = floor(x * 1.44269504088896 + 0.5);
    precise float r = (x - k * ln2_high) - k * ln2_low;  // In this order: the first difference is exact.
    float p = r * (1.0 + r * (1.0 / 2.0 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0 +
              r * (1.0 / 5040.0 + r * (1.0 / 40320.0))))))));
    return ExpParts(p, uintBitsToFloat(uint(int(k) + 127) << 23u));
}

// exp(x) for x <= 0, within 2 * 2^-24 of itself; 0 below x = -87, where floats become denormal. The product is exact.
// (scale + scale * p would be denormal on the way, and a device may flush that to zero.)
float exp_nonpositive(float x) {
    if (x < -87.0) return 0.0;
    ExpParts e = exp_parts(x);
    return e.scale * (1.0 + e.p);
}

// exp(x) - 1 for x <= 0, within 3 * 2^-24 of itself also where x is tiny.
float expm1_nonpositive(float x) {
    if (x < -87.0) return -1.0;
    ExpParts e = exp_parts(x);
    return e.scale * e.p + (e.scale - 1.0);
}

#endif
