// Threads that help with work which one thread could do alone.
#pragma once

#include <cstddef>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "base/memory_limit.h"

namespace candela {

// Starts `count` threads that call work(); fewer, or none, if the system does not allow more. A limit on this
// thread's memory applies to them, too.
template <class Work>
std::vector<std::jthread> start_helpers(size_t count, const Work& work) {
    std::vector<std::jthread> helpers;
    helpers.reserve(count);
    const auto limited_work = [work, is_limited = LimitedMemory::applies()] {
        std::optional<LimitedMemory> limited;
        if (is_limited) limited.emplace();
        work();
    };
    try {
        while (helpers.size() < count)
            helpers.emplace_back(limited_work);
    } catch (const std::system_error&) {
    }
    return helpers;
}

}  // namespace candela
