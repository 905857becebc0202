// One overload per model.
#include "gpu_scene/material_record.h"

namespace candela {
namespace {

MaterialRecord record(uint model, vec3 base, vec3 specular = vec3(0.0f), float parameter = 0.0f) {
    return {
        .model = model, .medium = MEDIUM_SAME, .base = base, .specular = specular, .parameter = parameter};
}

MaterialRecord encode(const DiffuseMaterial& m) {
    return record(MATERIAL_DIFFUSE, m.reflectance);
}

MaterialRecord encode(const PhongMaterial& m) {
    return record(MATERIAL_PHONG, m.diffuse, m.specular, m.exponent);
}

MaterialRecord encode(const MirrorMaterial& m) {
    return record(MATERIAL_MIRROR, m.reflectance);
}

MaterialRecord encode(const ConductorMaterial& m) {
    return record(MATERIAL_CONDUCTOR, m.reflectance, vec3(0.0f), m.alpha);
}

MaterialRecord encode(const DielectricMaterial& m) {
    const bool exact = m.fresnel == Fresnel::exact;
    return record(exact ? MATERIAL_DIELECTRIC_EXACT : MATERIAL_DIELECTRIC_SCHLICK, vec3(0.0f), vec3(0.0f),
                  m.ior / m.exterior_ior);
}

MaterialRecord encode(const DiffuseTransmissionMaterial& m) {
    return record(MATERIAL_DIFFUSE_TRANSMISSION, m.reflectance, m.transmittance);
}

template <class OpaqueMaterial>
std::optional<Medium> behind(const OpaqueMaterial&) {
    return std::nullopt;
}

std::optional<Medium> behind(const DielectricMaterial& m) {
    return m.inside;
}

std::optional<Medium> behind(const DiffuseTransmissionMaterial& m) {
    return m.inside;
}

}  // namespace

MaterialRecord material_record(const decltype(Material::model)& model, uint32_t medium) {
    MaterialRecord result = std::visit([](const auto& m) { return encode(m); }, model);
    if (medium_behind(model)) result.medium = medium;
    return result;
}

std::optional<Medium> medium_behind(const decltype(Material::model)& model) {
    return std::visit([](const auto& m) { return behind(m); }, model);
}

}  // namespace candela
