// See extensions.h. docs/gltf.md has the same table for people.
#include "load/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "load/quote.h"

namespace candela::gltf {
namespace {

constexpr std::array<std::string_view, 27> READ{
    "EXT_lights_image_based", "EXT_mesh_gpu_instancing", "EXT_texture_webp", "KHR_lights_punctual",
    "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion", "KHR_materials_emissive_strength", "KHR_materials_ior",
    "KHR_materials_iridescence", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_sheen",
    "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_unlit", "KHR_materials_variants",
    "KHR_materials_volume", "KHR_mesh_quantization", "KHR_node_visibility", "KHR_texture_transform",
    "KHR_xmp_json_ld",
    // What these say does not show in a picture.
    "EXT_mesh_manifold", "KHR_node_hoverability", "KHR_node_selectability", "KHR_interactivity",
    "MSFT_packing_normalRoughnessMetallic"};

// What is not read, and what is missing then.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> NOT_READ{
    {{"EXT_meshopt_compression", "uncompressed data take the place of compressed ones"},
     {"KHR_animation_pointer", "only nodes and weights are animated"},
     {"KHR_draco_mesh_compression", "uncompressed meshes take the place of compressed ones"},
     {"KHR_materials_volume_scatter", "bodies absorb light within, but do not scatter it"},
     {"KHR_meshopt_compression", "uncompressed data take the place of compressed ones"},
     {"KHR_texture_basisu", "images in PNG, JPEG or WebP take the place of KTX textures"},
     {"MSFT_texture_dds", "images in PNG, JPEG or WebP take the place of DDS textures"}}};

bool is_read(std::string_view name) {
    return std::ranges::find(READ, name) != READ.end();
}

}  // namespace

void check_extensions(File& file) {
    if (const auto required = file.root().find("extensionsRequired")) {
        for (const Node& name : required->elements()) {
            if (is_read(name.string())) continue;
            name.fail("the file requires the extension " + quote(name.string()) +
                      ", which is not read; export the scene without it");
        }
    }
    const auto used = file.root().find("extensionsUsed");
    if (!used) return;
    for (const Node& name : used->elements()) {
        if (is_read(name.string())) continue;
        const auto known = std::ranges::find(NOT_READ, std::string_view(name.string()),
                                             [](const auto& entry) { return entry.first; });
        file.warn(name, "the extension " + quote(name.string()) + " is not read: " +
                            std::string(known == NOT_READ.end() ? "what it adds is missing" : known->second));
    }
}

}  // namespace candela::gltf
