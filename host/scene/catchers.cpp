// See catchers.h.
#include "scene/catchers.h"

#include <algorithm>

#include "base/error.h"
#include "base/printable.h"
#include "scene/geometry.h"
#include "scene/materials.h"
#include "scene/scene_builder.h"

namespace candela {
namespace {

// Grey; as a catcher of reflections, polished.
Material ground_material(Catcher catcher) {
    constexpr float POLISHED = 0.15f;
    Material material{.name = "ground", .model = DiffuseMaterial{}};
    if (catcher == Catcher::reflections) {
        PrincipledMaterial polished;
        polished.base_color.factor = vec3(0.5f);
        polished.roughness.factor = POLISHED;
        polished.double_sided = true;
        material.model = polished;
    }
    return material;
}

void set_ground(Scene& scene, Catcher catcher) {
    if (!scene.ground) add_ground(scene, ground_material(catcher));
    if (scene.ground) scene.materials[scene.shapes[*scene.ground].material].catcher = catcher;
}

void set_material(Scene& scene, const char* option, const std::string& name, Catcher catcher) {
    const auto material = std::ranges::find(scene.materials, name, &Material::name);
    if (material == scene.materials.end()) {
        std::vector<std::string> names;
        for (const Material& known : scene.materials)
            names.push_back(known.name);
        throw Error(std::string(option) + ": unknown material \"" + printable(name, MAX_NAME_BYTES) +
                        "\" (defined: " + (names.empty() ? "none" : joined(names)) + ')',
                    ErrorKind::request);
    }
    material->catcher = catcher;
}

}  // namespace

bool catches(Catcher catcher) {
    return catcher == Catcher::shadows || catcher == Catcher::reflections;
}

void add_ground(Scene& scene, Material material) {
    const DoubleBox box = bounds(scene);
    if (box.is_empty()) return;
    constexpr double REACH = 30.0, GAP = 1e-4;  // Of the radius of the sphere around the scene.
    const double radius = std::max(0.5 * length(box.extent()), 1e-6);
    const dvec3 middle = box.centroid();
    const Disk disk{.center = {middle.x, box.lo.y - GAP * radius, middle.z},
                    .e1 = {REACH * radius, 0, 0},
                    .e2 = {0, 0, -REACH * radius}};
    const auto index = uint32_t(scene.materials.size());
    scene.materials.push_back(std::move(material));
    SceneBuilder builder(scene);
    builder.begin_object(scene.materials.back().name);
    scene.ground = uint32_t(scene.shapes.size());
    builder.add({.material = index, .emission = {}}, disk);
}

void make_catchers(Scene& scene, const std::string& name, const CatcherOptions& options) {
    for (const std::string& material : options.shadows)
        set_material(scene, "--shadow-catcher", material, Catcher::shadows);
    for (const std::string& material : options.reflections)
        set_material(scene, "--reflection-catcher", material, Catcher::reflections);
    for (const std::string& material : options.holdouts)
        set_material(scene, "--holdout", material, Catcher::holdout);
    if (options.ground) set_ground(scene, *options.ground);
    for (const Shape& shape : scene.shapes) {
        const Material& material = scene.materials[shape.material];
        if (!catches(material.catcher) || (!shape.emission && !is_unlit(material))) continue;
        throw Error(name + ": a surface of the material \"" + printable(material.name, MAX_NAME_BYTES) +
                    "\" " + CATCHER_EMITS);
    }
}

bool has_catchers(const Scene& scene) {
    return std::ranges::any_of(scene.shapes, [&](const Shape& shape) {
        return scene.materials[shape.material].catcher != Catcher::none;
    });
}

}  // namespace candela
