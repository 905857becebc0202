// CPU time and wall time: on a machine that is shared with other work, CPU time measures the cost of the
// work.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>

#include "vk/device_info.h"

namespace candela {

// Durations [s].
struct Clocks {
    double cpu = 0.0;  // Sum over all threads of the process.
    double wall = 0.0;
};

// Runs from its construction.
class Stopwatch {
  public:
    Clocks elapsed() const {
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_;
        return {cpu_now() - cpu_, wall.count()};
    }

  private:
    static double cpu_now() {
        timespec time{};
        ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
    }

    double cpu_ = cpu_now();
    std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
};

// Threads that the machine runs at once.
inline double cores() {
    return double(std::max(1u, std::thread::hardware_concurrency()));
}

// Whether the device's work uses CPU time. A GPU is measured only by wall time.
inline bool works_on_cpu(const vk::DeviceInfo& device) {
    return device.type == vk::DeviceType::cpu;
}

// The seconds from which a speed is computed: CPU time over the number of cores, as if these had nothing else
// to do; or wall time.
inline double counted_seconds(const Clocks& clocks, bool by_cpu_time) {
    return by_cpu_time ? clocks.cpu / cores() : clocks.wall;
}

}  // namespace candela
