// The viewer's panel: figures, sliders and buttons.
#pragma once

#include <span>

#include "window/view_state.h"

namespace candela {

// Shows the panel, within a frame of Dear ImGui, and applies what the user does there to `state` and
// `requests`. `cameras` are the scene's; `home` is the camera from which the sliders of the lens take their
// ranges.
void show_panel(ViewState& state, ViewRequests& requests, const ViewFigures& figures,
                std::span<const Camera> cameras, const Camera& home, bool has_environment);

}  // namespace candela
