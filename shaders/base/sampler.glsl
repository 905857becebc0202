// Samplers: two words of random bits for a pair of dimensions, as a pure function of (pixel, n, seed, pair).
//
// All three are counter-based: they keep no state but the counters, so that any sample of any pixel can be made
// anywhere, at any time, in any order.
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

// One jittered sample in each cell of an 8 x 8 grid; the cells are visited in a new order every 64 samples.
uvec2 stratified_pair(Sampler s, uint pair) {
    uint order = hash_pcg4d(uvec4(s.pixel, s.n >> 6u, pair, ~s.seed)).x;
    uint cell = permute_64(s.n & 63u, order);
    uvec2 jitter = hash_pcg4d(uvec4(s.pixel, s.n, pair, s.seed)).xy;
    return (uvec2(cell, cell >> 3u) & 7u) << 29u | jitter >> 3u;
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

// Sobol dimensions 0 and 1, each with its own Owen scramble, at an index shuffled per pair ("padding").
// Ref: Burley 2020, Practical Hash-based Owen Scrambling, sections 4 and 5.
uvec2 sobol_pair(Sampler s, uint pair) {
    uvec3 seeds = hash_pcg3d(uvec3(s.pixel, pair, s.seed));
    uint i = bitfieldReverse(hash_laine_karras(bitfieldReverse(s.n), seeds.x));
    return bitfieldReverse(uvec2(hash_laine_karras(i, seeds.y), hash_laine_karras(pascal_multiply(i), seeds.z)));
}

// Two words of 32 random bits for that pair of dimensions.
uvec2 sampler_pair(Sampler s, uint pair) {
    switch (SAMPLER) {
        case SAMPLER_INDEPENDENT: return hash_pcg4d(uvec4(s.pixel, s.n, pair, s.seed)).xy;
        case SAMPLER_STRATIFIED: return stratified_pair(s, pair);
        default: return sobol_pair(s, pair);
    }
}

#endif
