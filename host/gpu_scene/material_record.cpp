// One overload per model.
#include "gpu_scene/material_record.h"

#include "gpu_scene/principled_record.h"

namespace candela {
namespace {

const Textured<vec3> NO_COLOR = vec3(0.0f);
const Textured<float> NO_NUMBER = 0.0f;

EncodedMaterial encoded(uint model, const Textured<vec3>& base, const Textured<vec3>& specular = NO_COLOR,
                        const Textured<float>& parameter = NO_NUMBER) {
    return {{.model = model,
             .medium = MEDIUM_SAME,
             .base = base.factor,
             .specular = specular.factor,
             .parameter = parameter.factor},
            base.texture,
            specular.texture,
            parameter.texture,
            {}};
}

EncodedMaterial encode(const DiffuseMaterial& m) {
    return encoded(MATERIAL_DIFFUSE, m.reflectance);
}

EncodedMaterial encode(const PhongMaterial& m) {
    return encoded(MATERIAL_PHONG, m.diffuse, m.specular, m.exponent);
}

EncodedMaterial encode(const MirrorMaterial& m) {
    return encoded(MATERIAL_MIRROR, m.reflectance);
}

EncodedMaterial encode(const ConductorMaterial& m) {
    return encoded(MATERIAL_CONDUCTOR, m.reflectance, NO_COLOR, m.alpha);
}

EncodedMaterial encode(const DielectricMaterial& m) {
    const bool exact = m.fresnel == Fresnel::exact;
    const Textured<vec3> own_eta = vec3(m.exterior_ior ? 1.0f : 0.0f, 0.0f, 0.0f);
    return encoded(exact ? MATERIAL_DIELECTRIC_EXACT : MATERIAL_DIELECTRIC_SCHLICK, NO_COLOR, own_eta,
                   m.ior / m.exterior_ior.value_or(1.0f));
}

// Glass of the same index as what is around.
EncodedMaterial encode(const InterfaceMaterial&) {
    const Textured<vec3> own_eta = vec3(1.0f, 0.0f, 0.0f);
    return encoded(MATERIAL_DIELECTRIC_EXACT, NO_COLOR, own_eta, 1.0f);
}

EncodedMaterial encode(const DiffuseTransmissionMaterial& m) {
    return encoded(MATERIAL_DIFFUSE_TRANSMISSION, m.reflectance, m.transmittance);
}

bool lets_light_in(const PrincipledMaterial& m) {
    return m.transmission.factor > 0.0f || m.diffuse_transmission.factor > 0.0f;
}

EncodedMaterial encode(const PrincipledMaterial& m) {
    if (m.unlit) return encoded(MATERIAL_UNLIT, m.base_color);
    EncodedMaterial result = encoded(MATERIAL_PRINCIPLED, m.base_color.factor, NO_COLOR, principled_ior(m));
    result.record.specular.y = lets_light_in(m) ? 1.0f : 0.0f;
    result.principled = encode_principled(m);
    return result;
}

template <class OpaqueMaterial>
std::optional<Interior> behind(const OpaqueMaterial&) {
    return std::nullopt;
}

std::optional<Interior> behind(const DielectricMaterial& m) {
    return Interior{m.inside, m.ior, m.priority};
}

std::optional<Interior> behind(const InterfaceMaterial& m) {
    return Interior{m.inside, 1.0f, m.priority};
}

std::optional<Interior> behind(const DiffuseTransmissionMaterial& m) {
    if (!m.inside) return std::nullopt;
    return Interior{*m.inside};
}

std::optional<Interior> behind(const PrincipledMaterial& m) {
    if (!m.inside || m.unlit || !lets_light_in(m)) return std::nullopt;
    return Interior{*m.inside, principled_ior(m), m.priority};
}

}  // namespace

EncodedMaterial encode_material(const decltype(Material::model)& model, uint32_t medium) {
    EncodedMaterial result = std::visit([](const auto& m) { return encode(m); }, model);
    if (interior(model)) result.record.medium = medium;
    return result;
}

std::optional<Interior> interior(const decltype(Material::model)& model) {
    return std::visit([](const auto& m) { return behind(m); }, model);
}

}  // namespace candela
