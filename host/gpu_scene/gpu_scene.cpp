// See gpu_scene.h.
#include "gpu_scene/gpu_scene.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include "base/error.h"
#include "base/text.h"
#include "bvh/bvh.h"
#include "gpu_scene/alias_table.h"
#include "gpu_scene/environment_map.h"
#include "gpu_scene/flatten.h"
#include "gpu_scene/material_record.h"
#include "gpu_scene/nesting.h"
#include "gpu_scene/principled_record.h"
#include "gpu_scene/punctual_lights.h"
#include "gpu_scene/texture_table.h"
#include "scene/geometry.h"
#include "scene/materials.h"
#include "scene/mesh.h"
#include "shared/bvh_node.h"
#include "shared/material.h"
#include "shared/primitive.h"

namespace candela {
namespace {

template <class Record>
void append(std::vector<uvec4>& out, const Record& record) {
    out.insert(out.end(), record.begin(), record.end());
}

void append(std::vector<uvec4>& out, const std::vector<AliasEntry>& entries) {
    for (size_t i = 0; i < entries.size(); i += 2)
        append(out, pack(entries[i], i + 1 < entries.size() ? entries[i + 1] : AliasEntry{}));
}

Bvh build_bvh_over(const std::vector<Primitive>& primitives) {
    std::vector<Box> boxes;
    boxes.reserve(primitives.size());
    for (const Primitive& primitive : primitives)
        boxes.push_back(bounds(primitive));
    return build_bvh(boxes);
}

// For each corner of the first primitives in leaf order, the first corner with the same bits.
std::array<uint32_t, LIST_MAX> list_corners(const std::vector<Primitive>& primitives,
                                            std::span<const uint32_t> order) {
    std::array<uint32_t, LIST_MAX> result{};
    std::vector<std::array<uint32_t, 3>> corners;
    for (size_t i = 0; i < std::min<size_t>(order.size(), LIST_MAX); ++i) {
        const Primitive& p = primitives[order[i]];
        for (const vec3& corner : {p.a, p.b, p.c, p.d}) {
            corners.push_back(std::bit_cast<std::array<uint32_t, 3>>(corner));
            const auto first = uint32_t(std::ranges::find(corners, corners.back()) - corners.begin());
            result[i] |= first << 8u * ((corners.size() - 1) % 4);
        }
    }
    return result;
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

uint32_t textured_bits(const MaterialTextures& t) {
    const auto bit = [](bool used, uint32_t of) { return used ? of : 0; };
    return bit(t.base != TEXTURE_NONE, TEXTURED_BASE) | bit(t.specular != TEXTURE_NONE, TEXTURED_SPECULAR) |
           bit(t.parameter != TEXTURE_NONE, TEXTURED_PARAMETER) |
           bit(t.normal != TEXTURE_NONE, t.bump != 0 ? TEXTURED_BUMP : TEXTURED_NORMAL) |
           bit(t.vertex_colors != 0, TEXTURED_VERTEX_COLORS);
}

MaterialTextures textures_of(const Material& material, const EncodedMaterial& encoded,
                             const SceneFrame& frame, TextureTable& textures) {
    constexpr float NO_CUTOFF = -1.0f;
    const auto& [opacity, cutoff] = material.opacity;
    const std::optional<NormalMap>& map = material.normal_map;
    const std::optional<BumpMap>& bump = material.bump_map;
    return {.base = textures.add(encoded.base),
            .specular = textures.add(encoded.specular),
            .parameter = textures.add(encoded.parameter),
            .normal = map    ? textures.add(map->texture)
                      : bump ? textures.add(bump->texture)
                             : TEXTURE_NONE,
            .bump = !map && bump ? 1u : 0u,
            .normal_scale = map    ? map->scale
                            : bump ? frame.length(double(bump->scale))
                                   : 1.0f,
            .opacity_texture = textures.add(opacity.texture),
            .opacity = opacity.factor,
            .cutoff = cutoff.value_or(NO_CUTOFF),
            .vertex_colors = material.vertex_colors ? 1u : 0u,
            .culled = is_culled(material) ? 1u : 0u};
}

// Whether what a surface emits passes fuzz, a coat or sheen.
bool has_layers(const Material& material) {
    const auto* m = std::get_if<PrincipledMaterial>(&material.model);
    return m != nullptr && !m->unlit &&
           (m->fuzz.factor > 0.0f || m->coat.factor > 0.0f || m->sheen_color.factor != vec3(0.0f));
}

// What materials know a medium by; appends it to the media if it is new. (The first of them, outside of
// everything, is none that a surface encloses.)
uint32_t add_medium(std::vector<Interior>& media, const Interior& medium) {
    auto place = std::find(media.begin() + 1, media.end(), medium);
    if (place == media.end()) place = media.insert(place, medium);
    if (media.size() > MAX_MEDIA) {
        throw Error("the materials have more than " + std::to_string(MAX_MEDIA - 1) +
                    " different media inside; use fewer");
    }
    static_assert(MAX_PRIORITY << MEDIUM_INDEX_BITS < 1u << MEDIUM_BITS);
    return medium.priority << MEDIUM_INDEX_BITS | uint32_t(place - media.begin());
}

// Appends the record of a principled material and its images to `words`; returns its first word there.
uint32_t append_principled(std::vector<uvec4>& words, EncodedPrincipled encoded, TextureTable& textures) {
    const auto first = uint32_t(words.size());
    if (first >= PRINCIPLED_PLACES)
        throw Error("the principled materials are too many for their records; use fewer");
    const auto images = principled_images(encoded.textures);
    encoded.record.images = uint32_t(images.size());
    encoded.record.coat_normal = textures.add(encoded.coat_normal);
    append(words, pack(encoded.record));
    for (const auto& [texture, image] : images) {
        PrincipledImage record = image;
        record.texture = textures.add(texture);
        words.push_back(pack(record));
    }
    return first;
}

// Appends the records of materials, and of the media behind them, each once.
void append_materials(GpuScene& gpu, const std::vector<Material>& materials, TextureTable& textures) {
    if (materials.size() > MAX_MATERIALS) {
        throw Error("the scene has " + std::to_string(materials.size()) + " materials, but at most " +
                    std::to_string(MAX_MATERIALS) + " fit into the records; use fewer");
    }
    gpu.material_count = uint32_t(materials.size());
    std::vector<Interior> media(1);
    static_assert(MEDIUM_NONE == 0);
    std::vector<std::pair<size_t, EncodedPrincipled>> principled;  // And the words of their materials.
    for (const Material& material : materials) {
        const std::optional<Interior> inside = interior(material.model);
        const uint32_t medium = inside ? add_medium(media, *inside) : MEDIUM_NONE;
        const EncodedMaterial encoded = encode_material(material.model, medium);
        if (encoded.principled) {
            principled.emplace_back(gpu.arrays[ARRAY_MATERIALS].size(), *encoded.principled);
            gpu.principled |= encoded.principled->parts;
            // Its coat has a normal of its own if the base has one.
            const bool bent = material.normal_map || material.bump_map;
            if (bent && (encoded.principled->parts & PRINCIPLED_HAS_COAT) != 0)
                gpu.principled |= PRINCIPLED_HAS_COAT_NORMAL;
        }
        append(gpu.arrays[ARRAY_MATERIALS], pack(encoded.record));
        gpu.materials_present |= 1u << encoded.record.model;
        const MaterialTextures used = textures_of(material, encoded, gpu.frame, textures);
        append(gpu.arrays[ARRAY_MATERIAL_TEXTURES], pack(used));
        gpu.textured |= textured_bits(used);
        if (used.culled != 0) gpu.principled |= PRINCIPLED_HAS_CULLED;
    }
    for (const auto& [word, encoded] : principled) {
        std::vector<uvec4>& words = gpu.arrays[ARRAY_MATERIALS];
        const uint32_t first = append_principled(words, encoded, textures);
        words[word + 1].x = std::bit_cast<uint32_t>(principled_place(first));
    }
    for (const Interior& m : media) {
        append(gpu.arrays[ARRAY_MEDIA],
               pack(MediumRecord{vec3(gpu.frame.unit * dvec3(m.medium.absorption)), m.ior}));
        gpu.has_media |= m.medium != Medium{};
    }
    if (gpu.textured == 0) gpu.arrays[ARRAY_MATERIAL_TEXTURES].clear();
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

uint64_t GpuScene::bytes() const {
    uint64_t words = 0;
    for (const std::vector<uvec4>& array : arrays)
        words += array.size();
    return words * sizeof(uvec4);
}

SceneFrame choose_frame(const Scene& scene) {
    const DoubleBox box = bounds(scene);
    if (box.is_empty()) return {};
    const dvec3 extent = box.extent();
    const double size = std::max({extent.x, extent.y, extent.z});
    SceneFrame frame{.origin = box.centroid()};
    if (size > 0.0) {
        int exponent = 0;
        std::frexp(size, &exponent);
        frame.unit = std::ldexp(1.0, exponent);
    }
    return frame;
}

namespace {

// `packed(i)` is called when the texels of image i have been copied.
GpuScene build(const Scene& scene, const SceneFrame& frame, const std::function<void(size_t)>& packed) {
    GpuScene gpu;
    gpu.frame = frame;
    TextureTable textures(scene.images);
    if (std::ranges::any_of(scene.shapes, [&](const Shape& shape) { return lets_rays_pass(scene, shape); }))
        gpu.textured |= TEXTURED_OPACITY;
    append_materials(gpu, scene.materials, textures);
    Nesting nesting = find_nesting(scene);
    gpu.nested_media = nesting.nested;
    gpu.warnings = std::move(nesting.warnings);
    for (const Shape& shape : scene.shapes) {
        if (shape.emission && has_layers(scene.materials[shape.material]))
            gpu.principled |= PRINCIPLED_HAS_COATED_EMISSION;
        if (shape.emission && textures.add(shape.emission->radiance.texture) != TEXTURE_NONE)
            gpu.textured |= TEXTURED_EMISSION;
    }
    gpu.texture_traits = textures.traits();
    gpu.attributes = needed_attributes(gpu);
    gpu.arrays[ARRAY_TEXTURES] = textures.records();
    FlatScene flat = flatten(scene, frame, gpu.attributes);
    gpu.arrays[ARRAY_TEXELS] = textures.texels(packed);
    gpu.primitive_count = uint32_t(flat.primitives.size());
    gpu.id_count = flat.id_count;
    gpu.has_normals = !flat.normals.empty();
    if (is_too_coarse(flat.coarse, flat.triangles)) {
        gpu.warnings.push_back(
            std::to_string(flat.coarse) + " of " + std::to_string(flat.triangles) +
            " triangles are smaller than 16 steps of 32-bit coordinates in a scene of this "
            "size, " +
            number_text(frame.unit, 3) + " m: they look rough; render what is far apart by itself");
    }
    if (flat.flattened > 0) {
        gpu.warnings.push_back("left out " + std::to_string(flat.flattened) +
                               (flat.flattened == 1 ? " triangle" : " triangles") +
                               " too small for 32-bit coordinates in a scene of this size");
    }

    const auto start = std::chrono::steady_clock::now();
    const Bvh bvh = build_bvh_over(flat.primitives);
    gpu.bvh_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    gpu.bvh_depth = bvh.depth;
    gpu.bvh_sah_cost = bvh.sah_cost;

    gpu.arrays[ARRAY_NODES].reserve(bvh.nodes.size() * BVH_NODE_WORDS);
    for (const auto& node : bvh.nodes)
        append(gpu.arrays[ARRAY_NODES], node);
    gpu.arrays[ARRAY_PRIMITIVES].reserve(flat.primitives.size() * PRIMITIVE_WORDS);
    for (const uint32_t i : bvh.order) {
        append(gpu.arrays[ARRAY_PRIMITIVES], pack(flat.primitives[i]));
        gpu.primitives_present |= 1u << flat.primitives[i].kind;
    }
    gpu.list_corners = list_corners(flat.primitives, bvh.order);
    if (flat.primitives.empty())
        gpu.arrays[ARRAY_PRIMITIVES].resize(PRIMITIVE_WORDS);  // Traversal may read it all the same.

    append_light_textures(gpu, flat, bvh.order, textures);
    add_punctual_lights(flat, scene, frame, bvh.bounds);
    if (scene.environment) {
        EnvironmentMap map = build_environment_map(*scene.environment);
        const bool is_light = add_environment_light(flat, map, bvh.bounds);
        if (is_light) gpu.environment_light = uint32_t(flat.lights.size() - 1);
        gpu.environment = scene.environment->visible ? ENVIRONMENT_VISIBLE : ENVIRONMENT_HIDDEN;
        gpu.even_sky = map.even;
        gpu.environment_size = scene.environment->size;
        gpu.environment_rotation = scene.environment->rotation;
        for (EnvironmentTexel& texel : map.texels) {
            if (!is_light) texel.pdf = 0.0f;
            append(gpu.arrays[ARRAY_ENVIRONMENT], pack(texel));
        }
        append(gpu.arrays[ARRAY_ENVIRONMENT_ALIAS], map.alias);
    }
    assign_probabilities(flat);
    gpu.light_count = uint32_t(flat.lights.size());

    gpu.arrays[ARRAY_SURFACES].reserve(flat.surfaces.size() * SURFACE_WORDS);
    for (const uint32_t i : bvh.order)
        append(gpu.arrays[ARRAY_SURFACES], pack(flat.surfaces[i]));
    if (gpu.has_normals) {
        gpu.arrays[ARRAY_NORMALS].reserve(flat.normals.size() * NORMALS_WORDS);
        for (const uint32_t i : bvh.order)
            append(gpu.arrays[ARRAY_NORMALS], flat.normals[i]);
    }
    const size_t attribute_count = attribute_words(gpu.attributes);
    gpu.arrays[ARRAY_ATTRIBUTES].reserve(flat.attributes.size());
    for (const uint32_t i : bvh.order) {
        append(gpu.arrays[ARRAY_ATTRIBUTES],
               std::span(flat.attributes).subspan(i * attribute_count, attribute_count));
    }
    for (const LightRecord& light : flat.lights) {
        append(gpu.arrays[ARRAY_LIGHTS], pack(light));
        gpu.lights_present |= 1u << light.kind;
    }
    if (gpu.light_count > 0) append(gpu.arrays[ARRAY_LIGHT_ALIAS], build_alias_table(flat.powers));
    return gpu;
}

}  // namespace

GpuScene build_gpu_scene(const Scene& scene) {
    return build_gpu_scene(scene, choose_frame(scene));
}

GpuScene build_gpu_scene(const Scene& scene, const SceneFrame& frame) {
    return build(scene, frame, [](size_t) {});
}

GpuScene build_gpu_scene_freeing_images(Scene& scene) {
    return build(scene, choose_frame(scene),
                 [&](size_t i) { scene.images[i].image.texels = std::vector<std::byte>(); });
}

}  // namespace candela
