// The viewer's mouse and keys.
#pragma once

#include <set>

#include "view/input.h"
#include "view/view_state.h"

namespace candela {

// Every key and what it does, one per line, for the panel and for --help.
inline constexpr const char* CONTROLS_HELP =
    "drag        orbit\n"
    "Shift drag  pan (also right, middle)\n"
    "wheel       zoom\n"
    "click       focus there\n"
    "WASD, QE    fly; with Shift faster\n"
    "Space  pause        R    restart\n"
    "P      save PNG     X    save EXR\n"
    "C      save camera  Home camera back\n"
    "Tab    panel        Esc  close";

// `seconds`: since the last frame.
class Controls {
  public:
    // Applies to the camera and the rest what the user does, null if nothing; to be called within a turn of
    // Gui, whose input that is.
    ViewRequests apply(const Input* input, ViewState& state, double seconds);
    // Moves the camera as the keys that are down say; to be called once a frame.
    void fly(Camera& camera, double seconds) const;

  private:
    void apply_key(const KeyInput& key, ViewState& state, ViewRequests& requests, double seconds);

    std::set<int> held_;  // Keys that went down where nothing was typed, and have not gone up yet.
};

}  // namespace candela
