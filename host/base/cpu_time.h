// CPU time of work that helpers may share (threads.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <ctime>

namespace candela {

// CPU time [ns] of helpers that this thread has started and that have ended, and of theirs.
inline thread_local std::atomic<int64_t> helpers_cpu_time = 0;

// CPU time of this thread and of these helpers [ns].
inline int64_t work_cpu_time() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec + helpers_cpu_time;
}

// Measures the CPU time that this thread and the helpers that it starts take from now on.
class CpuWatch {
  public:
    double seconds() const { return 1e-9 * double(work_cpu_time() - start_); }

  private:
    int64_t start_ = work_cpu_time();
};

}  // namespace candela
