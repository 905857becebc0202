// Files that are damaged on purpose.
#pragma once

#include <functional>
#include <random>
#include <string>

#include "base/error.h"

namespace candela {

// Changes one byte of `good`, every second time after cutting it off, `times` times: to any byte, or to one
// of the `likely` ones. Returns how often `load` throws Error; it must do nothing worse.
inline size_t count_refused(const std::string& good, const std::string& likely, int times,
                            const std::function<void(const std::string&)>& load) {
    std::mt19937 random(1);
    size_t refused = 0;
    for (int i = 0; i < times; ++i) {
        std::string text = good.substr(0, i % 2 == 0 ? random() % good.size() + 1 : good.size());
        text[random() % text.size()] = i % 4 < 2 ? char(random()) : likely[random() % likely.size()];
        try {
            load(text);
        } catch (const Error&) {
            ++refused;
        }
    }
    return refused;
}

}  // namespace candela
