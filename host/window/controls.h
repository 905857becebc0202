// The viewer's mouse and keys.
#pragma once

#include <set>

#include "window/input.h"
#include "window/view_state.h"

namespace candela {

// The actions of mouse and keys, for the panel and for --help.
inline constexpr const char* CONTROLS_HELP =
    "drag        orbit\n"
    "Shift drag  pan (also right, middle)\n"
    "wheel       zoom\n"
    "click       focus there\n"
    "WASD, QE    fly; with Shift faster\n"
    "Space  pause        R    restart\n"
    "P      save PNG     X    save EXR\n"
    "N      denoise\n"
    "C      save camera  Home camera back\n"
    "Tab    panel        Esc  close";

// `seconds`: since the last frame.
class Controls {
  public:
    // Applies the user's input, null if there is none, to `state`, and returns the user's other requests.
    // Call it within the turn of Gui for the same input.
    ViewRequests apply(const Input* input, ViewState& state, double seconds);
    // Moves the camera by the keys that are down; call it once per frame.
    void fly(Camera& camera, double seconds) const;

  private:
    void apply_key(const KeyInput& key, ViewState& state, ViewRequests& requests, double seconds);

    std::set<int> held_;  // Keys that went down while no text was typed, and have not gone up yet.
};

}  // namespace candela
