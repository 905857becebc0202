// See fit_attributes.h.
#include "load/gltf/fit_attributes.h"

#include <utility>

#include "base/text.h"
#include "scene/material_textures.h"
#include "scene/materials.h"

namespace candela::gltf {

void fit_attributes(File& file, const Node& primitive, const Material& material, bool has_alpha,
                    TriangleMesh& mesh) {
    uint32_t sets = 0;
    for_each_texture(material, [&](const Texture& texture) { sets |= 1u << texture.uv_set; });
    if (needs_tangents(material)) {
        sets |= 1u << tangent_uv_set(material);
    } else {
        mesh.tangents.clear();
    }
    for (const auto& [set, uvs] : {std::pair(0u, &mesh.uv0), std::pair(1u, &mesh.uv1)}) {
        if ((sets >> set & 1u) == 0) {
            uvs->clear();
        } else if (uvs->empty()) {
            file.warn(primitive, concat("the material has textures, but the primitive has no TEXCOORD_", set,
                                        ": they show their upper left corner everywhere"));
            uvs->assign(mesh.positions.size(), vec2(0.0f, 1.0f));
        }
    }
    const Opacity& opacity = material.opacity;
    if (has_alpha || opacity.value != Textured<float>(1.0f) || opacity.cutoff) return;
    for (vec4& color : mesh.colors)
        color.w = 1.0f;
}

}  // namespace candela::gltf
