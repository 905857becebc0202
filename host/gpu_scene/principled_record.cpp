// See principled_record.h.
#include "gpu_scene/principled_record.h"

#include <algorithm>
#include <cmath>

#include "shared/texture.h"

namespace candela {
namespace {

constexpr float ALL_REFLECTING_IOR = 1e6f;

bool is_white(const Textured<vec3>& color) {
    return !color.texture && color.factor == vec3(1.0f);
}

bool is_one(const Textured<float>& number) {
    return !number.texture && number.factor >= 1.0f;
}

uint32_t parts_of(const PrincipledMaterial& m) {
    uint32_t parts = 0;
    const auto has = [&](bool there, uint32_t part) { parts |= there ? part : 0u; };
    const bool transmits = m.transmission.factor > 0.0f;
    const bool coated = m.coat.factor > 0.0f;
    const float roughness = std::max(m.roughness.factor, m.anisotropy.factor);
    has(m.metalness.factor > 0.0f, PRINCIPLED_HAS_METAL);
    has(roughness * roughness >= MIN_FACET_ALPHA, PRINCIPLED_HAS_ROUGH);
    has(m.anisotropy.factor > 0.0f, PRINCIPLED_HAS_ANISOTROPY);
    if (!is_one(m.metalness) && !is_one(m.transmission)) {
        has(!is_one(m.diffuse_transmission), PRINCIPLED_HAS_DIFFUSE);
        has(m.diffuse_roughness.factor > 0.0f, PRINCIPLED_HAS_DIFFUSE_ROUGHNESS);
        has(m.diffuse_transmission.factor > 0.0f, PRINCIPLED_HAS_DIFFUSE_TRANSMISSION);
    }
    has(transmits, m.inside ? PRINCIPLED_HAS_VOLUME : PRINCIPLED_HAS_THIN);
    // A medium behind a diffuse sheet has an index, too.
    has(m.inside && m.diffuse_transmission.factor > 0.0f, PRINCIPLED_HAS_VOLUME);
    has(!is_one(m.specular) || !is_white(m.specular_color), PRINCIPLED_HAS_SPECULAR);
    has(transmits && m.inside && m.dispersion > 0.0f, PRINCIPLED_HAS_DISPERSION);
    has(coated, PRINCIPLED_HAS_COAT);
    has(coated && m.coat_darkening > 0.0f, PRINCIPLED_HAS_COAT_DARKENING);
    has(coated && m.coat_normal_map, PRINCIPLED_HAS_COAT_NORMAL);
    has(m.sheen_color.factor != vec3(0.0f), PRINCIPLED_HAS_SHEEN);
    has(m.fuzz.factor > 0.0f, PRINCIPLED_HAS_FUZZ);
    has(m.iridescence.factor > 0.0f, PRINCIPLED_HAS_IRIDESCENCE);
    const uint32_t scatters_through = transmits && (parts & PRINCIPLED_HAS_ROUGH) != 0
                                          ? parts & (PRINCIPLED_HAS_THIN | PRINCIPLED_HAS_VOLUME)
                                          : 0;
    has(scatters_through != 0 || (parts & PRINCIPLED_HAS_DIFFUSE_TRANSMISSION) != 0,
        PRINCIPLED_IS_LIT_FROM_BEHIND);
    return parts;
}

constexpr bool bits_differ() {
    uint seen = 0;
    for (const uint value : {
             PRINCIPLED_BASE_COLOR,
             PRINCIPLED_ANISOTROPY_MAP,
             PRINCIPLED_THICKNESS,
#define COLOR(bit, name, word) uint(bit),
#define WEIGHT(bit, name, word, place) uint(bit),
#include "shared/principled_record.inc"
         }) {
        if ((seen & 1u << value) != 0) return false;
        seen |= 1u << value;
    }
    return true;
}
static_assert(bits_differ(), "two values in shared/principled_record.inc have the same bit");

std::vector<PrincipledTexture> textures_of(const PrincipledMaterial& m) {
    std::vector<PrincipledTexture> result;
    const auto add = [&](uint32_t value, const auto& from) {
        if (from.texture) result.push_back({value, *from.texture});
    };
    add(PRINCIPLED_BASE_COLOR, m.base_color);
    if (m.anisotropy_map) result.push_back({PRINCIPLED_ANISOTROPY_MAP, *m.anisotropy_map});
    add(PRINCIPLED_THICKNESS, m.iridescence_thickness);
#define COLOR(bit, name, word) add(bit, m.name);
#define WEIGHT(bit, name, word, place) add(bit, m.name);
#include "shared/principled_record.inc"
    return result;
}

}  // namespace

float principled_ior(const PrincipledMaterial& m) {
    return m.ior == 0.0f ? ALL_REFLECTING_IOR : m.ior;
}

double internal_reflectance(double n) {
    if (n == 1.0) return 0.0;
    const double n2 = n * n, n4 = n2 * n2, below = (n2 + 1.0) * (n4 - 1.0);
    const double outer =
        0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0)) +
        n2 * (n2 - 1.0) * (n2 - 1.0) / std::pow(n2 + 1.0, 3) * std::log((n - 1.0) / (n + 1.0)) -
        2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / below +
        8.0 * n4 * (n4 + 1.0) / (below * (n4 - 1.0)) * std::log(n);
    return 1.0 - (1.0 - outer) / n2;
}

EncodedPrincipled encode_principled(const PrincipledMaterial& m) {
    EncodedPrincipled result;
    PrincipledRecord& record = result.record;
#define COLOR(bit, name, word) record.name = m.name.factor;
#define WEIGHT(bit, name, word, place) record.name = m.name.factor;
#define NUMBER(name, word, place) record.name = m.name;
#include "shared/principled_record.inc"
    record.thickness = m.iridescence_thickness_min;
    record.thickness_range = m.iridescence_thickness.factor - m.iridescence_thickness_min;
    record.rotation = vec2(std::cos(m.anisotropy_rotation), std::sin(m.anisotropy_rotation));
    record.coat_normal = TEXTURE_NONE;
    record.coat_normal_scale = m.coat_normal_map ? m.coat_normal_map->scale : 1.0f;
    record.coat_internal = float(internal_reflectance(double(m.coat_ior)));
    // Without a texture the film has its greatest thickness.
    if (!m.iridescence_thickness.texture) {
        record.thickness = m.iridescence_thickness.factor;
        record.thickness_range = 0.0f;
    }
    result.parts = parts_of(m);
    result.textures = textures_of(m);
    if (!result.textures.empty()) result.parts |= PRINCIPLED_HAS_IMAGES;
    if (m.coat_normal_map && m.coat.factor > 0.0f) result.coat_normal = m.coat_normal_map->texture;
    return result;
}

std::vector<std::pair<Texture, PrincipledImage>> principled_images(
    const std::vector<PrincipledTexture>& textures) {
    std::vector<std::pair<Texture, PrincipledImage>> result;
    for (const auto& [value, texture] : textures) {
        Texture image = texture;
        image.channel = RED;
        auto place = std::ranges::find(result, image, &std::pair<Texture, PrincipledImage>::first);
        if (place == result.end()) place = result.insert(result.end(), {image, PrincipledImage{}});
        PrincipledImage& record = place->second;
        record.values |= 1u << value;
        (value < 16 ? record.channels.x : record.channels.y) |= texture.channel << 2u * (value % 16);
    }
    return result;
}

}  // namespace candela
