// The viewer's mouse and keys.
#pragma once

#include "view/view_state.h"
#include "view/window.h"

namespace candela {

// Every key and what it does, one per line, for the panel and for --help.
inline constexpr const char* CONTROLS_HELP =
    "drag        turn about what is seen\n"
    "Shift drag  move across (right, middle)\n"
    "wheel       come closer, go away\n"
    "click       focus there\n"
    "WASD, QE    fly; with Shift faster\n"
    "Space  pause        R    restart\n"
    "P      save PNG     X    save EXR\n"
    "C      save camera  Home camera back\n"
    "Tab    panel        Esc  close";

// Applies what was done with mouse and keys since the last frame, `seconds` ago, to the camera; to be called
// within a frame of Dear ImGui, whose widgets come first.
ViewRequests apply_controls(Window& window, ViewState& state, double seconds);

}  // namespace candela
