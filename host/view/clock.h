// Time in seconds, for the viewer's work at intervals.
#pragma once

#include <chrono>

namespace candela {

using Clock = std::chrono::steady_clock;

inline double seconds_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

inline Clock::time_point later(Clock::time_point when, double seconds) {
    return when + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace candela
