// See materials.h.
#include "scene/materials.h"

namespace candela {
namespace {

bool is_anisotropic(const PrincipledMaterial& m) {
    return m.anisotropy.factor != 0.0f;
}

}  // namespace

std::optional<Emission> material_emission(const Material& material) {
    const auto* m = std::get_if<PrincipledMaterial>(&material.model);
    if (m == nullptr || m->emission.factor == vec3(0.0f)) return std::nullopt;
    return Emission{m->emission, m->double_sided};
}

bool is_unlit(const Material& material) {
    const auto* m = std::get_if<PrincipledMaterial>(&material.model);
    return m != nullptr && m->unlit;
}

bool is_culled(const Material& material) {
    const auto* m = std::get_if<PrincipledMaterial>(&material.model);
    return m != nullptr && !m->double_sided && !m->inside;
}

bool needs_tangents(const Material& material) {
    const auto* m = std::get_if<PrincipledMaterial>(&material.model);
    return material.normal_map || (m != nullptr && (is_anisotropic(*m) || m->coat_normal_map));
}

uint32_t tangent_uv_set(const Material& material) {
    if (material.normal_map) return material.normal_map->texture.uv_set;
    const auto* m = std::get_if<PrincipledMaterial>(&material.model);
    if (m == nullptr) return 0;
    if (m->coat_normal_map) return m->coat_normal_map->texture.uv_set;
    if (m->anisotropy_map) return m->anisotropy_map->uv_set;
    return m->anisotropy.texture ? m->anisotropy.texture->uv_set : 0;
}

}  // namespace candela
