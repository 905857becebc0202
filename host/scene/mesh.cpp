// The treatment of meshes, in double precision where it decides something.
#include "scene/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

namespace candela {
namespace {

// Twice the area times the unit normal. In double, products of float differences are all but exact.
glm::dvec3 scaled_normal(const TriangleMesh& mesh, uvec3 triangle) {
    const glm::dvec3 origin(mesh.positions[triangle.x]);
    return cross(glm::dvec3(mesh.positions[triangle.y]) - origin,
                 glm::dvec3(mesh.positions[triangle.z]) - origin);
}

// For each vertex, the first vertex in the order of sorting that has the same position.
std::vector<uint32_t> representatives(const std::vector<vec3>& positions) {
    std::vector<uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const vec3 p = positions[a];
        const vec3 q = positions[b];
        return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    });
    std::vector<uint32_t> first(positions.size());
    for (size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

// The angle between two directions [rad]; 0 if one has no length.
double angle_between(glm::dvec3 a, glm::dvec3 b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

size_t drop_flat_triangles(TriangleMesh& mesh) {
    return std::erase_if(mesh.triangles, [&](uvec3 t) { return scaled_normal(mesh, t) == glm::dvec3(0.0); });
}

void smooth_normals(TriangleMesh& mesh) {
    const std::vector<uint32_t> first = representatives(mesh.positions);
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    for (const uvec3 t : mesh.triangles) {
        const glm::dvec3 n = scaled_normal(mesh, t);
        if (n == glm::dvec3(0.0)) continue;
        const std::array<glm::dvec3, 3> p{glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]),
                                          glm::dvec3(mesh.positions[t.z])};
        for (glm::length_t i = 0; i < 3; ++i) {
            const glm::dvec3 corner = p[size_t(i)];
            const double angle = angle_between(p[size_t(i + 1) % 3] - corner, p[size_t(i + 2) % 3] - corner);
            sums[first[t[i]]] += angle * normalize(n);
        }
    }
    mesh.normals.resize(mesh.positions.size());
    for (size_t i = 0; i < first.size(); ++i) {
        constexpr double CANCELLED = 1e-9;  // Radians; rounding leaves less than that.
        const glm::dvec3 sum = sums[first[i]];
        mesh.normals[i] = length(sum) > CANCELLED ? vec3(normalize(sum)) : vec3(0.0f);
    }
}

void complete_normals(TriangleMesh& mesh) {
    const auto is_missing = [](vec3 n) { return n == vec3(0.0f); };
    if (std::all_of(mesh.normals.begin(), mesh.normals.end(), is_missing)) {
        mesh.normals.clear();
        return;
    }
    for (uvec3& t : mesh.triangles) {
        const vec3 n(normalize(scaled_normal(mesh, t)));
        for (glm::length_t i = 0; i < 3; ++i) {
            if (!is_missing(mesh.normals[t[i]])) continue;
            mesh.positions.push_back(mesh.positions[t[i]]);
            mesh.normals.push_back(n);
            t[i] = uint32_t(mesh.positions.size() - 1);
        }
    }
}

std::vector<TriangleMesh> split_mesh(const TriangleMesh& mesh, std::span<const uint32_t> part_of,
                                     size_t count) {
    std::vector<TriangleMesh> parts(count);
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        parts[part_of[i]].triangles.push_back(mesh.triangles[i]);
    struct Copy {
        size_t part;     // The part that the vertex was copied to last ...
        uint32_t index;  // ... and its index there.
    };
    std::vector<Copy> copies(mesh.positions.size(), {count, 0});
    for (size_t part = 0; part < count; ++part) {
        TriangleMesh& target = parts[part];
        for (uvec3& t : target.triangles) {
            for (glm::length_t i = 0; i < 3; ++i) {
                Copy& copy = copies[t[i]];
                if (copy.part != part) {
                    copy = {part, uint32_t(target.positions.size())};
                    target.positions.push_back(mesh.positions[t[i]]);
                    if (!mesh.normals.empty()) target.normals.push_back(mesh.normals[t[i]]);
                }
                t[i] = copy.index;
            }
        }
    }
    return parts;
}

}  // namespace candela
