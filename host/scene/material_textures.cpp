// One overload per model.
#include "scene/material_textures.h"

namespace candela {
namespace {

class Collector {
  public:
    void operator()(const DiffuseMaterial& m) { add(m.reflectance); }
    void operator()(const PhongMaterial& m) { add(m.diffuse), add(m.specular), add(m.exponent); }
    void operator()(const MirrorMaterial& m) { add(m.reflectance); }
    void operator()(const ConductorMaterial& m) { add(m.reflectance), add(m.alpha); }
    void operator()(const DielectricMaterial&) {}
    void operator()(const DiffuseTransmissionMaterial& m) { add(m.reflectance), add(m.transmittance); }

    template <class Value>
    void add(const Textured<Value>& value) {
        if (value.texture) textures.push_back(&*value.texture);
    }

    std::vector<const Texture*> textures;
};

}  // namespace

std::vector<const Texture*> textures_of(const Material& material) {
    Collector collector;
    std::visit(collector, material.model);
    collector.add(material.opacity.value);
    if (material.normal_map) collector.textures.push_back(&material.normal_map->texture);
    return collector.textures;
}

uint32_t uv_sets_of(const std::vector<const Texture*>& textures) {
    uint32_t sets = 0;
    for (const Texture* texture : textures)
        sets |= 1u << texture->uv_set;
    return sets;
}

}  // namespace candela
