// A second implementation of the samplers, from the papers' definitions: bit loops, generator matrices and
// nested permutations instead of the shader's shortcuts.
#pragma once

#include "base/math.h"

namespace candela::reference {

uvec3 pcg3d(uvec3 v);
uvec4 pcg4d(uvec4 v);
uint32_t laine_karras(uint32_t x, uint32_t seed);
uint32_t permute_64(uint32_t i, uint32_t hash);
uint32_t reverse_bits(uint32_t x);

// Dimension 0 or 1 of the Sobol sequence at `index`, as a fraction of 2^32.
uint32_t sobol(uint32_t index, uint32_t dimension);

// The third dimension, of the polynomial x^2 + x + 1 over GF(2).
uint32_t trinomial(uint32_t index);

// Owen's nested scramble of a fraction of 2^32: how digit k changes depends only on the digits before it.
uint32_t owen_scramble(uint32_t x, uint32_t seed);

// The three words of a sample for a pair of dimensions, by each sampler; `pixel` is x | y << 16.
uvec3 independent_triple(uint32_t pixel, uint32_t n, uint32_t seed, uint32_t pair);
uvec3 stratified_triple(uint32_t pixel, uint32_t n, uint32_t seed, uint32_t pair);
uvec3 sobol_triple(uint32_t pixel, uint32_t n, uint32_t seed, uint32_t pair);

}  // namespace candela::reference
