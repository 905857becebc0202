// Ranges of sample indices, as text and together: which samples of a pixel an image holds.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace candela {

// Samples per pixel at most: their counts are kept as 32-bit floats, which are exact up to here.
inline constexpr uint32_t MAX_SPP = 1u << 24;

// The samples first, first + 1, ... up to but without `end`, which is at most MAX_SPP; none if the two are
// equal.
struct SampleRange {
    uint32_t first = 0;
    uint32_t end = 0;

    uint32_t count() const { return end - first; }
    bool operator==(const SampleRange&) const = default;
};

// "0..64", or "0..64,128..192" for several.
std::string to_text(std::span<const SampleRange> ranges);

// The ranges that `text` lists, which must ascend without overlap; nothing if it is anything else.
std::optional<std::vector<SampleRange>> parse_ranges(const std::string& text);

// The same samples as ascending ranges, those that touch made one and empty ones left out; none may overlap.
std::vector<SampleRange> joined(std::vector<SampleRange> ranges);

// Those of `within` that no range holds, ascending.
std::vector<SampleRange> gaps(std::vector<SampleRange> ranges, SampleRange within);

// All samples of all ranges.
uint32_t total_count(std::span<const SampleRange> ranges);

}  // namespace candela
