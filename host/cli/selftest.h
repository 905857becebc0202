// The table, the verdict and the exit code of `candela selftest`.
#pragma once

#include <vector>

#include "base/exit_code.h"
#include "selftest/selftest.h"
#include "vk/device_info.h"

namespace candela {

// Runs the checks of that effort one after another, and prints their results to stdout: a table, one line as
// soon as each check is done, or with `json` one JSON object at the end. stderr shows which check is running.
// Returns failed if a check fails. If the device is lost, skips the remaining checks, and throws the Error
// after printing.
ExitCode run_selftest(const std::vector<Check>& checks, Effort effort, const vk::DeviceInfo& device,
                      bool json);

}  // namespace candela
