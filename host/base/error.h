// The one exception of the program and the exit codes that a run can end with.
//
// A programmer's error is an assert; the world's error (file, scene, device, memory) is an Error, caught once
// in main(); an expected absence is a std::optional. The message of an Error names the thing, the place, the
// cause and the remedy, and ends without a full stop or line feed.
#pragma once

#include <stdexcept>
#include <string>

namespace candela {

enum class ExitCode : int {
    done = 0,
    failed = 1,
    usage = 2,
    no_device = 3,
    device_lost = 4,
    out_of_memory = 5,
    comparison_failed = 6,
    interrupted = 130,
};

class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& message, ExitCode code = ExitCode::failed)
        : std::runtime_error(message), code_(code) {}

    ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

}  // namespace candela
