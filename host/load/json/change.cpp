// See change.h.
#include "load/json/change.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "load/json/change_meshes.h"
#include "load/json/loader_parts.h"
#include "scene/images.h"
#include "scene/material_textures.h"
#include "scene/materials.h"
#include "scene/place.h"
#include "scene/scene_builder.h"

namespace candela {
namespace {

// A material of the change: where it stands, for messages, and the one of the scene whose place it takes.
struct MaterialChange {
    std::string place;
    size_t index;
};

// The material with its images in `change`.
Material with_images(const Material& before, const Scene& scene, Scene& change) {
    Material material = before;
    for_each_texture(material, [&](Texture& texture) {
        change.images.push_back(scene.images[texture.image]);
        texture.image = uint32_t(change.images.size() - 1);
    });
    return material;
}

// Reads materials into `change`, which has read nothing else; also for those that repeat one of them.
std::vector<MaterialChange> read_materials(const Node& materials, const Scene& scene,
                                           const std::filesystem::path& folder, Scene& change) {
    std::vector<std::string> names;
    for (const Material& material : scene.materials)
        names.push_back(material.name);
    std::vector<MaterialChange> changes;
    for (const Node& node : materials.members()) {
        const auto found = std::ranges::find(names, node.key());
        if (found == names.end()) node.fail_unknown("material", node.key(), names, "defined");
        const auto index = size_t(found - names.begin());
        const Material now = node.find("type")
                                 ? read_material(node, {folder, change})
                                 : read_changed_material(node, {folder, change},
                                                         with_images(scene.materials[index], scene, change));
        for (size_t i = index; i < scene.materials.size(); ++i) {
            const Material& before = scene.materials[i];
            if (i != index && before.original != index) continue;
            changes.push_back({node.place(), i});
            Material& made = change.materials.emplace_back(now);
            made.name = before.name;
            made.catcher = before.catcher;
            made.hidden = before.hidden;
            made.original = before.original;
        }
    }
    return changes;
}

// Throws Error if a mesh of the material `before` lacks what the new material needs, or would have been read
// in another way.
void check_mesh(const std::string& place, const Material& before, const Shape& shape, Scene& scene) {
    const Geometry own = origin_of(shape).geometry;  // Also of what is hidden.
    const auto* const instance = std::get_if<MeshInstance>(&own);
    if (instance == nullptr) return;
    const Material& now = scene.materials[shape.material];
    const bool tangents = needs_tangents(before);
    if (tangents != needs_tangents(now) || (tangents && tangent_uv_set(before) != tangent_uv_set(now)) ||
        (before.bump_map && before.bump_map->multiplier)) {
        throw Error(place + ": the meshes of the material \"" + now.name +
                    "\" were read for its normal map, its anisotropy or the lack of them, or for the heights "
                    "of their file; change the scene's file, and load it again");
    }
    SceneBuilder(scene).complete_mesh(place, {shape.material, material_emission(now)}, instance->mesh);
}

// Calls visit(texture) for each texture of the scene.
template <class Visit>
void for_each_texture_of(Scene& scene, const Visit& visit) {
    for (Material& material : scene.materials)
        for_each_texture(material, visit);
    for (Shape& shape : scene.shapes) {
        if (shape.emission && shape.emission->radiance.texture) visit(*shape.emission->radiance.texture);
    }
}

// Removes the images that no texture looks up, so that memory does not grow with each change.
// Returns whether there were any.
bool drop_unused_images(Scene& scene) {
    std::vector<uint32_t> indices(scene.images.size(), 0);
    for_each_texture_of(scene, [&](const Texture& texture) { indices[texture.image] = 1; });
    uint32_t count = 0;
    for (size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] == 0) continue;
        if (count < i) scene.images[count] = std::move(scene.images[i]);
        indices[i] = count++;
    }
    scene.images.erase(scene.images.begin() + count, scene.images.end());
    scene.image_indices.clear();
    for_each_texture_of(scene, [&](Texture& texture) { texture.image = indices[texture.image]; });
    return count < indices.size();
}

// Where in the scene the images of the change will be: those that it has already, and after them the others.
std::vector<uint32_t> places_in(const Scene& scene, const Scene& change) {
    std::map<const TexelImage*, uint32_t> known;
    for (uint32_t i = 0; i < scene.images.size(); ++i)
        known.emplace(scene.images[i].image.get(), i);
    std::vector<uint32_t> places;
    auto next = uint32_t(scene.images.size());
    for (const ImageFile& file : change.images) {
        const auto found = known.find(file.image.get());
        places.push_back(found == known.end() ? next++ : found->second);
    }
    return places;
}

// Exchanges the materials of the change with those of the scene.
void exchange_materials(Scene& scene, Scene& change, const std::vector<MaterialChange>& changes) {
    for (size_t i = 0; i < changes.size(); ++i)
        std::swap(scene.materials[changes[i].index], change.materials[i]);
}

// Gives the scene the materials of the change, which gets those that they replace; throws Error if meshes
// cannot have them. Returns what of the scene is other than before.
SceneChange take_materials(Scene& scene, Scene& change, const std::vector<MaterialChange>& changes) {
    if (changes.empty()) return {};
    const std::vector<uint32_t> places = places_in(scene, change);
    SceneChange result{.materials = true, .images = std::ranges::any_of(places, [&](uint32_t i) {
                                              return i >= scene.images.size();
                                          })};
    for_each_texture_of(change, [&](Texture& texture) { texture.image = places[texture.image]; });
    exchange_materials(scene, change, changes);
    try {
        for (size_t i = 0; i < changes.size(); ++i) {
            for (const Shape& shape : scene.shapes) {
                if (shape.material == changes[i].index)
                    check_mesh(changes[i].place, change.materials[i], shape, scene);
            }
        }
    } catch (...) {
        exchange_materials(scene, change, changes);
        throw;
    }
    const size_t known = scene.images.size();
    for (size_t i = 0; i < places.size(); ++i) {
        if (places[i] >= known) scene.images.push_back(std::move(change.images[i]));
    }
    for (const MaterialChange& made : changes) {
        for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
            Shape& shape = scene.shapes[i];
            if (shape.material != made.index || shape.states_emission) continue;
            const auto before = std::exchange(shape.emission, material_emission(scene.materials[made.index]));
            note_emission(result, i, before, shape.emission);
        }
    }
    result.images |= drop_unused_images(scene);
    return result;
}

// Replaces cameras of the same names; others join the scene's.
void take_cameras(Scene& scene, Scene& change) {
    for (Camera& camera : change.cameras) {
        const auto same = [&](const Camera& known) { return known.name == camera.name; };
        const auto found = std::ranges::find_if(scene.cameras, same);
        (found == scene.cameras.end() ? scene.cameras.emplace_back() : *found) = std::move(camera);
    }
}

}  // namespace

SceneChange change_scene(Scene& scene, std::string_view text, const std::string& name,
                         const std::filesystem::path& folder, SceneEdits& edits, const NamedArrays* arrays) {
    const json::Document document{name, json::parse(text, name)};
    const Node root(document);
    root.allow_only({"cameras", "materials", "objects", "meshes", "lights", "environment", "sky"});
    const auto cameras = root.find("cameras"), materials = root.find("materials");
    const auto meshes = root.find("meshes"), lights = root.find("lights");

    // All is read into a scene of its own before this one changes; images are read anew.
    Scene change;
    change.reach = scene.reach;
    change.arrays = arrays;
    std::vector<MaterialChange> changes;
    if (materials) changes = read_materials(*materials, scene, folder, change);
    if (cameras) {
        for (const Node& camera : cameras->members())
            change.cameras.push_back(read_camera(camera, scene.film));
    }
    if (lights) change.lights = read_lights(*lights, change);
    change.environment = read_distant_light(root, folder, change);
    std::vector<ChangedMesh> shown;
    if (meshes) shown = read_mesh_changes(*meshes, scene, change);
    DecodedImages decoded;
    load_images(change, {}, no_progress, decoded);
    InstanceEdits moves;
    if (const auto objects = root.find("objects")) moves = read_object_changes(*objects, scene);

    std::vector<MovedShape> moved = move_shapes(moves, name, scene);
    SceneChange result = take_materials(scene, change, changes);
    take_shapes(std::move(moved), scene, result);
    take_meshes(std::move(shown), scene, result);
    add(edits.objects, moves);
    if (meshes) {
        for (const Node& mesh : meshes->members())
            edits.meshes.emplace(mesh.key());
    }
    if (lights) {
        scene.lights = std::move(change.lights);
        result.lights = edits.lights = true;
    }
    for (const MaterialChange& made : changes)
        edits.materials.insert(scene.materials[made.index].name);
    for (const Camera& camera : change.cameras)
        edits.cameras.insert(camera.name);
    take_cameras(scene, change);
    if (change.environment) {
        note_environment(result, scene.environment, change.environment);
        scene.environment = std::move(change.environment);
        edits.environment = true;
    }
    std::ranges::move(change.files, std::back_inserter(scene.files));
    std::ranges::move(change.warnings, std::back_inserter(scene.warnings));
    return result;
}

void carry_edits(const SceneEdits& edits, const Scene& from, const std::string& name, Scene& to) {
    Scene change;
    std::vector<MaterialChange> changes;
    for (const Material& material : from.materials) {
        if (!edits.materials.contains(material.name)) continue;
        const auto place = std::ranges::find(to.materials, material.name, &Material::name);
        if (place == to.materials.end()) continue;
        changes.push_back({name, size_t(place - to.materials.begin())});
        change.materials.push_back(material);
    }
    if (!changes.empty()) change.images = from.images;
    take_materials(to, change, changes);
    for (const Camera& camera : from.cameras) {
        if (edits.cameras.contains(camera.name)) change.cameras.push_back(camera);
    }
    take_cameras(to, change);
    if (edits.environment) to.environment = from.environment;
    if (edits.lights) to.lights = from.lights;
    for (const std::string& object : edits.meshes)
        carry_mesh(object, from, to);
    SceneChange moved;
    take_shapes(move_shapes(edits.objects, name, to), to, moved);
}

}  // namespace candela
