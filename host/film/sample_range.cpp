// See sample_range.h.
#include "film/sample_range.h"

#include <algorithm>
#include <cassert>
#include <charconv>

namespace candela {

std::string to_text(std::span<const SampleRange> ranges) {
    std::string text;
    for (const SampleRange& range : ranges) {
        text += (text.empty() ? "" : ",") + std::to_string(range.first) + ".." + std::to_string(range.end);
    }
    return text;
}

std::optional<std::vector<SampleRange>> parse_ranges(const std::string& text) {
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto read = [&](uint32_t& number) {
        const auto [next, error] = std::from_chars(at, end, number);
        at = next;
        return error == std::errc{} && number <= MAX_SPP;
    };
    const auto skip = [&](std::string_view word) {
        const bool there = std::string_view(at, size_t(end - at)).starts_with(word);
        if (there) at += word.size();
        return there;
    };
    std::vector<SampleRange> ranges;
    do {
        SampleRange range;
        if (!read(range.first) || !skip("..") || !read(range.end) || range.end < range.first)
            return std::nullopt;
        if (!ranges.empty() && range.first < ranges.back().end) return std::nullopt;
        ranges.push_back(range);
    } while (skip(","));
    return at == end ? std::optional(ranges) : std::nullopt;
}

std::vector<SampleRange> joined(std::vector<SampleRange> ranges) {
    std::erase_if(ranges, [](const SampleRange& range) { return range.count() == 0; });
    std::ranges::sort(ranges, {}, &SampleRange::first);
    std::vector<SampleRange> result;
    for (const SampleRange& range : ranges) {
        assert(result.empty() || result.back().end <= range.first);
        if (!result.empty() && result.back().end == range.first) {
            result.back().end = range.end;
        } else {
            result.push_back(range);
        }
    }
    return result;
}

std::vector<SampleRange> gaps(std::vector<SampleRange> ranges, SampleRange within) {
    std::vector<SampleRange> result;
    uint32_t first = within.first;
    for (const SampleRange& range : joined(std::move(ranges))) {
        const uint32_t end = std::min(range.first, within.end);
        if (end > first) result.push_back({first, end});
        first = std::max(first, range.end);
    }
    if (first < within.end) result.push_back({first, within.end});
    return result;
}

uint32_t total_count(std::span<const SampleRange> ranges) {
    uint32_t count = 0;
    for (const SampleRange& range : ranges)
        count += range.count();
    return count;
}

}  // namespace candela
