// CPU time of work that helpers share.
#include "base/cpu_time.h"

#include <thread>

#include <gtest/gtest.h>

#include "base/threads.h"

namespace candela {
namespace {

constexpr double SPENT = 0.02;  // CPU time [s].

// Computes for that CPU time of its thread.
void compute() {
    const CpuWatch watch;
    while (watch.seconds() < SPENT) {
    }
}

TEST(CpuTime, IncludesThatOfHelpersAndTheirs) {
    const CpuWatch watch;
    start_helpers(3, [] {
        start_helpers(1, [] { compute(); });
        compute();
    });
    EXPECT_GE(watch.seconds(), 6 * SPENT);
}

TEST(CpuTime, ExcludesThatOfOtherThreads) {
    const CpuWatch watch;
    std::thread(compute).join();
    EXPECT_LT(watch.seconds(), SPENT);
}

}  // namespace
}  // namespace candela
