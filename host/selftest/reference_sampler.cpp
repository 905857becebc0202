// See reference_sampler.h.
#include "selftest/reference_sampler.h"

#include <array>

namespace candela::reference {

// Jarzynski and Olano 2020, listings of pcg3d and pcg4d: two rounds of products of the other components
// around a xor-shift. next(i) * after_next(i) is added to component i, in order.
uvec3 pcg3d(uvec3 v) {
    const auto round = [&] {
        for (int i = 0; i < 3; ++i)
            v[i] += v[(i + 1) % 3] * v[(i + 2) % 3];
    };
    for (int i = 0; i < 3; ++i)
        v[i] = 1664525u * v[i] + 1013904223u;
    round();
    for (int i = 0; i < 3; ++i)
        v[i] ^= v[i] / 65536u;
    round();
    return v;
}

uvec4 pcg4d(uvec4 v) {
    constexpr std::array<std::array<int, 2>, 4> FACTORS{{{1, 3}, {2, 0}, {0, 1}, {1, 2}}};
    const auto round = [&] {
        for (int i = 0; i < 4; ++i)
            v[i] += v[FACTORS[i][0]] * v[FACTORS[i][1]];
    };
    for (int i = 0; i < 4; ++i)
        v[i] = 1664525u * v[i] + 1013904223u;
    round();
    for (int i = 0; i < 4; ++i)
        v[i] ^= v[i] / 65536u;
    round();
    return v;
}

// Vegdahl 2021: each step is a bijection and carries information only upwards.
uint32_t laine_karras(uint32_t x, uint32_t seed) {
    const uint32_t multiplier =
        seed / 65536u % 2u == 1u ? seed / 65536u : seed / 65536u + 1u;  // The next odd number.
    x = x ^ x * 1025551850u;
    x = (x + seed) * multiplier;
    x = x ^ x * 89287766u;
    return x ^ x * 1403136100u;
}

uint32_t permute_64(uint32_t i, uint32_t hash) {
    uint64_t repeated =
        uint64_t{hash} << 32 | hash;  // `hash` rotated right by 10 k bits is bits 10 k and up of this.
    for (int round = 0; round < 3; ++round, repeated >>= 10) {
        const uint32_t multiplier = uint32_t(repeated % 64) / 2 * 2 + 1;
        const auto offset = uint32_t(uint32_t(repeated) / 64);
        i = (multiplier * i + offset) % 64;
        i ^= i / 8;
    }
    return i;
}

uint32_t reverse_bits(uint32_t x) {
    uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit)
        reversed |= (x >> bit & 1u) << (31 - bit);
    return reversed;
}

// Bratley and Fox 1988: the sum modulo 2 of a direction number for each bit of the index. Dimension 0 has m_k
// = 1; dimension 1, of the primitive polynomial x + 1, has m_1 = 1 and m_k = 2 m_(k-1) xor m_(k-1).
uint32_t sobol(uint32_t index, uint32_t dimension) {
    uint32_t x = 0;
    uint64_t m = 1;
    for (int k = 1; k <= 32; ++k) {
        if ((index >> (k - 1) & 1u) != 0) x ^= uint32_t(m << (32 - k));
        m = dimension == 0 ? 1 : (2 * m) ^ m;
    }
    return x;
}

// The remainders of long divisions by x^2 + x + 1, one after the other: b x + a gives the digits b and a.
uint32_t trinomial(uint32_t index) {
    uint32_t x = 0;
    for (int digits = 0; digits < 32; digits += 2) {
        uint32_t quotient = 0;
        for (int power = 31; power >= 2; --power) {
            if ((index >> power & 1u) == 0) continue;
            index ^= 0b111u << (power - 2);
            quotient |= 1u << (power - 2);
        }
        x |= index << (30 - digits);
        index = quotient;
    }
    return x;
}

// Digit k is bit 31 - k. Laine and Karras' function works on the digits in reversed order, where "before" is
// "below".
uint32_t owen_scramble(uint32_t x, uint32_t seed) {
    return reverse_bits(laine_karras(reverse_bits(x), seed));
}

uvec3 independent_triple(uint32_t pixel, uint32_t n, uint32_t seed, uint32_t pair) {
    const uvec4 hash = pcg4d(uvec4(pixel, n, pair, seed));
    return {hash.x, hash.y, hash.z};
}

uvec3 stratified_triple(uint32_t pixel, uint32_t n, uint32_t seed, uint32_t pair) {
    const uvec4 orders = pcg4d(uvec4(pixel, n / 64, pair, 0xFFFFFFFFu - seed));
    const uint32_t cell = permute_64(n % 64, orders.x), interval = permute_64(n % 64, orders.y);
    const uvec3 jitter = independent_triple(pixel, n, seed, pair);
    constexpr uint32_t CELL = 1u << 29;      // An eighth of 2^32.
    constexpr uint32_t INTERVAL = 1u << 26;  // A 64th of 2^32.
    return {cell % 8 * CELL + jitter.x / 8, cell / 8 * CELL + jitter.y / 8,
            interval * INTERVAL + jitter.z / 64};
}

// Burley 2020: the index is shuffled and each dimension is scrambled, each with its own seed.
uvec3 sobol_triple(uint32_t pixel, uint32_t n, uint32_t seed, uint32_t pair) {
    const uvec3 seeds = pcg3d(uvec3(pixel, pair, seed));
    const uint32_t index = owen_scramble(n, seeds.x);
    return {owen_scramble(sobol(index, 0), seeds.y), owen_scramble(sobol(index, 1), seeds.z),
            owen_scramble(trinomial(index), pcg3d(seeds).x)};
}

}  // namespace candela::reference
