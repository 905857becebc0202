// See material_arrays.h.
#include "gpu_scene/material_arrays.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "gpu_scene/append.h"
#include "gpu_scene/material_record.h"
#include "gpu_scene/principled_record.h"
#include "scene/materials.h"
#include "shared/material.h"
#include "shared/primitive.h"

namespace candela {
namespace {

// Whether the shape's material, or the colours of its vertices, may be less than opaque.
bool has_opacity(const Scene& scene, const Shape& shape) {
    const Material& material = scene.materials[shape.material];
    if (material.opacity.value.texture || material.opacity.value.factor < 1.0f) return true;
    const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
    return instance != nullptr && material.vertex_colors &&
           std::ranges::any_of(scene.meshes[instance->mesh].colors, [](vec4 c) { return c.w < 1.0f; });
}

uint32_t textured_bits(const MaterialTextures& t) {
    const auto bit = [](bool used, uint32_t of) { return used ? of : 0; };
    return bit(t.base != TEXTURE_NONE, TEXTURED_BASE) | bit(t.specular != TEXTURE_NONE, TEXTURED_SPECULAR) |
           bit(t.parameter != TEXTURE_NONE, TEXTURED_PARAMETER) |
           bit(t.normal != TEXTURE_NONE, t.bump != 0 ? TEXTURED_BUMP : TEXTURED_NORMAL) |
           bit(t.vertex_colors != 0, TEXTURED_VERTEX_COLORS) | bit(t.hidden != 0, TEXTURED_HIDDEN);
}

uint catcher_code(Catcher catcher) {
    switch (catcher) {
        case Catcher::shadows:
            return CATCHER_SHADOWS;
        case Catcher::reflections:
            return CATCHER_REFLECTIONS;
        case Catcher::holdout:
            return CATCHER_HOLDOUT;
        case Catcher::none:
            break;
    }
    return CATCHER_NONE;
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
            .culled = is_culled(material) ? 1u : 0u,
            .catcher = catcher_code(material.catcher),
            .hidden = material.hidden ? 1u : 0u};
}

// What materials know a medium by; appends it to the media if it is new. (The first of them, outside of
// all solids, is none that a surface encloses.)
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

// Whether what a surface emits passes fuzz, a coat or sheen.
bool has_layers(const Material& material) {
    const auto* m = std::get_if<PrincipledMaterial>(&material.model);
    return m != nullptr && !m->unlit &&
           (m->fuzz.factor > 0.0f || m->coat.factor > 0.0f || m->sheen_color.factor != vec3(0.0f));
}

bool is_small_model(const Scene& scene) {
    uint64_t triangles = 0;
    for (const Shape& shape : scene.shapes) {
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance == nullptr) return false;
        if (!std::holds_alternative<PrincipledMaterial>(scene.materials[shape.material].model)) return false;
        triangles += scene.meshes[instance->mesh].triangles.size();
    }
    return triangles <= SMALL_MODEL_TRIANGLES;
}

uint32_t needed_attributes(const MaterialFacts& facts) {
    if (facts.small_model) return ATTRIBUTES_ALL;
    const auto bit = [](bool used, uint32_t of) { return used ? of : 0; };
    return bit((facts.texture_traits & TEXTURE_UV0) != 0, ATTRIBUTE_UV0) |
           bit((facts.texture_traits & TEXTURE_UV1) != 0, ATTRIBUTE_UV1) |
           bit((facts.textured & TEXTURED_VERTEX_COLORS) != 0, ATTRIBUTE_COLOR) |
           bit((facts.textured & TEXTURED_NORMAL) != 0 ||
                   (facts.principled & (PRINCIPLED_HAS_ANISOTROPY | PRINCIPLED_HAS_COAT_NORMAL)) != 0,
               ATTRIBUTE_TANGENT);
}

// Appends the records of the materials, and of the media that they enclose.
void append_materials(MaterialArrays& out, const Scene& scene, const SceneFrame& frame,
                      TextureTable& textures) {
    std::vector<Interior> media{{scene.medium}};
    static_assert(MEDIUM_NONE == 0);
    std::vector<std::pair<size_t, EncodedPrincipled>> principled;  // And the words of their materials.
    for (const Material& material : scene.materials) {
        const std::optional<Interior> inside = interior(material.model);
        const uint32_t medium = inside ? add_medium(media, *inside) : MEDIUM_NONE;
        const EncodedMaterial encoded = encode_material(material.model, medium);
        if (encoded.principled) {
            principled.emplace_back(out.materials.size(), *encoded.principled);
            out.facts.principled |= encoded.principled->parts;
            // Its coat has a normal of its own if the base has one.
            const bool bent = material.normal_map || material.bump_map;
            if (bent && (encoded.principled->parts & PRINCIPLED_HAS_COAT) != 0)
                out.facts.principled |= PRINCIPLED_HAS_COAT_NORMAL;
        }
        append(out.materials, pack(encoded.record));
        out.facts.volumetric |= std::holds_alternative<InterfaceMaterial>(material.model);
        out.facts.materials_present |= 1u << encoded.record.model;
        const MaterialTextures used = textures_of(material, encoded, frame, textures);
        append(out.material_textures, pack(used));
        out.facts.textured |= textured_bits(used);
        if (used.catcher != CATCHER_NONE) out.facts.has_catchers = true;
        if (used.culled != 0) out.facts.principled |= PRINCIPLED_HAS_CULLED;
    }
    for (const auto& [word, encoded] : principled) {
        const uint32_t first = append_principled(out.materials, encoded, textures);
        out.materials[word + 1].x = std::bit_cast<uint32_t>(principled_place(first));
    }
    for (const Interior& m : media) {
        append(out.media, pack(MediumRecord{.absorption = vec3(frame.unit * dvec3(m.medium.absorption)),
                                            .ior = m.ior,
                                            .scattering = vec3(frame.unit * dvec3(m.medium.scattering)),
                                            .g = m.medium.g}));
        out.facts.has_media |= m.medium.absorption != vec3(0.0f) || m.medium.scattering != vec3(0.0f);
        out.facts.volumetric |= m.medium.scattering != vec3(0.0f);
    }
    if (out.facts.volumetric) out.facts.materials_present |= 1u << MATERIAL_PHASE;
    if (out.facts.textured == 0 && !out.facts.small_model && !out.facts.has_catchers)
        out.material_textures.clear();
}

// What the emissions of shapes look up, and what else of a material depends on the shapes that have it.
void add_emissions(MaterialArrays& out, const Scene& scene, TextureTable& textures) {
    for (const Shape& shape : scene.shapes) {
        if (shape.emission && has_layers(scene.materials[shape.material]))
            out.facts.principled |= PRINCIPLED_HAS_COATED_EMISSION;
        out.emission_textures.push_back(shape.emission ? textures.add(shape.emission->radiance.texture)
                                                       : TEXTURE_NONE);
        if (out.emission_textures.back() != TEXTURE_NONE) out.facts.textured |= TEXTURED_EMISSION;
    }
}

}  // namespace

MaterialArrays build_material_arrays(const Scene& scene, const SceneFrame& frame) {
    if (scene.materials.size() > MAX_MATERIALS) {
        throw Error("the scene has " + std::to_string(scene.materials.size()) + " materials, but at most " +
                    std::to_string(MAX_MATERIALS) + " fit into the records; use fewer");
    }
    MaterialArrays out;
    out.facts.material_count = uint32_t(scene.materials.size());
    out.facts.small_model = is_small_model(scene);
    if (std::ranges::any_of(scene.shapes, [&](const Shape& shape) { return lets_rays_pass(scene, shape); }))
        out.facts.textured |= TEXTURED_PASSABLE;
    if (std::ranges::any_of(scene.shapes, [&](const Shape& shape) { return has_opacity(scene, shape); }))
        out.facts.textured |= TEXTURED_OPACITY;
    TextureTable textures(scene.images);
    append_materials(out, scene, frame, textures);
    add_emissions(out, scene, textures);
    out.textures = textures.records();
    out.image_places = textures.places();
    out.facts.texture_traits = textures.traits();
    out.facts.attributes = needed_attributes(out.facts);
    return out;
}

bool lets_rays_pass(const Scene& scene, const Shape& shape) {
    const Material& material = scene.materials[shape.material];
    return material.hidden || is_culled(material) || has_opacity(scene, shape);
}

}  // namespace candela
