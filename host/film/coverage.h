// What the pixels of a picture show first, and how much of each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/first_hits.h"

namespace candela {

// A shape that a pixel shows, and how many of the pixel's FIRST_HITS camera rays hit it first.
struct CoveredShape {
    uint32_t shape = 0;
    uint32_t hits = 0;

    bool operator==(const CoveredShape&) const = default;
};

class Coverage {
  public:
    // Adds the next pixel, row-major: the shape that each ray hits, or nothing (NO_SHAPE).
    static constexpr uint32_t NO_SHAPE = UINT32_MAX;
    void add(std::span<const uint32_t, FIRST_HITS> shapes);

    size_t pixel_count() const { return ends_.size(); }
    // What pixel i shows, in the order of the shapes.
    std::span<const CoveredShape> at(size_t i) const {
        const size_t begin = i == 0 ? 0 : ends_[i - 1];
        return std::span(shapes_).subspan(begin, ends_[i] - begin);
    }

  private:
    std::vector<CoveredShape> shapes_;
    std::vector<size_t> ends_;  // Of each pixel's shapes.
};

}  // namespace candela
