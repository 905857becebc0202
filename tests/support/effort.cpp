// See effort.h.
#include "support/effort.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "scene/names.h"

namespace candela {
namespace {

Effort read_effort() {
    const char* const variable = std::getenv("CANDELA_TEST_EFFORT");
    const std::string word = variable == nullptr ? "full" : variable;
    for (const auto& [name, effort] : EFFORT_NAMES) {
        if (word != name) continue;
        std::printf("effort: %s\n", word.c_str());
        return effort;
    }
    throw std::runtime_error("CANDELA_TEST_EFFORT is \"" + word + "\"; expected quick or full");
}

}  // namespace

Effort test_effort() {
    static const Effort effort = read_effort();
    return effort;
}

}  // namespace candela
