// The selftest: a list of checks that show whether the renderer is right on a device.
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

// Upper bound on the probability that a correct device fails the whole selftest by chance. Seeds are fixed,
// so that a device always gets the same verdict.
inline constexpr double SELFTEST_ALPHA = 1e-3;

struct Check {
    std::string name;
    std::string unit;               // The plural of what Evidence::compared() counts: "rays", "images".
    std::function<Evidence()> run;  // May throw Error.
};

// All checks, in order from small parts to whole images. They refer to `device`.
std::vector<Check> selftest_checks(const vk::Device& device, Effort effort);

// The level at which each of `checks` checks is judged: SELFTEST_ALPHA, Sidak-corrected.
double check_level(size_t checks);

struct CheckResult {
    std::string name, unit;
    Evidence evidence;
    std::optional<Error> error;  // The error that ended the check early.
    bool passed = false;
    double seconds = 0.0;  // Wall time.
};

// Runs a check and judges it. It fails if it throws Error.
CheckResult run_check(const Check& check, double level);

}  // namespace candela
