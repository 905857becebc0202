// Gui: Dear ImGui over a window, from the window's input to an overlay.
#pragma once

#include <array>

#include "view/display.h"
#include "window/window.h"

namespace candela {

// Only one may exist at a time. A frame has one turn or more: Dear ImGui treats all input before a turn as
// simultaneous: a key that went down and up was never down, and the mouse was only at its last place. So each
// input gets its own turn, and its effect does not depend on the length of a frame.
class Gui {
  public:
    // `window` must outlive it.
    explicit Gui(Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    // Reads the window's size and the time.
    void begin_frame();
    // Between the two, widgets of Dear ImGui may be called. `input`: the user's action; null if there is
    // none.
    void begin_turn(const Input* input);
    void end_turn();
    // The widgets as drawn in the last turn, in a window of `size` pixels; valid until the next call.
    const Overlay& draw(uvec2 size);

  private:
    void take(const KeyInput& input);
    void take(const CharacterInput& input);
    void take(const ButtonInput& input);
    void take(const MoveInput& input);
    void take(const LeaveInput& input);
    void take(const WheelInput& input);
    void take(const FocusInput& input);

    Window& window_;
    vec2 mouse_;
    std::array<bool, 5> buttons_{};    // Whether each is down.
    std::array<bool, 8> modifiers_{};  // The same for Shift, Ctrl, Alt and Super, left and right.
    Overlay overlay_;
};

}  // namespace candela
