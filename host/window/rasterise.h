// Draws Dear ImGui's triangles on the host, so that the panel needs neither a graphics queue nor a pipeline
// of its own: it is small, and drawn some ten times per second.
#pragma once

#include "base/math.h"
#include "view/display.h"

struct ImDrawData;

namespace candela {

// Replaces `overlay` by the pixels that `data` covers in a window of `size` pixels. The only texture is the
// font atlas: `alpha`, row-major, of `texture_size` texels, read at the nearest one.
void rasterise(const ImDrawData& data, const unsigned char* alpha, uvec2 texture_size, uvec2 size,
               Overlay& overlay);

}  // namespace candela
