// Materials by name, emission, and the last steps of every mesh.
#include "scene/shape_list.h"

#include <algorithm>
#include <utility>

#include "scene/mesh.h"

namespace candela {

vec3 rounded(const Node& node, glm::dvec3 p) {
    if (!glm::all(glm::lessThanEqual(abs(p), glm::dvec3(double(MAX_COORDINATE))))) {
        node.fail("a point of the shape lies beyond 1e37 along an axis; check its numbers and its transform");
    }
    return vec3(p);
}

ShapeList::ShapeList(std::filesystem::path folder, Scene& scene) : folder_(std::move(folder)), scene_(scene) {
    for (const Material& material : scene.materials)
        indices_.emplace(material.name, uint32_t(indices_.size()));
}

Appearance ShapeList::appearance_of(const Node& node) {
    const auto material = node.find("material");
    if (!material && !node.find("emission")) {
        node.fail("the shape has neither material nor emission; add one of them");
    }
    const std::optional<Emission> emission = emission_of(node);
    return {material ? index_of(*material) : black(), emission};
}

std::optional<Emission> ShapeList::emission_of(const Node& node) {
    const auto emission = node.find("emission");
    const auto two_sided = node.find("two_sided");
    const bool both_sides = two_sided && two_sided->boolean();
    if (two_sided && !emission) {
        two_sided->fail("two_sided says where emission leaves; it needs \"emission\"");
    }
    const vec3 radiance = emission ? vec3(emission->rgb()) : vec3(0.0f);
    if (radiance == vec3(0.0f)) return std::nullopt;
    return Emission{radiance, both_sides};
}

Transform ShapeList::transform_of(const Node& node) {
    const auto transform = node.find("transform");
    return transform ? read_transform(*transform) : Transform();
}

void ShapeList::add_mesh(const Node& node, const Transform& transform, std::vector<MeshPart> parts) {
    size_t dropped = 0;
    for (MeshPart& part : parts) {
        for (vec3& n : part.mesh.normals)
            n = transform.normal(n);
        if (transform.mirrors()) {
            for (uvec3& t : part.mesh.triangles)
                std::swap(t.y, t.z);
        }
        dropped += drop_flat_triangles(part.mesh);
    }
    std::erase_if(parts, [](const MeshPart& part) { return part.mesh.triangles.empty(); });
    if (parts.empty()) node.fail("the mesh has no triangle with an area; check its positions");
    if (dropped > 0) {
        scene_.warnings.push_back(node.place() + ": left out " + std::to_string(dropped) +
                                  (dropped == 1 ? " triangle" : " triangles") + " without area");
    }
    for (MeshPart& part : parts) {
        complete_normals(part.mesh);
        add(part.appearance, std::move(part.mesh));
    }
}

void ShapeList::add_mesh(const Node& node, const Appearance& appearance, const Transform& transform,
                         TriangleMesh mesh) {
    std::vector<MeshPart> parts;  // Not from an initializer list, which would copy the mesh.
    parts.push_back({appearance, std::move(mesh)});
    add_mesh(node, transform, std::move(parts));
}

const Appearance* ShapeList::find_file_appearance(const std::string& name) const {
    const auto found = file_appearances_.find(name);
    return found == file_appearances_.end() ? nullptr : &found->second;
}

void ShapeList::add_file_appearance(const std::string& name, const decltype(Material::model)& model,
                                    const std::optional<Emission>& emission) {
    std::vector<Material>& materials = scene_.materials;
    std::string unique = name;
    const auto is_taken = [&](const Material& material) { return material.name == unique; };
    for (int i = 2; std::any_of(materials.begin(), materials.end(), is_taken); ++i)
        unique = name + " (" + std::to_string(i) + ')';
    file_appearances_[name] = {uint32_t(materials.size()), emission};
    materials.push_back({unique, model});
}

uint32_t ShapeList::index_of(const Node& material) const {
    const auto found = indices_.find(material.string());
    if (found != indices_.end()) return found->second;
    std::vector<std::string> names;
    for (size_t i = 0; i < indices_.size(); ++i)
        names.push_back(scene_.materials[i].name);
    material.fail_unknown("material", material.string(), names, "defined");
}

// The material of emitters that reflect nothing.
uint32_t ShapeList::black() {
    if (!black_) {
        black_ = uint32_t(scene_.materials.size());
        scene_.materials.push_back({"(black)", DiffuseMaterial{vec3(0.0f)}});
    }
    return *black_;
}

}  // namespace candela
