// The last steps of every mesh, and materials by name.
#include "scene/scene_builder.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "scene/mesh.h"

namespace candela {

std::optional<vec3> rounded(glm::dvec3 p) {
    if (!glm::all(glm::lessThanEqual(abs(p), glm::dvec3(double(MAX_COORDINATE))))) return std::nullopt;
    return vec3(p);
}

void move_to_world(const std::string& place, const Transform& transform, TriangleMesh& mesh) {
    for (vec3& p : mesh.positions) {
        const std::optional<vec3> moved = rounded(transform.point(glm::dvec3(p)));
        if (!moved) throw Error(place + ": " + POINT_TOO_FAR);
        p = *moved;
    }
}

void SceneBuilder::add_mesh(const std::string& place, const Transform& transform,
                            std::vector<MeshPart> parts) {
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
    if (parts.empty()) throw Error(place + ": the mesh has no triangle with an area; check its positions");
    if (dropped > 0) {
        warn(place, "left out " + std::to_string(dropped) + (dropped == 1 ? " triangle" : " triangles") +
                        " without area");
    }
    for (MeshPart& part : parts) {
        complete_normals(part.mesh);
        add(part.appearance, std::move(part.mesh));
    }
}

void SceneBuilder::add_mesh(const std::string& place, const Appearance& appearance,
                            const Transform& transform, TriangleMesh mesh) {
    std::vector<MeshPart> parts;  // Not from an initializer list, which would copy the mesh.
    parts.push_back({appearance, std::move(mesh)});
    add_mesh(place, transform, std::move(parts));
}

const Appearance* SceneBuilder::find_file_appearance(const std::string& name) const {
    const auto found = file_appearances_.find(name);
    return found == file_appearances_.end() ? nullptr : &found->second;
}

void SceneBuilder::add_file_appearance(const std::string& name, const decltype(Material::model)& model,
                                       const std::optional<Emission>& emission) {
    std::vector<Material>& materials = scene_.materials;
    std::string unique = name;
    const auto is_taken = [&](const Material& material) { return material.name == unique; };
    for (int i = 2; std::any_of(materials.begin(), materials.end(), is_taken); ++i)
        unique = name + " (" + std::to_string(i) + ')';
    file_appearances_[name] = {uint32_t(materials.size()), emission};
    materials.push_back({unique, model});
}

uint32_t SceneBuilder::black() {
    if (!black_) {
        black_ = uint32_t(scene_.materials.size());
        scene_.materials.push_back({"(black)", DiffuseMaterial{vec3(0.0f)}});
    }
    return *black_;
}

}  // namespace candela
