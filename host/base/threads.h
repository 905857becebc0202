// Threads that help with work which one thread could do alone.
#pragma once

#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace candela {

// Starts `count` threads that call work(); fewer, or none, if the system does not allow more.
template <class Work>
std::vector<std::jthread> start_helpers(size_t count, const Work& work) {
    std::vector<std::jthread> helpers;
    helpers.reserve(count);
    try {
        while (helpers.size() < count)
            helpers.emplace_back(work);
    } catch (const std::system_error&) {
    }
    return helpers;
}

}  // namespace candela
