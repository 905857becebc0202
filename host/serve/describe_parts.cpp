// See describe_parts.h.
#include "serve/describe_parts.h"

#include <algorithm>
#include <map>
#include <set>
#include <type_traits>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/names.h"
#include "scene/place.h"

namespace candela::serve {
namespace {

Json to_json(const Transform& transform) {
    Json numbers = Json::array();
    for (int i = 0; i < 16; ++i)
        numbers.push_back(transform.matrix()[i % 4][i / 4]);
    return numbers;
}

// What is described of an instance.
struct Instance {
    Transform transform;
    bool visible = true;
    std::set<std::string> materials;
};

// Values of materials, as scene files have them.
class Describer {
  public:
    explicit Describer(const Scene& scene) : scene_(scene) {}

    Json operator()(float number) const { return number; }
    Json operator()(bool flag) const { return flag; }
    Json operator()(vec3 color) const { return {color.x, color.y, color.z}; }
    template <class Value>
    Json operator()(const Textured<Value>& value) const {
        if (!value.texture) return (*this)(value.factor);
        Json json = (*this)(*value.texture);
        json["factor"] = (*this)(value.factor);
        return json;
    }
    Json operator()(const Texture& texture) const {
        return {{"image", scene_.images[texture.image].path.string()}};
    }
    Json operator()(const NormalMap& map) const {
        Json json = (*this)(map.texture);
        json["scale"] = map.scale;
        return json;
    }
    template <class Value>
    Json operator()(const std::optional<Value>& value) const {
        return value ? (*this)(*value) : Json(nullptr);
    }

    Json operator()(const DiffuseMaterial& m) const {
        return {{"type", "diffuse"}, {"reflectance", (*this)(m.reflectance)}};
    }
    Json operator()(const PhongMaterial& m) const {
        return {{"type", "phong"},
                {"diffuse", (*this)(m.diffuse)},
                {"specular", (*this)(m.specular)},
                {"exponent", (*this)(m.exponent)}};
    }
    Json operator()(const MirrorMaterial& m) const {
        return {{"type", "mirror"}, {"reflectance", (*this)(m.reflectance)}};
    }
    Json operator()(const ConductorMaterial& m) const {
        return {{"type", "conductor"}, {"reflectance", (*this)(m.reflectance)}, {"alpha", (*this)(m.alpha)}};
    }
    Json operator()(const DiffuseTransmissionMaterial& m) const {
        return {{"type", "diffuse_transmission"},
                {"reflectance", (*this)(m.reflectance)},
                {"transmittance", (*this)(m.transmittance)}};
    }
    Json operator()(const DielectricMaterial& m) const {
        return {{"type", "dielectric"},
                {"ior", m.ior},
                {"exterior_ior", (*this)(m.exterior_ior)},
                {"fresnel", name_of(m.fresnel, FRESNEL_NAMES)},
                {"priority", m.priority}};
    }
    Json operator()(const InterfaceMaterial& m) const {
        return {{"type", "interface"}, {"priority", m.priority}};
    }
    Json operator()(const PrincipledMaterial& m) const {
        Json json{{"type", "principled"}, {"thin_walled", !m.inside}, {"priority", m.priority}};
#define VALUE(kind, name, initial, min, max, needs, text) json[#name] = value<ValueKind::kind>(m.name);
#define KEY(name, member, text)
#include "scene/principled_values.inc"
#undef VALUE
#undef KEY
        return json;
    }

  private:
    template <ValueKind kind, class Value>
    Json value(const Value& value) const {
        if constexpr (kind == ValueKind::angle) {
            return glm::degrees(value);
        } else {
            return (*this)(value);
        }
    }

    const Scene& scene_;
};

}  // namespace

Json describe_object(const Node& name, const Scene& scene) {
    const auto found = std::ranges::find(scene.objects, name.string());
    if (found == scene.objects.end()) name.fail_unknown("object", name.string(), scene.objects, "defined");
    const auto index = uint32_t(found - scene.objects.begin());
    std::map<uint32_t, Instance> instances;
    for (const Shape& shape : scene.shapes) {
        if (shape.object != index) continue;
        const auto [known, is_new] = instances.try_emplace(shape.copy);
        if (is_new) known->second = {origin_of(shape).transform, shape.visible, {}};
        known->second.materials.insert(scene.materials[shape.material].name);
    }
    Json list = Json::array();
    for (const auto& [number, instance] : instances) {
        list.push_back({{"instance", number},
                        {"transform", to_json(instance.transform)},
                        {"visible", instance.visible},
                        {"materials", instance.materials}});
    }
    return {{"instances", list}};
}

Json describe_material(const Node& name, const Scene& scene) {
    const auto found = std::ranges::find(scene.materials, name.string(), &Material::name);
    if (found == scene.materials.end()) {
        std::vector<std::string> names;
        for (const Material& material : scene.materials)
            names.push_back(material.name);
        name.fail_unknown("material", name.string(), names, "defined");
    }
    const Describer describe(scene);
    Json values = std::visit(describe, found->model);
    values["normal_map"] = describe(found->normal_map);
    values["opacity"] = describe(found->opacity.value);
    values["vertex_colors"] = found->vertex_colors;
    return {{"values", values}};
}

Json describe_labels(const Labels& labels) {
    Json instances = Json::array();
    for (const LabelledInstance& instance : labels.instances)
        instances.push_back({{"object", instance.object}, {"instance", instance.copy}});
    return {{"objects", labels.objects}, {"instances", instances}, {"materials", labels.materials}};
}

}  // namespace candela::serve
