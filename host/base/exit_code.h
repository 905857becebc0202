// The codes with which the program ends.
#pragma once

#include "base/error.h"

namespace candela {

enum class ExitCode : int {
    done = 0,
    failed = 1,
    usage = 2,
    no_device = 3,
    device_lost = 4,
    out_of_memory = 5,
    comparison_failed = 6,
    time_over = 7,
    interrupted = 130,
};

// The exit code of a run that an Error of that kind ended.
constexpr ExitCode exit_code(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::request:
            return ExitCode::usage;
        case ErrorKind::no_device:
            return ExitCode::no_device;
        case ErrorKind::device_lost:
            return ExitCode::device_lost;
        case ErrorKind::out_of_memory:
            return ExitCode::out_of_memory;
        case ErrorKind::other:
            break;
    }
    return ExitCode::failed;
}

}  // namespace candela
