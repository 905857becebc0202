// See extensions.h. docs/gltf.md has the same table for people.
#include "load/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "image/texel_io.h"
#include "load/quote.h"

namespace candela::gltf {
namespace {

constexpr std::array<std::string_view, 27> READ{"EXT_lights_image_based",
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
                                                "KHR_materials_volume_scatter",
                                                "KHR_mesh_quantization",
                                                "KHR_meshopt_compression",
                                                "KHR_node_visibility",
                                                "KHR_texture_transform",
                                                "KHR_xmp_json_ld",
                                                "VRMC_materials_hdr_emissiveMultiplier"};

// These extensions do not affect a picture: metadata, sound, physics, behaviour, hints, lines. A name that
// ends in * matches all names that begin so.
constexpr std::array<std::string_view, 42> UNSEEN{"AGI_articulations",
                                                  "AGI_stk_metadata",
                                                  "ASOBO_asset_optimized",
                                                  "ASOBO_tags",
                                                  "ASOBO_unique_id",
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
                                                  "GODOT_*",
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
                                                  "NEEDLE_*",
                                                  "OMI_*",
                                                  "VRMC_node_constraint",
                                                  "VRMC_springBone*",
                                                  "VRMC_vrm*"};

// Extensions that are not read, and what is then missing.
constexpr const char* OTHER_IMAGES = "images in PNG, JPEG or WebP are used instead";
constexpr const char* NO_TOON = "toon shading looks as the material does without it";
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> NOT_READ{
    {{"ADOBE_materials_thin_transparency", "thin walls are as opaque as the material is without it"},
     {"EXT_lights_ies", "lights shine evenly, without a profile"},
     {"EXT_texture_avif", OTHER_IMAGES},
     {"FB_materials_modmap", "materials look as they do without it"},
     {"GOOGLE_tilt_brush_material", "brushes look as their materials do without it"},
     {"KHR_gaussian_splatting", "splats are points, which are left out"},
     {"KHR_gaussian_splatting_compression_spz_2", "splats are points, which are left out"},
     {"KHR_techniques_webgl", "materials look as they do without it"},
     {KTX_IMAGES, OTHER_IMAGES},
     {"MOZ_lightmap", "light is computed instead"},
     {"MSFT_texture_dds", OTHER_IMAGES},
     {"NV_materials_mdl", "materials look as they do without it"},
     {"VRM", NO_TOON},
     {"VRMC_materials_mtoon", NO_TOON}}};

// What to do about a file that requires one of these; without their data it would show nothing, or the wrong
// thing.
constexpr const char* CONVERT_IMAGES = "convert its images to PNG, JPEG or WebP";
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> REMEDIES{
    {{"EXT_texture_avif", CONVERT_IMAGES},
     {"KHR_gaussian_splatting", "its splats are points without a surface: export a mesh of the scene"},
     {KTX_IMAGES,
      "run sh cmake/basisu.sh and build candela again, or convert its images to PNG, JPEG or WebP"},
     {"MSFT_texture_dds", CONVERT_IMAGES}}};

bool fits(std::string_view name, std::string_view known) {
    return known.ends_with('*') ? name.starts_with(known.substr(0, known.size() - 1)) : name == known;
}

bool is_read(std::string_view name) {
    return std::ranges::find(READ, name) != READ.end() || (name == KTX_IMAGES && reads_ktx_texels());
}

bool is_unseen(std::string_view name) {
    return std::ranges::any_of(UNSEEN, [&](std::string_view known) { return fits(name, known); });
}

// What is missing without an extension that is not read.
std::string missing_without(std::string_view name) {
    const auto known = std::ranges::find(NOT_READ, name, [](const auto& entry) { return entry.first; });
    return std::string(known == NOT_READ.end() ? "what it adds is missing" : known->second);
}

void refuse_required(File& file) {
    const auto required = file.root().find("extensionsRequired");
    if (!required) return;
    for (const Node& name : required->elements()) {
        if (is_read(name.string()) || is_unseen(name.string())) continue;
        const auto remedy = std::ranges::find(REMEDIES, std::string_view(name.string()),
                                              [](const auto& entry) { return entry.first; });
        name.fail("the file requires the extension " + quote(name.string()) + ", which is not read; " +
                  std::string(remedy == REMEDIES.end() ? "export the scene without it" : remedy->second));
    }
}

}  // namespace

void check_extensions(File& file) {
    refuse_required(file);
    const auto used = file.root().find("extensionsUsed");
    if (!used) return;
    std::set<std::string> unseen;
    for (const Node& name : used->elements()) {
        if (is_read(name.string())) continue;
        if (is_unseen(name.string())) {
            unseen.insert(quote(name.string()));
            continue;
        }
        file.warn(name, "the extension " + quote(name.string()) +
                            " is not read: " + missing_without(name.string()));
    }
    if (unseen.empty()) return;
    std::string list;
    for (const std::string& name : unseen)
        list += (list.empty() ? "" : ", ") + name;
    file.warn(*used, "what these extensions add does not show in a picture: " + list);
}

}  // namespace candela::gltf
