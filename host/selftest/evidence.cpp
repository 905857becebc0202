// See evidence.h.
#include "selftest/evidence.h"

#include <cmath>

namespace candela {

void Evidence::add_p_value(const std::string& of, double p, uint64_t tests) {
    tests_ += tests;
    const double known = p >= 0.0 ? p : 0.0;
    if (known > min_p_ || (known == min_p_ && !least_likely_.empty())) return;
    min_p_ = known;
    least_likely_ = of;
}

void Evidence::add(const Evidence& other) {
    if (wrong_ == 0) first_wrong_ = other.first_wrong_;
    compared_ += other.compared_;
    wrong_ += other.wrong_;
    if (other.tests_ > 0) add_p_value(other.least_likely_, other.min_p_, other.tests_);
}

double Evidence::p_value() const {
    return tests_ == 0 ? 1.0 : -std::expm1(double(tests_) * std::log1p(-min_p_));
}

}  // namespace candela
