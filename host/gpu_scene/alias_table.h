// Alias tables: a discrete distribution that a shader samples with two look-ups.
#pragma once

#include <span>
#include <vector>

#include "shared/light.h"

namespace candela {

// The table of the distribution proportional to `weights` (each finite and >= 0, not all 0): entry i holds
// column i. Ref: Vose 1991, A Linear Algorithm for Generating Random Numbers with a Given Distribution.
std::vector<AliasEntry> build_alias_table(std::span<const double> weights);

}  // namespace candela
