// Pieces of surfaces that emit -> lights.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu_scene/flatten.h"
#include "gpu_scene/instancing.h"
#include "gpu_scene/powered_lights.h"
#include "scene/scene.h"

namespace candela {

struct AreaLights {
    PoweredLights lights;
    std::vector<uint32_t> pieces;     // The piece of each light,
    std::vector<uint32_t> of_pieces;  // and the light of each piece, or NO_LIGHT if it is black.
};

// The lights of the pieces in `flat`, which is made of the scene, in its frame; so are areas and powers.
AreaLights build_area_lights(const Scene& scene, const FlatScene& flat);

// Throws Error if the triangles that emit, those of instances once, are more than lights may be.
void check_emitters(const Scene& scene, const Instancing& instancing);

}  // namespace candela
