// The findings of a check: comparisons, which must all hold, and p-values of statistical tests.
#pragma once

#include <cstdint>
#include <string>

namespace candela {

class Evidence {
  public:
    // Counts a comparison. Keeps the text that describe() returns for the first comparison that does not
    // hold.
    template <class Describe>
    void expect(bool holds, const Describe& describe) {
        ++compared_;
        if (holds) return;
        ++wrong_;
        if (wrong_ == 1) first_wrong_ = describe();
    }
    // Adds the least p-value of `tests` statistical tests; `of` names their subject. NaN is treated as 0.
    void add_p_value(const std::string& of, double p, uint64_t tests = 1);
    // Adds everything that another check found.
    void add(const Evidence& other);

    uint64_t compared() const { return compared_; }
    uint64_t wrong() const { return wrong_; }
    const std::string& first_wrong() const { return first_wrong_; }

    uint64_t tests() const { return tests_; }
    // The probability that chance alone gives a least p-value this small, for independent tests (Sidak's
    // correction); 1 if there was no test.
    double p_value() const;
    // The subject of the test with the least p-value.
    const std::string& least_likely() const { return least_likely_; }

    // True if all comparisons hold and the p-value is above `level`.
    bool passes(double level) const { return wrong_ == 0 && p_value() > level; }

  private:
    uint64_t compared_ = 0, wrong_ = 0, tests_ = 0;
    double min_p_ = 1.0;
    std::string first_wrong_, least_likely_;
};

}  // namespace candela
