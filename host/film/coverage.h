// What the pixels of a picture show first, and how much of each.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "shared/first_hits.h"

namespace candela {

// A shape, or a group of its mesh.
struct ShapePart {
    uint32_t shape = 0;
    uint32_t group = 0;

    bool operator==(const ShapePart&) const = default;
    bool operator<(const ShapePart& other) const {
        return shape != other.shape ? shape < other.shape : group < other.group;
    }
};

// Nothing, behind all parts in their order.
inline constexpr ShapePart NO_PART{UINT32_MAX, 0};

// What a pixel shows, and how many of the pixel's FIRST_HITS camera rays hit it first.
struct CoveredPart {
    ShapePart part{};
    uint32_t hits = 0;

    bool operator==(const CoveredPart&) const = default;
};

class Coverage {
  public:
    Coverage() = default;
    // Of about so many pixels.
    explicit Coverage(size_t pixels) { ends_.reserve(pixels); }

    // Adds the next pixel, row-major: what each ray hits, or NO_PART.
    void add(std::span<const ShapePart, FIRST_HITS> parts);

    size_t pixel_count() const { return ends_.size(); }
    // What pixel i shows, in the order of the parts.
    std::span<const CoveredPart> at(size_t i) const {
        const size_t begin = i == 0 ? 0 : ends_[i - 1];
        return std::span(parts_).subspan(begin, ends_[i] - begin);
    }

  private:
    std::vector<CoveredPart> parts_;
    std::vector<size_t> ends_;  // Of each pixel's parts.
};

}  // namespace candela
