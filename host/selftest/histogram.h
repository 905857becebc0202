// Counts of points of the unit square in cells of equal size.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/math.h"
#include "base/statistics.h"

namespace candela {

class Histogram {
  public:
    // `along`: cells along either axis.
    explicit Histogram(size_t along) : counts(along * along), along_(along) {}

    // The cell of (a, b). Points outside belong to cells at the border; NaN belongs to the first cell.
    size_t cell(double a, double b) const { return place(a) * along_ + place(b); }
    void add(glm::dvec2 at) { ++counts[cell(at.x, at.y)]; }

    // p-value of the hypothesis that the points are uniform over the square.
    double uniformity() const { return pearson_p_value(counts, std::vector<double>(counts.size(), 1.0)); }

    std::vector<double> counts;  // Row by row of equal a.

  private:
    size_t place(double x) const {
        return x > 0.0 ? std::min(size_t(std::min(x, 1.0) * double(along_)), along_ - 1) : 0;
    }

    size_t along_;
};

}  // namespace candela
