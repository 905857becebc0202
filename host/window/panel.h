// The viewer's panel: figures, sliders and buttons; or how to open a scene.
#pragma once

#include <span>

#include "window/view_state.h"

namespace candela {

// Shows the panel, within a frame of Dear ImGui, and applies the user's actions to `state` and `requests`.
// `cameras` are the scene's.
void show_panel(ViewState& state, ViewRequests& requests, const ViewFigures& figures,
                std::span<const Camera> cameras, bool has_environment);

// Shows in its place what to do without a scene of the user's.
void show_start_page(const ViewFigures& figures);

}  // namespace candela
