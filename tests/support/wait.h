// Waiting for events that must happen, for as long as necessary on a slow or busy machine.
#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

namespace candela {

// What has not happened after so long never will. It says that a program hangs, not how fast it has to be.
inline constexpr std::chrono::minutes PATIENCE{60};

// Waits until the condition holds; throws std::runtime_error, which ends the test, if it never does.
inline void wait_until(const std::string& what, const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + PATIENCE;
    while (!holds()) {
        if (std::chrono::steady_clock::now() > end) throw std::runtime_error("waited in vain until " + what);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

}  // namespace candela
