// Threads that help with work which one thread could do alone.
#pragma once

#include <cstddef>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/cpu_time.h"
#include "base/memory_limit.h"

namespace candela {

// A thread that its destructor waits for: std::jthread, which some standard libraries lack.
class JoiningThread {
  public:
    // Calls work() in the thread. Throws std::system_error if the system does not allow more threads.
    template <class Work>
    explicit JoiningThread(Work work) : thread_(std::move(work)) {}
    JoiningThread(JoiningThread&&) = default;
    JoiningThread& operator=(JoiningThread&&) = delete;
    ~JoiningThread() {
        if (thread_.joinable()) thread_.join();
    }

  private:
    std::thread thread_;
};

// Starts `count` threads that call work(); fewer, or none, if the system does not allow more. A limit on this
// thread's memory applies to them, too. When they end, their CPU time is added to this thread's
// (cpu_time.h), which must not end before.
template <class Work>
std::vector<JoiningThread> start_helpers(size_t count, const Work& work) {
    std::vector<JoiningThread> helpers;
    helpers.reserve(count);
    const auto limited_work = [work, is_limited = LimitedMemory::applies(), cpu_time = &helpers_cpu_time] {
        std::optional<LimitedMemory> limited;
        if (is_limited) limited.emplace();
        work();
        *cpu_time += work_cpu_time();
    };
    try {
        while (helpers.size() < count)
            helpers.emplace_back(limited_work);
    } catch (const std::system_error&) {
    }
    return helpers;
}

}  // namespace candela
