// The values that every shape may have.
#include "load/json/shape_list.h"

#include <utility>
#include <variant>

#include "load/json/keys.h"
#include "scene/catchers.h"
#include "scene/materials.h"
#include "scene/names.h"
#include "scene/place.h"

namespace candela {

dvec3 within_reach(const Node& node, dvec3 p) {
    if (!is_within_reach(p)) node.fail(TOO_FAR);
    return p;
}

ShapeList::ShapeList(std::filesystem::path folder, Scene& scene)
    : SceneBuilder(scene), folder_(std::move(folder)) {
    for (const Material& material : scene.materials)
        indices_.emplace(material.name, uint32_t(indices_.size()));
}

Appearance ShapeList::appearance_of(const Node& node) {
    const auto material = node.find("material");
    if (!material && !node.find("emission")) {
        node.fail("the shape has neither material nor emission; add one of them");
    }
    Appearance appearance{0, emission_of(node), node.find("emission").has_value()};
    appearance.material = material ? index_of(*material) : black();
    const Material& its_material = scene().materials[appearance.material];
    if (!appearance.states_emission) appearance.emission = material_emission(its_material);
    appearance.beam.spread = spread_of(node);
    if (appearance.states_emission || std::holds_alternative<PrincipledMaterial>(its_material.model))
        return appearance;
    for (const std::string key : {"spread", "cone"}) {
        if (const auto beam = node.find(key))
            beam->fail(key + " says where emission leaves; it needs \"emission\"");
    }
    return appearance;
}

Appearance ShapeList::appearance_of(const Node& node, const Shape& shape) {
    Appearance result{shape.material, shape.emission, shape.states_emission, shape.beam};
    if (node.find("spread")) result.beam.spread = spread_of(node);
    if (const auto material = node.find("material")) {
        result.material = index_of(*material);
        if (!result.states_emission) result.emission = material_emission(scene().materials[result.material]);
    }
    const std::optional<Emission> emission = emission_of(node);
    if (node.find("emission")) {
        result.emission = emission;
        result.states_emission = true;
    }
    return result;
}

std::optional<Emission> ShapeList::emission_of(const Node& node) {
    const auto emission = node.find("emission");
    const auto two_sided = node.find("two_sided");
    const bool both_sides = two_sided && two_sided->boolean();
    if (two_sided && !emission) {
        two_sided->fail("two_sided says where emission leaves; it needs \"emission\"");
    }
    if (!emission) return std::nullopt;
    const Textured<vec3> radiance = read_radiance(*emission, {folder_, scene()});
    if (radiance.factor == vec3(0.0f)) return std::nullopt;
    return Emission{radiance, both_sides};
}

float ShapeList::spread_of(const Node& node) {
    const auto spread = node.find("spread");
    return spread ? glm::radians(read_number(*spread, scene_key("shape", "spread"))) : PI;
}

void ShapeList::read_seen(const Node& node, size_t first) {
    const auto kind = node.find("shadow_catcher");
    const auto visible = node.find("visible_to_camera");
    if (!kind && !visible) return;
    const auto catcher = kind ? std::optional(kind->choice(CATCHER_NAMES)) : std::nullopt;
    const auto hidden = visible ? std::optional(!visible->boolean()) : std::nullopt;
    for (size_t i = first; i < scene().shapes.size(); ++i) {
        const Material material = scene().materials[scene().shapes[i].material];
        if (catcher && catches(*catcher) && (scene().shapes[i].emission || is_unlit(material)))
            kind->fail(std::string("the shape ") + CATCHER_EMITS);
        const auto [known, is_new] = seen_.try_emplace({scene().shapes[i].material, catcher, hidden});
        if (is_new) {
            known->second = add_material(material);
            Material& seen = scene().materials[known->second];
            seen.original = material.original.value_or(scene().shapes[i].material);
            seen.catcher = catcher.value_or(material.catcher);
            seen.hidden = hidden.value_or(material.hidden);
        }
        scene().shapes[i].material = known->second;
    }
}

const Shape& ShapeList::add_placed_by(const Appearance& appearance, const Geometry& own,
                                      const Transform& transform) {
    add(appearance, own);
    Shape& shape = scene().shapes.back();
    place_object(shape, own, transform);
    return shape;
}

Transform ShapeList::transform_of(const Node& node) {
    const auto transform = node.find("transform");
    return transform ? read_transform(*transform) : Transform();
}

uint32_t ShapeList::index_of(const Node& material) {
    const auto found = indices_.find(material.string());
    if (found != indices_.end()) return found->second;
    std::vector<std::string> names;
    for (size_t i = 0; i < indices_.size(); ++i)
        names.push_back(scene().materials[i].name);
    material.fail_unknown("material", material.string(), names, "defined");
}

}  // namespace candela
