// See extensions.h. docs/gltf.md has the same table for people.
#include "load/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "load/quote.h"

namespace candela::gltf {
namespace {

constexpr std::array<std::string_view, 26> READ{"EXT_lights_image_based",
                                                "EXT_mesh_gpu_instancing",
                                                "EXT_meshopt_compression",
                                                "EXT_texture_webp",
                                                "KHR_draco_mesh_compression",
                                                "KHR_lights_punctual",
                                                "KHR_materials_anisotropy",
                                                "KHR_materials_clearcoat",
                                                "KHR_materials_diffuse_transmission",
                                                "KHR_materials_dispersion",
                                                "KHR_materials_emissive_strength",
                                                "KHR_materials_ior",
                                                "KHR_materials_iridescence",
                                                "KHR_materials_pbrSpecularGlossiness",
                                                "KHR_materials_sheen",
                                                "KHR_materials_specular",
                                                "KHR_materials_transmission",
                                                "KHR_materials_unlit",
                                                "KHR_materials_variants",
                                                "KHR_materials_volume",
                                                "KHR_mesh_quantization",
                                                "KHR_meshopt_compression",
                                                "KHR_node_visibility",
                                                "KHR_texture_transform",
                                                "KHR_xmp_json_ld",
                                                "VRMC_materials_hdr_emissiveMultiplier"};

// These extensions do not affect a picture: metadata, sound, physics, behaviour, hints, lines. A name that
// ends in * matches all names that begin so.
constexpr std::array<std::string_view, 38> UNSEEN{"AGI_articulations",
                                                  "AGI_stk_metadata",
                                                  "BENTLEY_materials_line_style",
                                                  "BENTLEY_materials_point_style",
                                                  "CESIUM_primitive_outline",
                                                  "CESIUM_RTC",
                                                  "EXT_feature_metadata",
                                                  "EXT_instance_features",
                                                  "EXT_mesh_features",
                                                  "EXT_mesh_manifold",
                                                  "EXT_mesh_primitive_edge_visibility",
                                                  "EXT_structural_metadata",
                                                  "FB_geometry_metadata",
                                                  "FB_ngon_encoding",
                                                  "GODOT_single_root",
                                                  "GOOGLE_camera_settings",
                                                  "GRIFFEL_bim_data",
                                                  "HUBS_components",
                                                  "KHR_animation_pointer",
                                                  "KHR_audio*",
                                                  "KHR_collision_shapes",
                                                  "KHR_implicit_shapes",
                                                  "KHR_interactivity",
                                                  "KHR_node_hoverability",
                                                  "KHR_node_selectability",
                                                  "KHR_physics_rigid_bodies",
                                                  "KHR_rigid_bodies",
                                                  "KHR_xmp",
                                                  "MOZ_hubs_components",
                                                  "MSFT_audio_emitter",
                                                  "MSFT_collision_shapes",
                                                  "MSFT_lod",
                                                  "MSFT_packing*",
                                                  "MSFT_physics*",
                                                  "OMI_*",
                                                  "VRMC_node_constraint",
                                                  "VRMC_springBone*",
                                                  "VRMC_vrm*"};

// Extensions that are not read, and what is then missing.
constexpr const char* OTHER_IMAGES = "images in PNG, JPEG or WebP are used instead";
constexpr const char* NO_TOON = "toon shading looks as the material does without it";
constexpr std::array<std::pair<std::string_view, std::string_view>, 13> NOT_READ{
    {{"EXT_lights_ies", "lights shine evenly, without a profile"},
     {"EXT_texture_avif", OTHER_IMAGES},
     {"FB_materials_modmap", "materials look as they do without it"},
     {"GOOGLE_tilt_brush_material", "brushes look as their materials do without it"},
     {"KHR_gaussian_splatting", "splats are points, which are left out"},
     {"KHR_materials_volume_scatter", "bodies absorb light within, but do not scatter it"},
     {"KHR_techniques_webgl", "materials look as they do without it"},
     {"KHR_texture_basisu", OTHER_IMAGES},
     {"MOZ_lightmap", "light is computed instead"},
     {"MSFT_texture_dds", OTHER_IMAGES},
     {"NV_materials_mdl", "materials look as they do without it"},
     {"VRM", NO_TOON},
     {"VRMC_materials_mtoon", NO_TOON}}};

bool fits(std::string_view name, std::string_view known) {
    return known.ends_with('*') ? name.starts_with(known.substr(0, known.size() - 1)) : name == known;
}

// Whether a picture shows everything that the extension describes.
bool needs_no_warning(std::string_view name) {
    return std::ranges::find(READ, name) != READ.end() ||
           std::ranges::any_of(UNSEEN, [&](std::string_view known) { return fits(name, known); });
}

}  // namespace

void check_extensions(File& file) {
    if (const auto required = file.root().find("extensionsRequired")) {
        for (const Node& name : required->elements()) {
            if (needs_no_warning(name.string())) continue;
            name.fail("the file requires the extension " + quote(name.string()) +
                      ", which is not read; export the scene without it");
        }
    }
    const auto used = file.root().find("extensionsUsed");
    if (!used) return;
    for (const Node& name : used->elements()) {
        if (needs_no_warning(name.string())) continue;
        const auto known = std::ranges::find(NOT_READ, std::string_view(name.string()),
                                             [](const auto& entry) { return entry.first; });
        file.warn(name, "the extension " + quote(name.string()) + " is not read: " +
                            std::string(known == NOT_READ.end() ? "what it adds is missing" : known->second));
    }
}

}  // namespace candela::gltf
