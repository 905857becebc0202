// See report.h.
#include "bench/report.h"

#include <algorithm>
#include <cassert>

namespace candela {

Spread spread(std::span<const double> values) {
    assert(!values.empty());
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    const size_t half = sorted.size() / 2;
    const double median = sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
    return {median, sorted.front(), sorted.back()};
}

std::optional<double> ratio(const Row& row) {
    if (row.rival.empty()) return std::nullopt;
    assert(row.rival.size() == row.ours.size());
    std::vector<double> ratios;
    for (size_t run = 0; run < row.ours.size(); ++run)
        ratios.push_back(row.ours[run] / row.rival[run]);
    return spread(ratios).median;
}

}  // namespace candela
