// The amount of evidence: two sizes for all tests that only need samples.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace candela {

enum class Effort { quick, full };

// As in scene/names.h.
inline constexpr std::array<std::pair<std::string_view, Effort>, 2> EFFORT_NAMES{
    {{"quick", Effort::quick}, {"full", Effort::full}}};

// The number of samples or rays, out of `full`. A sixteenth finds errors that are four times as large, and
// needs minutes on a driver that needs half an hour for all, such as SwiftShader.
inline uint32_t sized(Effort effort, uint32_t full) {
    constexpr uint32_t QUICK_FRACTION = 16;
    return effort == Effort::quick ? full / QUICK_FRACTION : full;
}

}  // namespace candela
