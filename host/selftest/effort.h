// How much evidence is gathered: the two sizes of all that needs nothing but samples.
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

// Of so many samples or rays, those that are taken. A sixteenth: a driver that needs half an hour for all of
// them, such as SwiftShader, is done in minutes, and finds what is wrong by four times as much.
inline uint32_t sized(Effort effort, uint32_t full) {
    constexpr uint32_t QUICK_SHARE = 16;
    return effort == Effort::quick ? full / QUICK_SHARE : full;
}

}  // namespace candela
