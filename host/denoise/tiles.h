// A large picture in tiles of one size that overlap, so that what is near their edges can be left out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace candela {

// A part of a line: [first, first + size) is processed, and what lies in [begin, end) of it is kept.
struct TileSpan {
    uint32_t first = 0, begin = 0, end = 0;
    bool operator==(const TileSpan&) const = default;
};

// Spans of min(size, length) pixels. What they keep covers [0, length) once, and begins and ends at least
// `overlap` from their ends, except at those of the line. `size` is more than twice the overlap.
inline std::vector<TileSpan> tile_spans(uint32_t length, uint32_t size, uint32_t overlap) {
    if (length <= size) return {{0, 0, length}};
    std::vector<TileSpan> spans;
    for (uint32_t begin = 0; begin < length;) {
        const uint32_t first = std::min(begin == 0 ? 0 : begin - overlap, length - size);
        const uint32_t end = first + size == length ? length : first + size - overlap;
        spans.push_back({first, begin, end});
        begin = end;
    }
    return spans;
}

}  // namespace candela
