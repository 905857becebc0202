// From text through polygons to a mesh with shared vertices.
#include "load/obj/obj.h"

#include <map>
#include <sstream>
#include <utility>

#include <tiny_obj_loader.h>

#include "base/error.h"
#include "base/file.h"
#include "load/obj/obj_check.h"
#include "load/text_lines.h"
#include "scene/polygon.h"

namespace candela {
namespace {

constexpr uint32_t NONE = ~0u;

struct Corner {
    uint32_t position;
    uint32_t normal;  // Or NONE.
};

// The file as it stands, its indices counted from 0.
struct Polygons {
    std::vector<vec3> positions;
    std::vector<vec3> normals;
    std::vector<Corner> corners;
    std::vector<size_t> ends;  // Of each polygon, in `corners`.
};

// tinyobjloader would cut polygons into triangles itself, but wrongly where they are concave or far from the
// origin; so it hands over the faces as they are.
Polygons parse(std::string text) {
    Polygons polygons;
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* out, float x, float y, float z, float) {
        static_cast<Polygons*>(out)->positions.emplace_back(x, y, z);
    };
    callbacks.normal_cb = [](void* out, float x, float y, float z) {
        static_cast<Polygons*>(out)->normals.emplace_back(x, y, z);
    };
    callbacks.index_cb = [](void* out, tinyobj::index_t* indices, int count) {
        auto& [positions, normals, corners, ends] = *static_cast<Polygons*>(out);
        // Negative indices count backwards from the last element so far; 0 stands for an absent one.
        const auto absolute = [](int index, size_t size) {
            return index == 0 ? NONE : index > 0 ? uint32_t(index - 1) : uint32_t(int64_t(size) + index);
        };
        for (int i = 0; i < count; ++i) {
            corners.push_back({absolute(indices[i].vertex_index, positions.size()),
                               absolute(indices[i].normal_index, normals.size())});
        }
        ends.push_back(corners.size());
    };
    std::istringstream stream(std::move(text));
    tinyobj::LoadObjWithCallback(stream, callbacks, &polygons);
    return polygons;
}

// Collects vertices, one for each pair of position and normal.
class MeshBuilder {
  public:
    explicit MeshBuilder(const Polygons& source, bool with_normals)
        : source_(source), with_normals_(with_normals), newest_(source.positions.size(), NONE) {}

    void add(Corner a, Corner b, Corner c) {
        const uvec3 triangle{vertex(a), vertex(b), vertex(c)};  // Braces: evaluated in this order.
        mesh_.triangles.push_back(triangle);
    }
    TriangleMesh take() { return std::move(mesh_); }

  private:
    uint32_t vertex(Corner corner) {
        if (!with_normals_) corner.normal = NONE;
        uint32_t& newest = newest_[corner.position];
        for (uint32_t v = newest; v != NONE; v = vertices_[v].next) {
            if (vertices_[v].normal == corner.normal) return v;
        }
        vertices_.push_back({corner.normal, newest});
        newest = uint32_t(mesh_.positions.size());
        mesh_.positions.push_back(source_.positions[corner.position]);
        if (with_normals_) {
            mesh_.normals.push_back(corner.normal == NONE ? vec3(0.0f) : source_.normals[corner.normal]);
        }
        return newest;
    }

    struct Vertex {
        uint32_t normal;
        uint32_t next;  // Another vertex at the same position, or NONE.
    };

    const Polygons& source_;
    bool with_normals_;
    std::vector<uint32_t> newest_;  // Of each position: its newest vertex, or NONE.
    std::vector<Vertex> vertices_;
    TriangleMesh mesh_;
};

TriangleMesh build_mesh(const Polygons& source, MeshNormals normals) {
    MeshBuilder builder(source, normals == MeshNormals::file && !source.normals.empty());
    std::vector<vec3> positions;
    size_t begin = 0;
    for (const size_t end : source.ends) {
        const Corner* corners = &source.corners[begin];
        positions.clear();
        for (size_t i = begin; i < end; ++i)
            positions.push_back(source.positions[source.corners[i].position]);
        for (const uvec3 t : triangulate(positions))
            builder.add(corners[t.x], corners[t.y], corners[t.z]);
        begin = end;
    }
    TriangleMesh mesh = builder.take();
    if (normals == MeshNormals::smooth) smooth_normals(mesh);
    return mesh;
}

// What a file says about materials.
struct Statements {
    std::vector<ObjName> libraries;
    std::vector<ObjPart> parts;     // Without their meshes.
    std::vector<uint32_t> part_of;  // For each face, an index into `parts`.
};

Statements find_materials(std::string_view text, const std::string& file) {
    Statements statements;
    std::map<std::string, uint32_t, std::less<>> indices;  // Of the parts; "" is that of no material.
    ObjName current;
    for_each_line(text, [&](uint64_t line, std::string_view command, std::string_view rest) {
        const auto named = [&](const char* what) -> ObjName {
            const std::string_view name = trimmed(rest);
            if (name.empty()) {
                throw Error(file + ':' + std::to_string(line) + ": " + std::string(command) +
                            " needs the name of " + what);
            }
            return {std::string(name), line};
        };
        if (command == "mtllib") statements.libraries.push_back(named("a file"));
        if (command == "usemtl") current = named("a material");
        if (command != "f") return;
        const auto [found, is_new] = indices.emplace(current.name, uint32_t(statements.parts.size()));
        if (is_new) {
            statements.parts.emplace_back();
            if (!current.name.empty()) statements.parts.back().material = current;
        }
        ++statements.parts[found->second].faces;
        statements.part_of.push_back(found->second);
    });
    return statements;
}

}  // namespace

TriangleMesh load_obj(const std::filesystem::path& file, MeshNormals normals) {
    std::string text = read_file(file);
    check_obj(text, file.string());
    return build_mesh(parse(std::move(text)), normals);
}

ObjParts load_obj_parts(const std::filesystem::path& file, MeshNormals normals) {
    std::string text = read_file(file);
    check_obj(text, file.string());
    Statements statements = find_materials(text, file.string());
    const Polygons polygons = parse(std::move(text));

    std::vector<uint32_t> part_of;  // For each triangle.
    size_t begin = 0;
    for (size_t face = 0; face < polygons.ends.size(); ++face) {
        const size_t triangles = polygons.ends[face] - begin - 2;
        part_of.insert(part_of.end(), triangles, statements.part_of[face]);
        begin = polygons.ends[face];
    }
    ObjParts result{std::move(statements.libraries), std::move(statements.parts)};
    std::vector<TriangleMesh> meshes =
        split_mesh(build_mesh(polygons, normals), part_of, result.parts.size());
    for (size_t i = 0; i < meshes.size(); ++i)
        result.parts[i].mesh = std::move(meshes[i]);
    return result;
}

}  // namespace candela
