// See gpu_scene.h.
#include "gpu_scene/gpu_scene.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>

#include "base/error.h"
#include "base/text.h"
#include "gpu_scene/append.h"
#include "gpu_scene/coplanar_lights.h"
#include "gpu_scene/environment_map.h"
#include "gpu_scene/flatten.h"
#include "gpu_scene/geometry_arrays.h"
#include "gpu_scene/light_groups.h"
#include "gpu_scene/material_arrays.h"
#include "gpu_scene/nesting.h"
#include "gpu_scene/punctual_lights.h"
#include "gpu_scene/texture_table.h"
#include "scene/geometry.h"
#include "scene/materials.h"
#include "shared/material.h"

namespace candela {
namespace {

void append_alias(std::vector<uvec4>& out, const std::vector<AliasEntry>& entries) {
    for (size_t i = 0; i < entries.size(); i += 2)
        append(out, pack(entries[i], i + 1 < entries.size() ? entries[i + 1] : AliasEntry{}));
}

// Adds the environment to the lights, with the power that falls onto the scene, as if onto a disk as wide as
// the sphere around its box; but no more than that of all other lights together, so that these get at least
// half of the samples: a large floor receives much light from the sky and yet is no brighter for it, and half
// as many samples as needed cost less than a tenth as many. Ref: Pharr, Jakob and Humphreys 2023, Physically
// Based Rendering, section 12.5.
//
// An even sky does not become a light: BSDF samples find it as well as light samples would, and those are
// better spent on the lamps. Returns whether the environment is a light now.
bool add_environment_light(FlatScene& flat, const EnvironmentMap& map, const Box& box) {
    if (map.even) return false;
    const double radius = box.is_empty() ? 0.0 : 0.5 * length(glm::dvec3(box.extent()));
    double power = radius * radius * map.irradiance;
    if (power == 0.0) return false;
    if (!flat.powers.empty()) {
        power = std::min(power, std::accumulate(flat.powers.begin(), flat.powers.end(), 0.0));
    }
    LightRecord sky{};
    sky.kind = LIGHT_ENVIRONMENT;
    flat.lights.push_back(sky);
    flat.powers.push_back(power);
    return true;
}

// Whether what a surface emits passes fuzz, a coat or sheen.
bool has_layers(const Material& material) {
    const auto* m = std::get_if<PrincipledMaterial>(&material.model);
    return m != nullptr && !m->unlit &&
           (m->fuzz.factor > 0.0f || m->coat.factor > 0.0f || m->sheen_color.factor != vec3(0.0f));
}

// The attributes of vertices that textures and materials read.
uint32_t needed_attributes(const GpuScene& gpu) {
    const auto bit = [](bool used, uint32_t of) { return used ? of : 0; };
    return bit((gpu.texture_traits & TEXTURE_UV0) != 0, ATTRIBUTE_UV0) |
           bit((gpu.texture_traits & TEXTURE_UV1) != 0, ATTRIBUTE_UV1) |
           bit((gpu.textured & TEXTURED_VERTEX_COLORS) != 0, ATTRIBUTE_COLOR) |
           bit((gpu.textured & TEXTURED_NORMAL) != 0 ||
                   (gpu.principled & (PRINCIPLED_HAS_ANISOTROPY | PRINCIPLED_HAS_COAT_NORMAL)) != 0,
               ATTRIBUTE_TANGENT);
}

// Appends the textures of lights, for their surfaces' places in leaf order, if a kernel reads them.
void append_light_textures(GpuScene& gpu, const FlatScene& flat, std::span<const uint32_t> order,
                           TextureTable& textures) {
    if ((gpu.textured & (TEXTURED_EMISSION | TEXTURED_OPACITY)) == 0 &&
        (gpu.principled & PRINCIPLED_HAS_COATED_EMISSION) == 0)
        return;
    std::vector<uint32_t> places(order.size());
    for (uint32_t i = 0; i < order.size(); ++i)
        places[order[i]] = i;
    for (const auto& [primitive, shape] : flat.light_surfaces) {
        append(gpu.arrays[ARRAY_LIGHT_TEXTURES],
               pack(LightTextures{.primitive = places[primitive],
                                  .emission = textures.add(shape->emission->radiance.texture),
                                  .material = shape->material}));
    }
}

}  // namespace

Instance instance_at(const GpuScene& scene, const InstancePlace& place) {
    const uvec4* const words = &scene.arrays[ARRAY_NODES][size_t{place.node} * BVH_NODE_WORDS];
    return instance_unpack(words[0], words[1], words[2], words[3]);
}

uint64_t GpuScene::bytes() const {
    uint64_t words = 0;
    for (const std::vector<uvec4>& array : arrays)
        words += array.size();
    return words * sizeof(uvec4);
}

namespace {

// Throws Error if the triangles that emit are more than lights may be.
void check_emitters(const Scene& scene) {
    constexpr uint64_t MOST_LIGHTS = 1u << 24u;  // A gigabyte of records.
    uint64_t triangles = 0;
    for (const Shape& shape : scene.shapes) {
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance != nullptr && shape.emission) triangles += scene.meshes[instance->mesh].triangles.size();
    }
    if (triangles > MOST_LIGHTS) {
        throw Error(concat("the scene has ", triangles,
                           " triangles that emit, each of which is a light, but at most ", MOST_LIGHTS,
                           " are possible; let fewer copies of a mesh emit, or simpler ones"));
    }
}

// `packed(i)` is called when the texels of image i have been copied.
GpuScene build(const Scene& scene, const SceneFrame& frame, const InstancingRule& rule,
               const std::function<void(size_t)>& packed) {
    GpuScene gpu;
    gpu.frame = frame;
    TextureTable textures(scene.images);
    if (std::ranges::any_of(scene.shapes, [&](const Shape& shape) { return lets_rays_pass(scene, shape); }))
        gpu.textured |= TEXTURED_OPACITY;
    append_materials(gpu, scene.materials, textures);
    Nesting nesting = find_nesting(scene);
    gpu.nested_media = nesting.nested;
    gpu.warnings = std::move(nesting.warnings);
    if (const auto warning = warn_of_coplanar_lights(scene)) gpu.warnings.push_back(*warning);
    for (const Shape& shape : scene.shapes) {
        if (shape.emission && has_layers(scene.materials[shape.material]))
            gpu.principled |= PRINCIPLED_HAS_COATED_EMISSION;
        if (shape.emission && textures.add(shape.emission->radiance.texture) != TEXTURE_NONE)
            gpu.textured |= TEXTURED_EMISSION;
    }
    gpu.texture_traits = textures.traits();
    gpu.attributes = needed_attributes(gpu);
    gpu.arrays[ARRAY_TEXTURES] = textures.records();
    check_emitters(scene);
    const Instancing instancing = choose_instances(scene, rule);
    FlatScene flat = flatten(scene, frame, gpu.attributes, instancing.is_instance);
    gpu.arrays[ARRAY_TEXELS] = textures.texels(packed);  // Lights have read the images.
    const SceneTree tree = append_geometry(gpu, scene, flat, instancing);

    append_light_textures(gpu, flat, tree.order, textures);
    add_punctual_lights(flat, scene, frame, tree.bounds);
    if (scene.environment) {
        EnvironmentMap map = build_environment_map(*scene.environment);
        const bool is_light = add_environment_light(flat, map, tree.bounds);
        gpu.environment = scene.environment->visible ? ENVIRONMENT_VISIBLE : ENVIRONMENT_HIDDEN;
        gpu.even_sky = map.even;
        gpu.environment_size = scene.environment->size;
        gpu.environment_rotation = scene.environment->rotation;
        for (EnvironmentTexel& texel : map.texels) {
            if (!is_light) texel.pdf = 0.0f;
            append(gpu.arrays[ARRAY_ENVIRONMENT], pack(texel));
        }
        append_alias(gpu.arrays[ARRAY_ENVIRONMENT_ALIAS], map.alias);
    }
    gpu.light_groups = group_lights(flat);
    gpu.light_count = uint32_t(flat.lights.size());

    for (const LightRecord& light : flat.lights) {
        append(gpu.arrays[ARRAY_LIGHTS], pack(light));
        gpu.lights_present |= 1u << light.kind;
    }
    append_alias(gpu.arrays[ARRAY_LIGHT_ALIAS], light_alias_tables(gpu.light_groups, flat.powers));
    return gpu;
}

}  // namespace

GpuScene build_gpu_scene(const Scene& scene) {
    return build_gpu_scene(scene, choose_frame(scene));
}

GpuScene build_gpu_scene(const Scene& scene, const SceneFrame& frame, const InstancingRule& rule) {
    return build(scene, frame, rule, [](size_t) {});
}

GpuScene build_gpu_scene_freeing_images(Scene& scene) {
    const auto free = [&](size_t i) {
        std::shared_ptr<const TexelImage>& image = scene.images[i].image;
        image = std::make_shared<TexelImage>(
            TexelImage{image->size, image->channels, image->type, {}, image->gamma});
    };
    return build(scene, choose_frame(scene), {}, free);
}

}  // namespace candela
