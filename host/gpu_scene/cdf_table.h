// Tables that a shader inverts: a discrete distribution over places in a row, whose order and neighbourhood
// the random bits keep, unlike with an alias table.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/light.h"

namespace candela {

// Divides 2^32 in proportion to `weights` (each finite and >= 0, not all 0; fewer than 2^20): the number of
// random words that choose each. It is positive where the weight is, and otherwise right within one word, or
// one for each weight that is smaller than a word's.
std::vector<uint64_t> divide_words(std::span<const double> weights);

// Appends the table in which `words` of the 2^32 random words, in order, choose each place.
void append_cdf_table(std::vector<CdfEntry>& table, std::span<const uint64_t> words);

}  // namespace candela
