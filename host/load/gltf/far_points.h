// The points of a body that reach farthest.
#pragma once

#include <array>
#include <vector>

#include "base/math.h"

namespace candela::gltf {

// Keeps, of all points that are added, the farthest in each of DIRECTIONS directions: along the axes, and
// spread evenly over the sphere. Their hull has the box of all points, and all of them but for 2 % of their
// extent.
class FarPoints {
  public:
    FarPoints() { reached_.fill(-double(INFINITE)); }

    void add(dvec3 p);
    // The points that are kept, each once.
    std::vector<dvec3> points() const;

  private:
    static constexpr size_t DIRECTIONS = 128;

    std::array<double, DIRECTIONS> reached_;
    std::array<dvec3, DIRECTIONS> points_{};
};

}  // namespace candela::gltf
