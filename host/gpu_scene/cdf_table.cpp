// See cdf_table.h.
#include "gpu_scene/cdf_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace candela {
namespace {

constexpr uint64_t ALL_WORDS = uint64_t(1) << 32;

}  // namespace

std::vector<uint64_t> divide_words(std::span<const double> weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    assert(total > 0.0 && weights.size() <= CDF_MAX_PLACES);
    std::vector<uint64_t> ends(weights.size());
    double sum = 0.0;
    uint64_t end = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        if (weights[i] > 0.0) end = std::max(end + 1, uint64_t(std::llround(sum / total * 0x1p32)));
        ends[i] = end;
    }
    // The last positive one ends with the words; what was pushed beyond by small weights moves back by a word
    // each.
    uint64_t limit = ALL_WORDS;
    for (size_t i = weights.size(); i-- > 0;) {
        ends[i] = limit < ALL_WORDS ? std::min(ends[i], limit) : limit;
        if (weights[i] > 0.0) limit = ends[i] - 1;
    }
    std::vector<uint64_t> words(weights.size());
    uint64_t begin = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        if (!(weights[i] > 0.0)) continue;
        words[i] = ends[i] - begin;
        begin = ends[i];
    }
    return words;
}

void append_cdf_table(std::vector<CdfEntry>& table, std::span<const uint64_t> words) {
    const uint64_t n = words.size();
    std::vector<uint64_t> ends(n);
    std::partial_sum(words.begin(), words.end(), ends.begin());
    assert(ends.back() == ALL_WORDS);
    size_t first = 0;
    for (uint64_t i = 0; i < n; ++i) {
        const uint64_t begin = (i * ALL_WORDS + n - 1) / n, end = ((i + 1) * ALL_WORDS + n - 1) / n;
        while (ends[first] <= begin)
            ++first;
        size_t last = first;
        while (ends[last] < end)
            ++last;
        const auto more = uint32_t(std::min<size_t>(last - first, CDF_MANY_MORE));
        table.push_back(
            {.last_word = uint32_t(ends[i] - 1), .range = uint32_t(first) | more << CDF_PLACE_BITS});
    }
}

}  // namespace candela
