// Materials -> the arrays of their records, of the media behind them and of all textures.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu_scene/texture_table.h"
#include "scene/frame.h"
#include "scene/scene.h"

namespace candela {

// What kernels must know: see shared/kernel_constants.inc.
struct MaterialFacts {
    uint32_t material_count = 0;
    bool has_media = false;          // Some medium absorbs or scatters light.
    bool volumetric = false;         // Some medium scatters light, or ends without a surface.
    bool has_catchers = false;       // Some material is a catcher's.
    uint32_t materials_present = 0;  // Bit i: a material of model i.
    uint32_t principled = 0;         // Bits PRINCIPLED_HAS_*: of all principled materials.
    uint32_t textured = 0;           // Bits TEXTURED_*.
    uint32_t texture_traits = 0;     // Of all textures.
    uint32_t attributes = 0;         // Bits ATTRIBUTE_*: those of vertices that textures and materials read.
    // At most SMALL_MODEL_TRIANGLES, of principled and unlit materials. Its arrays have what kernels read
    // that it shares with other small models: each attribute if it has a texture, and a light, a sky and
    // nodes of the tree over lights, if only dark ones.
    bool small_model = false;
};

inline constexpr uint64_t SMALL_MODEL_TRIANGLES = 65536;

struct MaterialArrays {
    MaterialFacts facts;
    std::vector<uvec4> materials, media, material_textures, textures;
    std::vector<uint32_t> emission_textures;  // Of each shape: an index, or TEXTURE_NONE.
    ImagePlaces image_places;
};

// The records of the scene's materials, of the media behind them, each once, and of the textures that these
// and the shapes' emissions look up. Throws Error if there are more than the records can number.
MaterialArrays build_material_arrays(const Scene& scene, const SceneFrame& frame);

// Whether some rays may pass the shape: its material is culled, or that or the colours of its vertices are
// not opaque.
bool lets_rays_pass(const Scene& scene, const Shape& shape);

}  // namespace candela
