// A loop over independent steps on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace candela {

// Calls step(i) for i = 0 .. count - 1, in no particular order, on as many threads as there are cores. If
// steps throw, those that have not begun are left out, and the exception of the first one, by i, that has
// thrown is thrown here.
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
        std::vector<std::jthread> helpers;
        const size_t threads = std::min<size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
        for (size_t i = 1; i < threads; ++i)
            helpers.emplace_back(work);
        work();
    }
    if (error) std::rethrow_exception(error);
}

}  // namespace candela
