// See alias_table.h.
#include "gpu_scene/alias_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace candela {

std::vector<AliasEntry> build_alias_table(std::span<const double> weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    assert(total > 0.0);
    const size_t n = weights.size();
    std::vector<AliasEntry> table(n);
    std::vector<double> fraction(n);  // How much of column i still belongs to its own index, in columns.
    std::vector<uint32_t> small;
    std::vector<uint32_t> large;
    for (uint32_t i = 0; i < n; ++i) {
        fraction[i] = weights[i] / total * double(n);
        table[i] = {UINT32_MAX, i};
        (fraction[i] < 1.0 ? small : large).push_back(i);
    }
    // Fill up each column that is short of 1 from one that has more.
    while (!small.empty() && !large.empty()) {
        const uint32_t s = small.back();
        const uint32_t l = large.back();
        small.pop_back();
        table[s].threshold = uint32_t(std::min(std::floor(fraction[s] * 0x1p32 + 0.5), double(UINT32_MAX)));
        table[s].alias = l;
        fraction[l] -= 1.0 - fraction[s];
        if (fraction[l] < 1.0) {
            large.pop_back();
            small.push_back(l);
        }
    }
    // The remaining columns differ from full ones only by rounding, and stay their own alias.
    return table;
}

}  // namespace candela
