// Exponential and logarithm to nearly the full precision of a float: the built-in functions are too coarse for narrow
// lobes (with an exponent of 10^5, an error of 2^-22 in the logarithm becomes one of 2 % in the power), and differ
// between drivers. The errors stated here assume that sums and products are rounded to the nearest number; Vulkan
// allows either neighbour, which may double them.
#ifndef BASE_EXPONENTIAL_GLSL
#define BASE_EXPONENTIAL_GLSL

// log(1 + x) for x in [-1, 0], with a relative error of at most 8 * 2^-24, even for tiny x (Vulkan allows a division 5
// * 2^-24 of it); about -88 instead of minus infinity at x = -1.
//
// Without range reduction, 1 + x is never rounded: f = x. With the mantissa 1 + f and s = f / (2 + f), log(1 + f) = 2
// (s + s^3/3 + s^5/5 + ...), |s| < 0.172.
float log1p_nonpositive(float x) {
    const float ln2_high = 0.693145751953125;  // 17 bits: its multiples up to 127 are exact.
    const float ln2_low = 1.42860682030941723e-6;
    float f = x;
    float exponent = 0.0;
    if (x < -0.2929) {  // 1 + x below sqrt(1/2).
        uint bits = floatBitsToUint(1.0 + x);
        uint shifted = bits - 0x3F3504F3u;  // The exponent steps at sqrt(1/2), so the mantissa is around 1.
        int steps = int(shifted) >> 23;
        f = uintBitsToFloat(bits - (uint(steps) << 23u)) - 1.0;
        exponent = float(steps);
    }
    float s = f / (2.0 + f);
    float z = s * s;
    float series = z * (1.0 / 3.0 + z * (1.0 / 5.0 + z * (1.0 / 7.0 + z * (1.0 / 9.0))));
    return exponent * ln2_high + (2.0 * (s + s * series) + exponent * ln2_low);
}

// A number with the density exp(-x), from 32 random bits: at least 0, at most 22.9.
float exponential_sample(uint bits) {
    const float ln2 = 0.693147180559945;
    // u = m / 2^steps in [2^-33, 1], with m in [1/2, 1).
    float u = float(bits >> 8u) * (1.0 / 16777216.0) + (float(bits & 255u) + 0.5) * (1.0 / 4294967296.0);
    uint u_bits = floatBitsToUint(u);
    float steps = float(126 - int(u_bits >> 23u));
    float m = uintBitsToFloat((u_bits & 0x7FFFFFu) | 126u << 23u);
    return max(0.0, steps * ln2 - log1p_nonpositive(m - 1.0));
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
    // clang-format off
    float p = r * (1.0 + r * (1.0 / 2.0 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0 +
              r * (1.0 / 5040.0 + r * (1.0 / 40320.0))))))));
    // clang-format on
    return ExpParts(p, uintBitsToFloat(uint(int(k) + 127) << 23u));
}

// exp(x) for x <= 0, with a relative error of at most 2 * 2^-24; 0 below x = -87, where floats become denormal. The
// product is exact. (In scale + scale * p, the product could be denormal, and a device may flush it to zero.)
float exp_nonpositive(float x) {
    if (x < -87.0) return 0.0;
    ExpParts e = exp_parts(x);
    return e.scale * (1.0 + e.p);
}

// exp(x) - 1 for x <= 0, with a relative error of at most 3 * 2^-24, even for tiny x.
float expm1_nonpositive(float x) {
    if (x < -87.0) return -1.0;
    ExpParts e = exp_parts(x);
    return e.scale * e.p + (e.scale - 1.0);
}

#endif
