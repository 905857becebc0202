// Materials: one reader for each model, in a table by the name of its type.
#include <array>

#include "base/text.h"
#include "load/json/loader_parts.h"
#include "scene/names.h"

namespace candela {
namespace {

MaterialModel read_diffuse(const Node& node, const ImageFolder& images) {
    node.allow_only({"type"}, keys_of({"diffuse", "material"}));
    return DiffuseMaterial{read_color(node.require("reflectance"), images)};
}

// Decimals that add up to 1, such as 0.7 and 0.3, do so as doubles within 2e-16. An excess above this is
// deliberate, and shows in 15 digits. As floats, the greater is off by at most 2^-25 and the lesser by 2^-26,
// so that they add up to less than 1 + 2^-24, which rounds to 1.
constexpr double SLACK = 1e-14, FLOAT_SLACK = 0x1p-24;

// Throws Error at `place`, the place of b, if a channel would send out more light than it receives; `names`
// names the sum of a and b. Images are treated as white, since it is not known here which of their pixels
// meet on a surface.
void check_sum(const Node& place, std::string_view names, const Textured<dvec3>& a, const Textured<dvec3>& b,
               double slack = SLACK) {
    const bool textured = a.texture || b.texture;
    constexpr std::array<const char*, 3> CHANNELS{"red", "green", "blue"};
    constexpr int DIGITS = 15;
    for (glm::length_t i = 0; i < 3; ++i) {
        const double sum = a.factor[i] + b.factor[i];
        if (sum <= 1.0 + slack) continue;
        place.fail(concat(names, " is ", number_text(sum, DIGITS), " in ", CHANNELS[size_t(i)],
                          textured ? " where an image is white; lower a \"factor\" until the sum is at most 1"
                                   : "; lower one of the two until the sum is at most 1"));
    }
}

MaterialModel read_phong(const Node& node, const ImageFolder& images) {
    node.allow_only({"type"}, keys_of({"phong", "material"}));
    const auto diffuse = node.find("diffuse");
    const Node specular = node.require("specular");
    const Textured<dvec3> kd = diffuse ? read_reflectance(*diffuse, images) : dvec3(0.0);
    const Textured<dvec3> ks = read_reflectance(specular, images);
    check_sum(specular, "diffuse + specular", kd, ks);
    return PhongMaterial{
        as_floats(kd), as_floats(ks),
        read_number(node.require("exponent"), images, scene_key("phong", "exponent").range())};
}

MaterialModel read_mirror(const Node& node, const ImageFolder& images) {
    node.allow_only({"type"}, keys_of({"mirror", "material"}));
    MirrorMaterial material;
    if (const auto reflectance = node.find("reflectance"))
        material.reflectance = read_color(*reflectance, images);
    return material;
}

Textured<float> read_alpha(const Node& alpha, const ImageFolder& images) {
    if (alpha.is_number() && alpha.number() == 0.0) {
        alpha.fail(R"(a "conductor" needs some roughness; without any, use the type "mirror")");
    }
    return read_number(alpha, images, scene_key("conductor", "alpha").range());
}

MaterialModel read_conductor(const Node& node, const ImageFolder& images) {
    node.allow_only({"type"}, keys_of({"conductor", "material"}));
    const Textured<vec3> reflectance = read_color(node.require("reflectance"), images);
    return ConductorMaterial{reflectance, read_alpha(node.require("alpha"), images)};
}

MaterialModel read_diffuse_transmission(const Node& node, const ImageFolder& images) {
    node.allow_only({"type"}, keys_of({"diffuse_transmission", "material"}));
    const Textured<dvec3> reflectance = read_reflectance(node.require("reflectance"), images);
    const Node place = node.require("transmittance");
    const Textured<dvec3> transmittance = read_reflectance(place, images);
    check_sum(place, "reflectance + transmittance", reflectance, transmittance);
    DiffuseTransmissionMaterial material{as_floats(reflectance), as_floats(transmittance), {}};
    if (const auto inside = find_medium(node)) material.inside = inside;
    return material;
}

// Reads the values that are present.
void read_values(const Node& node, DielectricMaterial& material) {
    constexpr double MAX_CONTRAST = 1e6;  // Its square, which scales radiance, fits into floats.
    const auto ior = node.find("ior");
    if (ior) material.ior = float(ior->positive());
    if (const auto exterior = node.find("exterior_ior")) material.exterior_ior = float(exterior->positive());
    const double contrast = double(material.ior) / material.exterior_ior.value_or(1.0f);
    if (contrast > MAX_CONTRAST || contrast < 1.0 / MAX_CONTRAST) {
        (ior ? *ior : node)
            .fail(
                "ior and exterior_ior differ by a factor above a million; give both as those of real media");
    }
    if (const auto fresnel = node.find("fresnel")) material.fresnel = fresnel->choice(FRESNEL_NAMES);
    if (const auto inside = find_medium(node)) material.inside = *inside;
    if (const auto priority = node.find("priority"))
        material.priority = read_integer(*priority, scene_key("dielectric", "priority"));
}

MaterialModel read_dielectric(const Node& node, const ImageFolder&) {
    node.allow_only({"type"}, keys_of({"dielectric", "material"}));
    node.require("ior");
    DielectricMaterial material;
    read_values(node, material);
    return material;
}

// Reads the values that are present.
void change_values(const Node& node, const ImageFolder&, InterfaceMaterial& material) {
    node.allow_only({"type"}, keys_of({"interface"}));
    if (const auto inside = find_medium(node)) material.inside = *inside;
    if (const auto priority = node.find("priority"))
        material.priority = read_integer(*priority, scene_key("interface", "priority"));
}

MaterialModel read_interface(const Node& node, const ImageFolder& images) {
    InterfaceMaterial material;
    change_values(node, images, material);
    return material;
}

// Reads the value of that key, if it is present.
void change_color(const Node& node, std::string_view key, const ImageFolder& images, Textured<vec3>& color) {
    if (const auto value = node.find(key)) color = read_color(*value, images);
}

Textured<dvec3> as_doubles(const Textured<vec3>& color) {
    Textured<dvec3> result(dvec3(color.factor));
    result.texture = color.texture;
    return result;
}

// Each changes the values of a model that are present.
void change_values(const Node& node, const ImageFolder& images, DiffuseMaterial& material) {
    node.allow_only({}, keys_of({"diffuse", "material"}));
    change_color(node, "reflectance", images, material.reflectance);
}

void change_values(const Node& node, const ImageFolder& images, PhongMaterial& material) {
    node.allow_only({}, keys_of({"phong", "material"}));
    change_color(node, "diffuse", images, material.diffuse);
    change_color(node, "specular", images, material.specular);
    check_sum(node, "diffuse + specular", as_doubles(material.diffuse), as_doubles(material.specular),
              FLOAT_SLACK);
    if (const auto exponent = node.find("exponent"))
        material.exponent = read_number(*exponent, images, scene_key("phong", "exponent").range());
}

void change_values(const Node& node, const ImageFolder& images, MirrorMaterial& material) {
    node.allow_only({}, keys_of({"mirror", "material"}));
    change_color(node, "reflectance", images, material.reflectance);
}

void change_values(const Node& node, const ImageFolder& images, ConductorMaterial& material) {
    node.allow_only({}, keys_of({"conductor", "material"}));
    change_color(node, "reflectance", images, material.reflectance);
    if (const auto alpha = node.find("alpha")) material.alpha = read_alpha(*alpha, images);
}

void change_values(const Node& node, const ImageFolder& images, DiffuseTransmissionMaterial& material) {
    node.allow_only({}, keys_of({"diffuse_transmission", "material"}));
    change_color(node, "reflectance", images, material.reflectance);
    change_color(node, "transmittance", images, material.transmittance);
    check_sum(node, "reflectance + transmittance", as_doubles(material.reflectance),
              as_doubles(material.transmittance), FLOAT_SLACK);
    if (const auto inside = find_medium(node)) material.inside = inside;
}

void change_values(const Node& node, const ImageFolder&, DielectricMaterial& material) {
    node.allow_only({}, keys_of({"dielectric", "material"}));
    read_values(node, material);
}

// Reads the values of all models.
void read_surface(const Node& node, const ImageFolder& images, Material& material) {
    const auto normals = node.find("normal_map"), heights = node.find("bump_map");
    if (normals) material.normal_map = read_normal_map(*normals, images);
    if (heights) material.bump_map = read_bump_map(*heights, images);
    if (material.normal_map && material.bump_map) {
        (heights ? *heights : node)
            .fail("a material has a normal_map or a bump_map, not both; bake the heights into the normals");
    }
    if (const auto opacity = node.find("opacity")) material.opacity = read_opacity(*opacity, images);
    if (const auto colors = node.find("vertex_colors")) material.vertex_colors = colors->boolean();
}

}  // namespace

Material read_material(const Node& node, const ImageFolder& images) {
    constexpr std::array<std::pair<std::string_view, MaterialModel (*)(const Node&, const ImageFolder&)>, 10>
        READERS{{{"diffuse", &read_diffuse},
                 {"phong", &read_phong},
                 {"mirror", &read_mirror},
                 {"conductor", &read_conductor},
                 {"dielectric", &read_dielectric},
                 {"diffuse_transmission", &read_diffuse_transmission},
                 {"interface", &read_interface},
                 {"principled", &read_principled},
                 {"rough_conductor", &read_rough_conductor},
                 {"rough_dielectric", &read_rough_dielectric}}};
    Material material{std::string(node.key()), node.require("type").choice(READERS)(node, images)};
    read_surface(node, images, material);
    return material;
}

Material read_changed_material(const Node& node, const ImageFolder& images, const Material& before) {
    Material material = before;
    std::visit([&](auto& model) { change_values(node, images, model); }, material.model);
    read_surface(node, images, material);
    return material;
}

}  // namespace candela
