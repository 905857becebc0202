// Input: one action of the user with mouse or keys.
#pragma once

#include <variant>

#include "base/math.h"

namespace candela {

struct KeyInput {
    int key;  // GLFW_KEY_*
    int scancode;
    bool down;      // Else it went up.
    int modifiers;  // GLFW_MOD_*
};
struct CharacterInput {
    unsigned int code;  // A Unicode code point.
};
struct ButtonInput {
    int button;  // GLFW_MOUSE_BUTTON_*
    bool down;   // Else it went up.
};
struct MoveInput {
    vec2 place;  // From the top left of the window, in the window system's units.
};
struct LeaveInput {};  // The mouse left the window.
struct WheelInput {
    vec2 steps;  // To the left, upwards.
};
struct FocusInput {
    bool focused;  // Whether keys go to the window from now on.
};

using Input =
    std::variant<KeyInput, CharacterInput, ButtonInput, MoveInput, LeaveInput, WheelInput, FocusInput>;

// There may be a thousand of these per second, so they do not wait for a picture.
inline bool is_motion(const Input& input) {
    return std::holds_alternative<MoveInput>(input) || std::holds_alternative<WheelInput>(input);
}

}  // namespace candela
