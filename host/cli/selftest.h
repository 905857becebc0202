// The table, the verdict and the exit code of `candela selftest`.
#pragma once

#include <vector>

#include "base/error.h"
#include "selftest/selftest.h"
#include "vk/device_info.h"

namespace candela {

// Runs the checks, of that effort, one after another and prints to stdout what they find: a table, a line as
// soon as each is done, or with `json` one JSON object at the end. stderr shows which check is running.
// Returns failed if a check fails. Where a device is lost the remaining checks are left out, and the Error is
// thrown when all is printed.
ExitCode run_selftest(const std::vector<Check>& checks, Effort effort, const vk::DeviceInfo& device,
                      bool json);

}  // namespace candela
