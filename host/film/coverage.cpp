// See coverage.h.
#include "film/coverage.h"

#include <algorithm>
#include <array>

namespace candela {

void Coverage::add(std::span<const uint32_t, FIRST_HITS> shapes) {
    std::array<uint32_t, FIRST_HITS> sorted;
    std::ranges::copy(shapes, sorted.begin());
    std::ranges::sort(sorted);
    const size_t begin = shapes_.size();
    for (const uint32_t shape : sorted) {
        if (shape == NO_SHAPE) break;
        if (shapes_.size() == begin || shapes_.back().shape != shape) shapes_.push_back({shape, 0});
        ++shapes_.back().hits;
    }
    ends_.push_back(shapes_.size());
}

}  // namespace candela
