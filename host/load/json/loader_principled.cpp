// Layered materials: "principled", "rough_conductor" and "rough_dielectric".
#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"
#include "load/json/loader_parts.h"

namespace candela {
namespace {

// Throws Error for a key that has no effect without another, which is absent.
void check_companions(const Node& node) {
    constexpr auto COMPANIONS = std::to_array<std::pair<std::string_view, std::string_view>>({
#define VALUE(kind, name, initial, min, max, needs, text) {#name, #needs},
#define KEY(name, member, text)
#include "scene/principled_values.inc"
#undef VALUE
#undef KEY
    });
    for (const auto& [key, companion] : COMPANIONS) {
        const auto found = node.find(key);
        if (!found || companion == "NONE" || node.find(companion)) continue;
        found->fail(
            concat(key, " has no effect without \"", companion, "\"; add that key, or remove this one"));
    }
}

// Throws Error for keys that an unlit material does not use.
void check_unlit(const Node& node) {
    constexpr std::array<std::string_view, 4> USED{"type", "unlit", "base_color", "double_sided"};
    const auto is_in = [](const auto& keys, std::string_view key) {
        return std::ranges::find(keys, key) != keys.end();
    };
    for (const Node& member : node.members()) {
        if (is_in(USED, member.key()) || is_in(keys_of({"material"}), member.key())) continue;
        member.fail(concat(member.key(), " has no effect on an unlit material, which shows its base_color; ",
                           "remove it, or \"unlit\""));
    }
}

const std::string THIN_WITH_MEDIUM =
    "a thin wall has no inside that could absorb or scatter light; remove thin_walled, or \"absorption\" and "
    "\"scattering\"";

// The medium that the keys give, other than "thin_walled".
std::optional<Medium> find_inside(const Node& node, PrincipledMaterial& material) {
    const auto subsurface = node.find("subsurface"), thin = node.find("thin_walled");
    if (!subsurface) return find_medium(node);
    for (const char* other :
         {"diffuse_transmission", "diffuse_transmission_color", "absorption", "scattering"}) {
        if (const auto found = node.find(other))
            found->fail(concat("\"subsurface\" says this, too; remove it, or ", other));
    }
    return read_subsurface(*subsurface, thin && thin->boolean(), material);
}

// Reads what is behind the surface; without a medium and "thin_walled", the same as in front of it if it is
// `thin`.
void read_inside(const Node& node, bool thin, PrincipledMaterial& material) {
    const auto thin_walled = node.find("thin_walled");
    const std::optional<Medium> inside = find_inside(node, material);
    if (inside) thin = false;
    if (thin_walled) thin = thin_walled->boolean();
    if (inside && thin) thin_walled->fail(THIN_WITH_MEDIUM);
    if (!thin) material.inside = inside.value_or(Medium{});
    if (const auto priority = node.find("priority")) {
        material.priority = read_integer(*priority, scene_key("dielectric", "priority"));
        if (thin) {
            priority->fail(
                "priority ranks the medium inside, and a thin wall has none; add \"absorption\" or "
                "\"thin_walled\": false, or remove priority");
        }
    }
}

// Throws Error for keys that contradict the medium inside, or its absence.
void check_inside(const Node& node, const PrincipledMaterial& material) {
    if (const auto dispersion = node.find("dispersion"); dispersion && !material.inside) {
        dispersion->fail(
            "a thin wall does not bend light, so it does not disperse it; add \"absorption\" or "
            "\"thin_walled\": false, or remove dispersion");
    }
    if (!material.inside) return;
    if (!node.find("transmission") && !node.find("diffuse_transmission") && !node.find("subsurface")) {
        const auto absorption = node.find("absorption"), scattering = node.find("scattering");
        (absorption   ? *absorption
         : scattering ? *scattering
                      : node.require("thin_walled"))
            .fail(
                "no light reaches the medium inside; add \"transmission\" or \"diffuse_transmission\", or "
                "make the surface a thin wall");
    }
    if (material.ior == 0.0f) {
        node.require("ior").fail(
            "an ior of 0 reflects all light, so that none reaches the medium inside; give the medium's own "
            "index, or make the surface a thin wall");
    }
}

// An index of refraction in a range, or 0.
float read_index(const Node& node, Range range) {
    const double index = node.number();
    if (index != 0.0 && !(index >= double(range.min) && index <= double(range.max)))
        node.fail_expected("a number from 1 to 1e6, or 0 for a surface that reflects all light");
    return float(index);
}

// The thickness where an image is 1 must be stated: the factor of other values, 1, would be one nanometre.
Textured<float> read_thickness(const Node& node, const ImageFolder& images, Range range) {
    if (node.is_object()) node.require("factor");
    return read_number(node, images, range);
}

template <ValueKind kind>
typename ValueOf<kind>::Type read_value(const Node& node, const ImageFolder& images, Range range) {
    using enum ValueKind;
    if constexpr (kind == color) return read_color(node, images);
    if constexpr (kind == radiance) return read_radiance(node, images);
    if constexpr (kind == weight) return read_number(node, images, range);
    if constexpr (kind == thickness) return read_thickness(node, images, range);
    if constexpr (kind == number) return node.number(range.min, range.max);
    if constexpr (kind == index) return read_index(node, range);
    if constexpr (kind == angle) return float(node.angle());
    if constexpr (kind == flag) return node.boolean();
    if constexpr (kind == vector_map) return read_texture(node, images, TextureEncoding::linear);
    if constexpr (kind == normal_map) return read_normal_map(node, images);
}

// Throws Error for other keys than those of the material, and the given one.
void allow_principled(const Node& node, std::vector<std::string_view> keys) {
    for (const std::string_view key : {
#define VALUE(kind, name, initial, min, max, needs, text) std::string_view(#name),
#define KEY(name, member, text) std::string_view(#name),
#include "scene/principled_values.inc"
#undef VALUE
#undef KEY
         })
        keys.push_back(key);
    for (const std::string_view key : keys_of({"material"}))
        keys.push_back(key);
    node.allow_only({}, keys);
}

// Reads the values that are present.
void read_values(const Node& node, const ImageFolder& images, PrincipledMaterial& m) {
#define VALUE(kind, name, initial, min, max, needs, text) \
    if (const auto found = node.find(#name))              \
        m.name = read_value<ValueKind::kind>(*found, images, PRINCIPLED_RANGES.name);
#define KEY(name, member, text)
#include "scene/principled_values.inc"
#undef VALUE
#undef KEY
    if (const auto min = node.find("iridescence_thickness_min"); min && !m.iridescence_thickness.texture) {
        min->fail(
            "iridescence_thickness_min is the thickness where an image is 0; give "
            "\"iridescence_thickness\" an image, or remove this key");
    }
}

}  // namespace

MaterialModel read_principled(const Node& node, const ImageFolder& images) {
    allow_principled(node, {"type"});
    PrincipledMaterial material;
    if (const auto unlit = node.find("unlit"); unlit && unlit->boolean()) check_unlit(node);
    check_companions(node);
    read_values(node, images, material);
    read_inside(node, true, material);
    check_inside(node, material);
    return material;
}

// Keys need no others: they may come one after the other.
void change_values(const Node& node, const ImageFolder& images, PrincipledMaterial& material) {
    allow_principled(node, {});
    read_values(node, images, material);
    const std::optional<Medium> inside = find_inside(node, material);
    if (inside) material.inside = inside;
    if (const auto thin = node.find("thin_walled")) {
        if (thin->boolean()) {
            if (inside) thin->fail(THIN_WITH_MEDIUM);
            material.inside.reset();
        } else if (!material.inside) {
            material.inside = Medium{};
        }
    }
    if (const auto priority = node.find("priority"))
        material.priority = read_integer(*priority, scene_key("dielectric", "priority"));
    const auto is_black = [](const Textured<float>& weight) {
        return !weight.texture && weight.factor == 0.0f;
    };
    if (material.inside && (material.ior == 0.0f ||
                            (is_black(material.transmission) && is_black(material.diffuse_transmission)))) {
        node.fail(
            "no light would reach the medium inside; make the surface a thin wall (\"thin_walled\": true) in "
            "the same change");
    }
    if (!material.inside && material.dispersion != 0.0f)
        node.fail("a thin wall does not disperse light; set \"dispersion\" to 0 in the same change");
}

MaterialModel read_rough_conductor(const Node& node, const ImageFolder& images) {
    node.allow_only({"type"}, keys_of({"rough_conductor", "material"}));
    check_companions(node);
    PrincipledMaterial material;
    material.metalness = 1.0f;
    read_values(node, images, material);
    material.base_color = read_color(node.require("reflectance"), images);
    material.roughness = read_number(node.require("roughness"), images, PRINCIPLED_RANGES.roughness);
    return material;
}

// Like "dielectric", it encloses a medium unless its keys say otherwise.
MaterialModel read_rough_dielectric(const Node& node, const ImageFolder& images) {
    node.allow_only({"type"}, keys_of({"rough_dielectric", "material"}));
    PrincipledMaterial material;
    material.base_color = vec3(1.0f);
    material.transmission = 1.0f;
    material.ior = read_number(node.require("ior"), scene_key("rough_dielectric", "ior"));
    material.roughness = read_number(node.require("roughness"), images, PRINCIPLED_RANGES.roughness);
    read_inside(node, false, material);
    return material;
}

}  // namespace candela
