// Materials in layers: the keys of "principled", and metal and glass under names of their own.
#include <algorithm>

#include "base/text.h"
#include "load/json/loader_parts.h"

namespace candela {
namespace {

constexpr float MAX_IOR = 1e6f;        // Its square fits into floats.
constexpr float MAX_DISPERSION = 40;   // Of which the index for red is 1, whatever the material's is.
constexpr float MAX_THICKNESS = 1e6f;  // Of a film [nm]; those that show colours are thinner than 2000.

// Each reads a key into a value, which keeps its default if the key is absent.
void set_weight(const Node& node, std::string_view key, const ImageFolder& images, Textured<float>& value) {
    if (const auto found = node.find(key)) value = read_number(*found, images, 0.0f, 1.0f);
}

void set_color(const Node& node, std::string_view key, const ImageFolder& images, Textured<vec3>& value) {
    if (const auto found = node.find(key)) value = read_color(*found, images);
}

void set_number(const Node& node, std::string_view key, float lo, float hi, float& value) {
    if (const auto found = node.find(key)) value = found->number(lo, hi);
}

void set_boolean(const Node& node, std::string_view key, bool& value) {
    if (const auto found = node.find(key)) value = found->boolean();
}

// Throws Error for a key that has no effect without another, which is absent.
void check_companions(const Node& node) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 13> COMPANIONS{
        {{"anisotropy_rotation", "anisotropy"},
         {"anisotropy_map", "anisotropy"},
         {"diffuse_transmission_color", "diffuse_transmission"},
         {"coat_roughness", "coat"},
         {"coat_ior", "coat"},
         {"coat_darkening", "coat"},
         {"coat_normal_map", "coat"},
         {"sheen_roughness", "sheen_color"},
         {"fuzz_color", "fuzz"},
         {"fuzz_roughness", "fuzz"},
         {"iridescence_ior", "iridescence"},
         {"iridescence_thickness", "iridescence"},
         {"iridescence_thickness_min", "iridescence"}}};
    for (const auto& [key, companion] : COMPANIONS) {
        const auto found = node.find(key);
        if (!found || node.find(companion)) continue;
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
        if (is_in(USED, member.key()) || is_in(MATERIAL_KEYS, member.key())) continue;
        member.fail(concat(member.key(), " has no effect on an unlit material, which shows its base_color; ",
                           "remove it, or \"unlit\""));
    }
}

// Reads what is behind the surface; without "absorption" and "thin_walled", the same as in front of it if it
// is `thin`.
void read_inside(const Node& node, bool thin, PrincipledMaterial& material) {
    const auto absorption = node.find("absorption");
    const auto thin_walled = node.find("thin_walled");
    if (absorption) thin = false;
    if (thin_walled) thin = thin_walled->boolean();
    if (absorption && thin) {
        thin_walled->fail(
            "a thin wall has no inside that could absorb light; remove thin_walled, or absorption");
    }
    if (!thin) material.inside = absorption ? read_absorption(*absorption) : Medium{};
    if (const auto priority = node.find("priority")) {
        material.priority = priority->integer(0, MAX_PRIORITY);
        if (thin) {
            priority->fail(
                "priority ranks the medium inside, and a thin wall has none; add \"absorption\" or "
                "\"thin_walled\": false, or remove priority");
        }
    }
}

// Throws Error for what does not go with the medium inside, or with its absence.
void check_inside(const Node& node, const PrincipledMaterial& material) {
    if (const auto dispersion = node.find("dispersion"); dispersion && !material.inside) {
        dispersion->fail(
            "a thin wall bends no light, and so disperses none; add \"absorption\" or "
            "\"thin_walled\": false, or remove dispersion");
    }
    if (!material.inside) return;
    if (!node.find("transmission") && !node.find("diffuse_transmission")) {
        const auto absorption = node.find("absorption");
        (absorption ? *absorption : node.require("thin_walled"))
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

float read_ior(const Node& node) {
    const double ior = node.number();
    if (ior != 0.0 && !(ior >= 1.0 && ior <= double(MAX_IOR))) {
        node.fail_expected("a number from 1 to 1e6, or 0 for a surface that reflects all light");
    }
    return float(ior);
}

// The thickness where an image is 1 must be stated: the factor of other values, 1, would be one nanometre.
Textured<float> read_thickness(const Node& node, const ImageFolder& images) {
    if (node.is_object()) node.require("factor");
    return read_number(node, images, 0.0f, MAX_THICKNESS);
}

void read_base(const Node& node, const ImageFolder& images, PrincipledMaterial& m) {
    set_color(node, "base_color", images, m.base_color);
    set_weight(node, "metalness", images, m.metalness);
    set_weight(node, "roughness", images, m.roughness);
    set_weight(node, "diffuse_roughness", images, m.diffuse_roughness);
    if (const auto ior = node.find("ior")) m.ior = read_ior(*ior);
    set_weight(node, "specular", images, m.specular);
    set_color(node, "specular_color", images, m.specular_color);
    set_weight(node, "anisotropy", images, m.anisotropy);
    if (const auto angle = node.find("anisotropy_rotation")) m.anisotropy_rotation = float(angle->angle());
    if (const auto map = node.find("anisotropy_map"))
        m.anisotropy_map = read_texture(*map, images, TextureEncoding::linear);
}

void read_transmission(const Node& node, const ImageFolder& images, PrincipledMaterial& m) {
    set_weight(node, "transmission", images, m.transmission);
    set_number(node, "dispersion", 0.0f, MAX_DISPERSION, m.dispersion);
    set_weight(node, "diffuse_transmission", images, m.diffuse_transmission);
    set_color(node, "diffuse_transmission_color", images, m.diffuse_transmission_color);
    read_inside(node, true, m);
    check_inside(node, m);
}

void read_layers(const Node& node, const ImageFolder& images, PrincipledMaterial& m) {
    set_weight(node, "coat", images, m.coat);
    set_weight(node, "coat_roughness", images, m.coat_roughness);
    set_number(node, "coat_ior", 1.0f, MAX_IOR, m.coat_ior);
    set_number(node, "coat_darkening", 0.0f, 1.0f, m.coat_darkening);
    if (const auto map = node.find("coat_normal_map")) m.coat_normal_map = read_normal_map(*map, images);
    set_color(node, "sheen_color", images, m.sheen_color);
    set_weight(node, "sheen_roughness", images, m.sheen_roughness);
    set_weight(node, "fuzz", images, m.fuzz);
    set_color(node, "fuzz_color", images, m.fuzz_color);
    set_weight(node, "fuzz_roughness", images, m.fuzz_roughness);
    set_weight(node, "iridescence", images, m.iridescence);
    set_number(node, "iridescence_ior", 1.0f, MAX_IOR, m.iridescence_ior);
    set_number(node, "iridescence_thickness_min", 0.0f, MAX_THICKNESS, m.iridescence_thickness_min);
    const auto thickness = node.find("iridescence_thickness");
    if (thickness) m.iridescence_thickness = read_thickness(*thickness, images);
    if (const auto least = node.find("iridescence_thickness_min");
        least && !m.iridescence_thickness.texture) {
        least->fail(
            "iridescence_thickness_min is the thickness where an image is 0; give "
            "\"iridescence_thickness\" an image, or remove this key");
    }
}

}  // namespace

MaterialModel read_principled(const Node& node, const ImageFolder& images) {
    node.allow_only({"type",
                     "base_color",
                     "metalness",
                     "roughness",
                     "diffuse_roughness",
                     "ior",
                     "specular",
                     "specular_color",
                     "anisotropy",
                     "anisotropy_rotation",
                     "anisotropy_map",
                     "transmission",
                     "thin_walled",
                     "absorption",
                     "priority",
                     "dispersion",
                     "diffuse_transmission",
                     "diffuse_transmission_color",
                     "coat",
                     "coat_roughness",
                     "coat_ior",
                     "coat_darkening",
                     "coat_normal_map",
                     "sheen_color",
                     "sheen_roughness",
                     "fuzz",
                     "fuzz_color",
                     "fuzz_roughness",
                     "iridescence",
                     "iridescence_ior",
                     "iridescence_thickness",
                     "iridescence_thickness_min",
                     "emission",
                     "unlit",
                     "double_sided"},
                    MATERIAL_KEYS);
    PrincipledMaterial material;
    set_boolean(node, "unlit", material.unlit);
    set_boolean(node, "double_sided", material.double_sided);
    if (material.unlit) check_unlit(node);
    check_companions(node);
    read_base(node, images, material);
    read_transmission(node, images, material);
    read_layers(node, images, material);
    if (const auto emission = node.find("emission")) material.emission = read_radiance(*emission, images);
    return material;
}

MaterialModel read_rough_conductor(const Node& node, const ImageFolder& images) {
    node.allow_only({"type", "reflectance", "roughness", "anisotropy", "anisotropy_rotation"}, MATERIAL_KEYS);
    check_companions(node);
    PrincipledMaterial material;
    material.metalness = 1.0f;
    read_base(node, images, material);
    material.base_color = read_color(node.require("reflectance"), images);
    material.roughness = read_number(node.require("roughness"), images, 0.0f, 1.0f);
    return material;
}

// Like the type "dielectric", it encloses a medium unless it says otherwise.
MaterialModel read_rough_dielectric(const Node& node, const ImageFolder& images) {
    node.allow_only({"type", "ior", "roughness", "absorption", "thin_walled", "priority"}, MATERIAL_KEYS);
    PrincipledMaterial material;
    material.base_color = vec3(1.0f);
    material.transmission = 1.0f;
    material.ior = node.require("ior").number(1.0f, MAX_IOR);
    material.roughness = read_number(node.require("roughness"), images, 0.0f, 1.0f);
    read_inside(node, false, material);
    return material;
}

}  // namespace candela
