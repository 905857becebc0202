// Media: what lies behind a surface, and around everything.
#include "base/limits.h"
#include "load/json/loader_parts.h"
#include "scene/medium.h"

namespace candela {
namespace {

// Throws Error at `place` if the medium is too dense for floats.
void check_range(const Node& place, const Medium& medium) {
    const vec3 extinction = medium.absorption + medium.scattering;
    if (!glm::all(glm::lessThanEqual(extinction, vec3(FLOAT_MAX))))
        place.fail("the medium exceeds the range of 32-bit floats; use a longer distance");
}

// By Beer and Lambert, from the fraction of light that is left after a distance.
void read_absorption(const Node& node, Medium& medium) {
    node.allow_only({}, keys_of({"absorption"}));
    const Node transmittance = node.require("transmittance");
    const dvec3 fraction = transmittance.reflectance();
    if (glm::any(glm::equal(fraction, dvec3(0.0)))) {
        transmittance.fail_expected("numbers above 0 and up to 1");
    }
    const Node distance = node.require("distance");
    medium.absorption = vec3(abs(log(fraction)) / distance.positive());
    check_range(distance, medium);
}

float read_mean_cosine(const Node& node) {
    const auto g = node.find("g");
    return g ? read_number(*g, scene_key("scattering", "g")) : 0.0f;
}

// A medium of that mean free path.
Medium read_medium_of(const Node& length, const dvec3& albedo, float g) {
    const dvec3 mean_free_path = length.rgb();
    if (glm::any(glm::equal(mean_free_path, dvec3(0.0)))) length.fail_expected("numbers above 0");
    const Medium medium = scattering_medium(albedo, mean_free_path, g);
    check_range(length, medium);
    return medium;
}

// By a coefficient; or by the share of light that a particle scatters and how far light comes before one.
void read_scattering(const Node& node, bool absorbs, Medium& medium) {
    node.allow_only({}, keys_of({"scattering"}));
    const auto coefficient = node.find("coefficient"), albedo = node.find("albedo"),
               reflectance = node.find("reflectance"), path = node.find("mean_free_path");
    if (int(coefficient.has_value()) + int(albedo.has_value()) + int(reflectance.has_value()) != 1)
        node.fail(R"(expected one of "coefficient", "albedo" and "reflectance")");
    const float g = read_mean_cosine(node);
    if (coefficient) {
        if (path) path->fail("the coefficient says how far light comes; remove mean_free_path");
        medium.scattering = vec3(coefficient->rgb());
        medium.g = g;
        check_range(*coefficient, medium);
        return;
    }
    if (absorbs) {
        (albedo ? *albedo : *reflectance)
            .fail(R"(this says how much light is absorbed; remove "absorption", or use "coefficient")");
    }
    medium = read_medium_of(
        node.require("mean_free_path"),
        albedo ? albedo->reflectance() : single_scattering_albedo(reflectance->reflectance(), g), g);
}

}  // namespace

std::optional<Medium> find_medium(const Node& node) {
    const auto absorption = node.find("absorption"), scattering = node.find("scattering");
    if (!absorption && !scattering) return std::nullopt;
    Medium medium;
    if (absorption) read_absorption(*absorption, medium);
    if (scattering) read_scattering(*scattering, absorption.has_value(), medium);
    return medium;
}

// Light that enters a solid through a diffuse boundary and is scattered inside; or that a thin wall scatters
// to both sides, forwards as often as a particle does. Ref: OpenPBR 1.1, "Subsurface" and "Thin-walled case".
std::optional<Medium> read_subsurface(const Node& node, bool thin, PrincipledMaterial& material) {
    node.allow_only({}, keys_of({"subsurface"}));
    const auto weight = node.find("weight");
    const dvec3 color = node.require("color").reflectance();
    const float share = weight ? read_number(*weight, scene_key("subsurface", "weight")) : 1.0f,
                g = read_mean_cosine(node);
    const Medium medium = read_medium_of(node.require("radius"), single_scattering_albedo(color, g), g);
    material.diffuse_transmission = share;
    material.diffuse_transmission_color = vec3(1.0f);
    if (!thin) return medium;
    if (material.base_color.texture)
        node.fail("a thin wall needs a base_color without a texture; remove that, or subsurface");
    const float forwards = 0.5f * share * (1.0f + g), backwards = share - forwards;
    const vec3 back = (1.0f - share) * material.base_color.factor + backwards * vec3(color);
    material.base_color.factor = back / (1.0f - forwards);
    material.diffuse_transmission = forwards;
    material.diffuse_transmission_color = vec3(color);
    return std::nullopt;
}

Medium read_medium(const Node& node) {
    node.allow_only({}, keys_of({"medium"}));
    const std::optional<Medium> medium = find_medium(node);
    if (!medium) node.fail(R"(the medium is empty; add "absorption" or "scattering")");
    return *medium;
}

}  // namespace candela
