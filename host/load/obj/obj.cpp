// From faces to a mesh with shared vertices.
#include "load/obj/obj.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <utility>

namespace candela {
namespace {

constexpr uint32_t NONE = ObjCorner::NONE;

// The vertices of a mesh, one for each triple of position, texture coordinates and normal that a corner has.
class Vertices {
  public:
    Vertices(const ObjFile& obj, bool with_normals)
        : obj_(obj), with_normals_(with_normals), newest_(obj.positions.size(), NONE) {}

    // The index of the vertex of the file's corner `i`.
    uint32_t add(size_t i) {
        ObjCorner corner = obj_.corners[i];
        if (!with_normals_) corner.normal = NONE;
        const bool with_uvs = !obj_.corner_uvs.empty();
        const uint32_t uv = with_uvs ? obj_.corner_uvs[i] : NONE;
        uint32_t& newest = newest_[corner.position];
        // A file may give one position to any number of vertices.
        constexpr int MAX_LOOKED_AT = 64;
        int looked_at = 0;
        for (uint32_t v = newest; v != NONE && looked_at < MAX_LOOKED_AT;
             v = vertices_[v].next, ++looked_at) {
            if (vertices_[v].corner.normal == corner.normal && (!with_uvs || uvs_[v] == uv)) return v;
        }
        vertices_.push_back({corner, newest});
        if (with_uvs) uvs_.push_back(uv);
        newest = uint32_t(vertices_.size() - 1);
        return newest;
    }

    // A mesh of these vertices, without triangles.
    TriangleMesh mesh() const {
        TriangleMesh mesh;
        std::vector<glm::dvec3> positions;
        positions.reserve(vertices_.size());
        for (const Vertex& vertex : vertices_)
            positions.push_back(obj_.positions[vertex.corner.position]);
        set_positions(mesh, std::move(positions));
        mesh.uv0.reserve(uvs_.size());
        for (const uint32_t uv : uvs_)
            mesh.uv0.push_back(uv == NONE ? vec2(0.0f) : obj_.uvs[uv]);
        if (!obj_.colors.empty()) {
            mesh.colors.reserve(vertices_.size());
            for (const auto& [corner, next] : vertices_)
                mesh.colors.emplace_back(obj_.colors[corner.position], 1.0f);
        }
        if (!with_normals_) return mesh;
        mesh.normals.reserve(vertices_.size());
        for (const auto& [corner, next] : vertices_)
            mesh.normals.push_back(corner.normal == NONE ? vec3(0.0f) : obj_.normals[corner.normal]);
        return mesh;
    }

  private:
    struct Vertex {
        ObjCorner corner;
        uint32_t next;  // Another vertex at the same position, or NONE.
    };

    const ObjFile& obj_;
    bool with_normals_;
    std::vector<uint32_t> newest_;  // For each position, its newest vertex, or NONE.
    std::vector<Vertex> vertices_;
    std::vector<uint32_t> uvs_;  // For each vertex, or NONE; empty if no corner has any.
};

// Frees the corners of `obj` and what they refer to, to save memory.
TriangleMesh build_mesh(ObjFile& obj, MeshNormals normals) {
    std::vector<uint32_t> corners;
    corners.reserve(obj.corners.size());
    TriangleMesh mesh;
    {
        Vertices vertices(obj, normals == MeshNormals::file && !obj.normals.empty());
        for (size_t i = 0; i < obj.corners.size(); ++i)
            corners.push_back(vertices.add(i));
        obj.corners = {};
        obj.corner_uvs = {};
        mesh = vertices.mesh();
    }
    obj.positions = {};
    obj.colors = {};
    obj.uvs = {};
    obj.normals = {};
    mesh.triangles.reserve(corners.size() - 2 * obj.sizes.size());
    std::span<const uint32_t> rest = corners;
    for (size_t face = 0; face < obj.sizes.size(); ++face) {
        const uint32_t size = obj.sizes[face];
        add_polygon(mesh, rest.first(size));
        rest = rest.subspan(size);
        if (!obj.group_of.empty()) mesh.groups.insert(mesh.groups.end(), size - 2, obj.group_of[face]);
    }
    if (normals == MeshNormals::smooth) smooth_normals(mesh);
    return mesh;
}

}  // namespace

TriangleMesh load_obj(const std::filesystem::path& file, MeshNormals normals, const FileReach& reach,
                      std::vector<std::string>& warnings) {
    ObjFile obj = parse_obj(reach.read(file), file.string());
    std::ranges::move(obj.warnings, std::back_inserter(warnings));
    obj.group_of = {};
    return build_mesh(obj, normals);
}

ObjParts load_obj_parts(const std::filesystem::path& file, MeshNormals normals, const FileReach& reach) {
    ObjFile obj = parse_obj(reach.read(file), file.string());
    ObjParts result{std::move(obj.libraries), {}, std::move(obj.groups), std::move(obj.warnings)};
    std::map<std::string_view, uint32_t> indices;  // Indices of the parts, by name; empty for no material.
    std::vector<uint32_t> part_of;                 // For each triangle.
    std::vector<bool> has_uvs;                     // For each part: whether a corner has some.
    size_t corner = 0;
    for (size_t face = 0; face < obj.sizes.size(); ++face) {
        const ObjName& use = obj.uses[obj.use_of[face]];
        const auto [found, is_new] = indices.emplace(use.name, uint32_t(result.parts.size()));
        if (is_new) {
            result.parts.emplace_back();
            has_uvs.push_back(false);
            if (!use.name.empty()) result.parts.back().material = use;
        }
        ++result.parts[found->second].faces;
        part_of.insert(part_of.end(), obj.sizes[face] - 2, found->second);
        const size_t end = corner + obj.sizes[face];
        for (; corner < end && !obj.corner_uvs.empty(); ++corner) {
            if (obj.corner_uvs[corner] != NONE) has_uvs[found->second] = true;
        }
    }
    std::vector<TriangleMesh> meshes = split_mesh(build_mesh(obj, normals), part_of, result.parts.size());
    for (size_t i = 0; i < meshes.size(); ++i) {
        if (!has_uvs[i]) meshes[i].uv0 = {};
        result.parts[i].mesh = std::move(meshes[i]);
    }
    return result;
}

}  // namespace candela
