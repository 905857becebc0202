// Ranges of sample indices: which samples of a pixel an image holds.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/limits.h"

namespace candela {

// The samples first, first + 1, ..., end - 1; none if first == end. `end` is at most MAX_SPP.
struct SampleRange {
    uint32_t first = 0;
    uint32_t end = 0;

    uint32_t count() const { return end - first; }
    bool operator==(const SampleRange&) const = default;
};

// "0..64", or "0..64,128..192" for several.
std::string to_text(std::span<const SampleRange> ranges);

// The ranges that `text` lists, which must ascend without overlap; nothing for any other text.
std::optional<std::vector<SampleRange>> parse_ranges(const std::string& text);

// The same samples in ascending ranges: adjacent ranges are joined, empty ones left out. They may not
// overlap.
std::vector<SampleRange> joined(std::vector<SampleRange> ranges);

// The samples of `within` that no range holds, ascending.
std::vector<SampleRange> gaps(std::vector<SampleRange> ranges, SampleRange within);

// The number of samples in all ranges.
uint32_t total_count(std::span<const SampleRange> ranges);

}  // namespace candela
