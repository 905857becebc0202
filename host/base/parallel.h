// A loop over independent steps on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/threads.h"

namespace candela {

// Calls step(i) for i = 0 .. count - 1, in no particular order, on as many threads as there are cores, or on
// fewer if no more can be started. If a step throws, no further steps begin, and the exception of the lowest
// i is rethrown.
template <class Step>
void parallel_for(size_t count, const Step& step) {
    std::atomic<size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr error;
    size_t failed = count;
    const auto work = [&] {
        for (size_t i = next++; i < count; i = next++) {
            try {
                step(i);
            } catch (...) {
                next = count;
                const std::lock_guard lock(mutex);
                if (i < failed) {
                    failed = i;
                    error = std::current_exception();
                }
            }
        }
    };
    {
        // One step needs no helper, nor to read from the system how many there could be.
        const size_t threads = count < 2 ? 1 : std::min<size_t>(count, std::thread::hardware_concurrency());
        const std::vector<JoiningThread> helpers = start_helpers(std::max<size_t>(threads, 1) - 1, work);
        work();
    }
    if (error) std::rethrow_exception(error);
}

}  // namespace candela
