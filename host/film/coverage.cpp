// See coverage.h.
#include "film/coverage.h"

#include <algorithm>
#include <array>

namespace candela {

void Coverage::add(std::span<const ShapePart, FIRST_HITS> parts) {
    std::array<ShapePart, FIRST_HITS> sorted;
    std::ranges::copy(parts, sorted.begin());
    std::sort(sorted.begin(), sorted.end());
    const size_t begin = parts_.size();
    for (const ShapePart& part : sorted) {
        if (part == NO_PART) break;
        if (parts_.size() == begin || parts_.back().part != part) parts_.push_back({part, 0});
        ++parts_.back().hits;
    }
    ends_.push_back(parts_.size());
}

}  // namespace candela
