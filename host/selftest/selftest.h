// The selftest: a list of checks that show on any device whether the renderer is right there.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "selftest/effort.h"
#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// Probability that a correct device fails the whole selftest, by chance, at most. Seeds are fixed, so that
// one device always gets one verdict.
inline constexpr double SELFTEST_ALPHA = 1e-3;

struct Check {
    std::string name;
    std::string unit;               // What Evidence::compared() counts, a plural: "rays", "images".
    std::function<Evidence()> run;  // May throw Error.
};

// All checks, in the order from small parts to whole images. They refer to `device`.
std::vector<Check> selftest_checks(const vk::Device& device, Effort effort);

// The level at which each of so many checks is judged: SELFTEST_ALPHA, Sidak-corrected.
double check_level(size_t checks);

struct CheckResult {
    std::string name, unit;
    Evidence evidence;
    std::optional<Error> error;  // What broke the check off.
    bool passed = false;
    double seconds = 0.0;  // Wall time.
};

// Runs a check and judges it. An Error that it throws fails it.
CheckResult run_check(const Check& check, double level);

}  // namespace candela
