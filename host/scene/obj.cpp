// From text through polygons to a mesh with shared vertices.
#include "scene/obj.h"

#include <sstream>
#include <utility>

#include <tiny_obj_loader.h>

#include "base/error.h"
#include "base/file.h"
#include "scene/mesh.h"
#include "scene/obj_check.h"
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

TriangleMesh build_mesh(const Polygons& source, bool with_normals) {
    MeshBuilder builder(source, with_normals);
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
    return builder.take();
}

}  // namespace

TriangleMesh load_obj(const std::filesystem::path& file, ObjNormals normals) {
    std::string text = read_file(file);
    check_obj(text, file.string());
    const Polygons polygons = parse(std::move(text));
    TriangleMesh mesh = build_mesh(polygons, normals == ObjNormals::file && !polygons.normals.empty());
    if (normals == ObjNormals::smooth) smooth_normals(mesh);
    return mesh;
}

}  // namespace candela
