// Samplers: two words of random bits for a pair of dimensions, as a pure function of (pixel, n, seed, pair); and a
// third for a choice at the point of the pair.
//
// All three are counter-based: their only state is the counters, so that any sample of any pixel can be made anywhere,
// at any time, in any order.
#ifndef BASE_SAMPLER_GLSL
#define BASE_SAMPLER_GLSL

#include "base/hash.glsl"
#include "shared/kernel_constants.h"

// Identifies one sample: pixel of the whole picture (x | y << 16, each below 65 536), sample index, seed.
struct Sampler {
    uint pixel;
    uint n;
    uint seed;
};

Sampler sampler_make(uvec2 pixel, uint n, uint seed) {
    return Sampler(pixel.x | pixel.y << 16u, n, seed);
}

// The top 24 bits as a float in [0, 1).
float unit_float(uint bits) {
    return float(bits >> 8u) * (1.0 / 16777216.0);
}

vec2 unit_float(uvec2 bits) {
    return vec2(unit_float(bits.x), unit_float(bits.y));
}

// A permutation of 0..63 chosen by the hash: odd multiples, offsets and xor-shifts are each invertible modulo 64.
uint permute_64(uint i, uint hash) {
    for (uint round = 0u; round < 3u; ++round) {
        i = (i * ((hash & 62u) | 1u) + (hash >> 6u)) & 63u;
        i ^= i >> 3u;
        hash = (hash >> 10u) | (hash << 22u);
    }
    return i;
}

// One jittered sample in each cell of an 8 x 8 grid, and in each of 64 intervals of the third word; both are visited in
// a new order every 64 samples.
uvec3 stratified_triple(Sampler s, uint pair) {
    uvec2 order = hash_pcg4d(uvec4(s.pixel, s.n >> 6u, pair, ~s.seed)).xy;
    uint cell = permute_64(s.n & 63u, order.x);
    uint interval = permute_64(s.n & 63u, order.y);
    uvec3 jitter = hash_pcg4d(uvec4(s.pixel, s.n, pair, s.seed)).xyz;
    return uvec3((uvec2(cell, cell >> 3u) & 7u) << 29u | jitter.xy >> 3u, interval << 26u | jitter.z >> 6u);
}

// Multiplies the bits of i by the Pascal matrix modulo 2, i.e. substitutes x + 1 for x in the polynomial over
// GF(2) whose coefficients are those bits: the second Sobol dimension of i, bit-reversed. A polynomial splits into
// hi(x) x^16 + lo(x), and (x+1)^16 = x^16 + 1, so one xor folds each level.
uint pascal_multiply(uint i) {
    i ^= i >> 16u;
    i ^= (i >> 8u) & 0x00FF00FFu;
    i ^= (i >> 4u) & 0x0F0F0F0Fu;
    i ^= (i >> 2u) & 0x33333333u;
    i ^= (i >> 1u) & 0x55555555u;
    return i;
}

// Quotient and remainder of n(x), whose coefficients over GF(2) are the bits of each group of 4 k, by (x^2 + x + 1)^k,
// for a power of two k, in the upper and the lower 2 k bits of the group; `low` are the k lowest bits of each.
// With y = x^k, the divisor is y^2 + y + 1, and y^3 = (y + 1) (y^2 + y + 1) + 1.
uint divide_by_trinomial(uint n, const uint k, const uint low) {
    uint n0 = n & low, n1 = n >> k & low, n2 = n >> 2u * k & low, n3 = n >> 3u * k & low;
    return n3 << 3u * k | (n3 ^ n2) << 2u * k | (n2 ^ n1) << k | n3 ^ n2 ^ n0;
}

// Writes the polynomial i in powers of x^2 + x + 1, and swaps the two bits of each digit: the third dimension of
// Niederreiter's sequence, whose first two are Sobol's, bit-reversed. Among 2^k points in a row, 2 have their three
// words in each box of volume 2^(1-k).
// Ref: Niederreiter 1988, Low-Discrepancy and Low-Dispersion Sequences, section 3.
uint trinomial_digits(uint i) {
    i = divide_by_trinomial(i, 8u, 0x000000FFu);
    i = divide_by_trinomial(i, 4u, 0x000F000Fu);
    i = divide_by_trinomial(i, 2u, 0x03030303u);
    i = divide_by_trinomial(i, 1u, 0x11111111u);
    return (i & 0x55555555u) << 1u | (i >> 1u & 0x55555555u);
}

// Sobol dimensions 0 and 1 and the third, each with its own Owen scramble, at an index shuffled per pair ("padding").
// Ref: Burley 2020, Practical Hash-based Owen Scrambling, sections 4 and 5.
uvec3 sobol_triple(Sampler s, uint pair) {
    uvec3 seeds = hash_pcg3d(uvec3(s.pixel, pair, s.seed));
    uint i = bitfieldReverse(hash_laine_karras(bitfieldReverse(s.n), seeds.x));
    return bitfieldReverse(uvec3(hash_laine_karras(i, seeds.y), hash_laine_karras(pascal_multiply(i), seeds.z),
                                 hash_laine_karras(trinomial_digits(i), hash_pcg3d(seeds).x)));
}

// Three words of 32 random bits: two for that pair of dimensions, and one for a choice. Points and choice together are
// as well distributed as the points alone.
uvec3 sampler_triple(Sampler s, uint pair) {
    switch (SAMPLER) {
        case SAMPLER_INDEPENDENT: return hash_pcg4d(uvec4(s.pixel, s.n, pair, s.seed)).xyz;
        case SAMPLER_STRATIFIED: return stratified_triple(s, pair);
        default: return sobol_triple(s, pair);
    }
}

// Two words of 32 random bits for that pair of dimensions.
uvec2 sampler_pair(Sampler s, uint pair) {
    return sampler_triple(s, pair).xy;
}

#endif
