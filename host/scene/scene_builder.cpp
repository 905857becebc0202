// The last steps of every mesh, and materials by name.
#include "scene/scene_builder.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "scene/material_textures.h"
#include "scene/materials.h"
#include "scene/mesh.h"
#include "scene/tangents.h"

namespace candela {

bool is_within_reach(dvec3 p) {
    return glm::all(glm::lessThanEqual(abs(p), dvec3(double(MAX_COORDINATE))));
}

namespace {

// Whether a shape lies within reach, one function for each geometry.
bool fits(const Quad& quad) {
    return std::ranges::all_of(quad.corners, is_within_reach);
}

bool fits(const Sphere& sphere) {
    return is_within_reach(abs(sphere.center) + sphere.radius);
}

bool fits(const Disk& disk) {
    return is_within_reach(abs(disk.center) + abs(disk.e1) + abs(disk.e2));
}

// A mesh with that origin, in that box.
bool fits(dvec3 origin, const Box& box, const Transform& transform) {
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(corner & 1u ? box.hi.x : box.lo.x, corner & 2u ? box.hi.y : box.lo.y,
                           corner & 4u ? box.hi.z : box.lo.z);
        if (!is_within_reach(transform.point(origin + p))) return false;
    }
    return true;
}

// Throws Error if a mesh lacks the attributes that its material and emission look up; adds the tangents that
// its material needs.
void complete_attributes(const Scene& scene, const std::string& place, const Appearance& appearance,
                         TriangleMesh& mesh) {
    const Material& material = scene.materials[appearance.material];
    uint32_t sets = 0;
    const auto note = [&](const Texture& texture) { sets |= 1u << texture.uv_set; };
    for_each_texture(material, note);
    if (appearance.emission && appearance.emission->radiance.texture)
        note(*appearance.emission->radiance.texture);
    for (const auto& [set, uvs] : {std::pair(0, &mesh.uv0), std::pair(1, &mesh.uv1)}) {
        if ((sets >> set & 1u) == 0) continue;
        const char* name = set == 0 ? "texture coordinates" : "second set of texture coordinates";
        if (uvs->empty()) {
            throw Error(concat(place, ": the material \"", material.name,
                               "\" has textures, but the mesh has no ", name,
                               "; export it with them, or use a material without textures"));
        }
    }
    if (!mesh.tangents.empty()) return;
    if (needs_tangents(material)) {
        const uint32_t set = tangent_uv_set(material);
        if ((set == 0 ? mesh.uv0 : mesh.uv1).empty()) {
            throw Error(
                concat(place, ": the material \"", material.name,
                       "\" is anisotropic, but the mesh has no texture coordinates to say along which "
                       "direction; export it with them, or use a material without anisotropy"));
        }
        add_tangents(mesh, set);
    }
    // Its image, which has not been read yet, may hold normals.
    if (material.bump_map && material.bump_map->multiplier)
        add_tangents(mesh, material.bump_map->texture.uv_set);
}

}  // namespace

bool reaches_no_farther(const TriangleMesh& mesh, const Transform& transform) {
    return fits(mesh.origin, local_bounds(mesh), transform);
}

void finish_mesh(const Scene& scene, const std::string& place, const Appearance& appearance,
                 TriangleMesh& mesh) {
    complete_normals(mesh);
    complete_attributes(scene, place, appearance, mesh);
}

Material default_material(bool has_colors) {
    if (!has_colors) return {.name = {}, .model = DiffuseMaterial{}};
    return {.name = {}, .model = DiffuseMaterial{vec3(1.0f)}, .vertex_colors = true};
}

void SceneBuilder::begin_object(const std::string& name) {
    begin_objects({name});
}

void SceneBuilder::begin_objects(const std::vector<std::string>& names) {
    std::vector<std::string>& objects = scene_.objects;
    for (; named_objects_ < objects.size(); ++named_objects_)
        object_names_.note(objects[named_objects_]);
    object_ = uint32_t(objects.size());
    copy_ = 0;
    for (const std::string& name : names)
        objects.push_back(object_names_.choose(name));
    named_objects_ = objects.size();
}

void SceneBuilder::push(Shape shape) {
    shape.object = object_;
    shape.copy = copy_;
    scene_.shapes.push_back(shape);
}

void SceneBuilder::add_mesh(const std::string& place, const Transform& transform,
                            std::vector<MeshPart> parts) {
    size_t dropped = 0;
    for (MeshPart& part : parts) {
        dropped += drop_flat_triangles(part.mesh);
    }
    std::erase_if(parts, [](const MeshPart& part) { return part.mesh.triangles.empty(); });
    if (parts.empty()) throw Error(place + ": the mesh has no triangle with an area; check its positions");
    if (dropped > 0) {
        warn(place, "left out " + std::to_string(dropped) + (dropped == 1 ? " triangle" : " triangles") +
                        " without area");
    }
    for (MeshPart& part : parts) {
        if (!reaches_no_farther(part.mesh, transform)) throw Error(place + ": " + TOO_FAR);
        finish_mesh(scene_, place, part.appearance, part.mesh);
        part.appearance.material = material_at_scale(part.appearance.material, transform.mean_scale());
        add(part.appearance, MeshInstance{uint32_t(scene_.meshes.size()), transform});
        scene_.meshes.push_back(std::move(part.mesh));
    }
}

void SceneBuilder::add_mesh(const std::string& place, const Appearance& appearance,
                            const Transform& transform, TriangleMesh mesh) {
    std::vector<MeshPart> parts;  // Not from an initializer list, which would copy the mesh.
    parts.push_back({appearance, std::move(mesh)});
    add_mesh(place, transform, std::move(parts));
}

void SceneBuilder::add_instance(const std::string& place, size_t shape, const Transform& transform) {
    Shape copy = scene_.shapes[shape];
    auto& instance = std::get<MeshInstance>(copy.geometry);
    instance.transform = transform;
    if (!instance_fits(instance)) throw Error(place + ": " + TOO_FAR);
    push(copy);
}

void SceneBuilder::complete_mesh(const std::string& place, const Appearance& appearance, uint32_t mesh) {
    complete_attributes(scene_, place, appearance, scene_.meshes[mesh]);
}

bool SceneBuilder::add_placed(Shape shape) {
    const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
    const auto geometry_fits = [&](const auto& geometry) {
        using Type = std::remove_cvref_t<decltype(geometry)>;
        if constexpr (std::is_same_v<Type, MeshInstance>) {
            return instance_fits(geometry);
        } else {
            return fits(geometry);
        }
    };
    if (!std::visit(geometry_fits, shape.geometry)) return false;
    if (instance != nullptr)
        shape.material = material_at_scale(shape.material, instance->transform.mean_scale());
    push(shape);
    return true;
}

bool SceneBuilder::instance_fits(const MeshInstance& instance) {
    mesh_boxes_.resize(scene_.meshes.size());
    const TriangleMesh& mesh = scene_.meshes[instance.mesh];
    std::optional<Box>& box = mesh_boxes_[instance.mesh];
    if (!box) box = local_bounds(mesh);
    return fits(mesh.origin, *box, instance.transform);
}

const Appearance* SceneBuilder::find_file_appearance(const std::string& name) const {
    const auto found = file_appearances_.find(name);
    return found == file_appearances_.end() ? nullptr : &found->second;
}

void SceneBuilder::add_file_appearance(const std::string& name, Material material,
                                       const std::optional<Emission>& emission) {
    material.name = name;
    file_appearances_[name] = {add_material(std::move(material)), emission, emission.has_value()};
}

uint32_t SceneBuilder::add_material(Material material) {
    std::vector<Material>& materials = scene_.materials;
    for (; named_ < materials.size(); ++named_)
        material_names_.note(materials[named_].name);
    material.name = material_names_.choose(material.name);
    materials.push_back(std::move(material));
    return uint32_t(materials.size() - 1);
}

uint32_t SceneBuilder::material_at_scale(uint32_t material, double scale) {
    const std::optional<BumpMap>& bump = scene_.materials[material].bump_map;
    if (!bump || !bump->multiplier) return material;
    std::map<double, uint32_t>& known = at_scale_[material];
    if (const auto found = known.find(scale); found != known.end()) return found->second;
    const uint32_t scaled = known.empty() ? material : add_material(scene_.materials[material]);
    BumpMap& map = *scene_.materials[scaled].bump_map;
    map.scale = float(scale * double(*map.multiplier));
    known[scale] = scaled;
    at_scale_[scaled].emplace(scale, scaled);
    return scaled;
}

uint32_t SceneBuilder::black() {
    if (!black_) {
        black_ = uint32_t(scene_.materials.size());
        scene_.materials.push_back({"(black)", DiffuseMaterial{vec3(0.0f)}});
    }
    return *black_;
}

}  // namespace candela
