// Materials -> the arrays of their records, of the media behind them and of their textures.
#pragma once

#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/texture_table.h"

namespace candela {

// Appends the records of materials, and of the media behind them, each once. Throws Error if there are more
// than the records can number.
void append_materials(GpuScene& gpu, const std::vector<Material>& materials, TextureTable& textures);

}  // namespace candela
