// See mesh_solids.h.
#include "gpu_scene/mesh_solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>

#include "base/hash.h"

namespace candela {
namespace {

// Finds vertices at places that differ by no more than `tolerance` along any axis.
class Welder {
  public:
    Welder(const std::vector<vec3>& positions, double tolerance)
        : positions_(positions), tolerance_(tolerance), side_(CELL * tolerance) {}

    // The first vertex so far that is at the same place as this one.
    uint32_t find(uint32_t vertex) {
        const dvec3 p(positions_[vertex]);
        const dvec3 lo = floor((p - tolerance_) / side_), hi = floor((p + tolerance_) / side_);
        for (double x = lo.x; x <= hi.x; ++x) {
            for (double y = lo.y; y <= hi.y; ++y) {
                for (double z = lo.z; z <= hi.z; ++z) {
                    const auto [begin, end] = cells_.equal_range(key(dvec3(x, y, z)));
                    for (auto other = begin; other != end; ++other) {
                        const dvec3 distance = abs(dvec3(positions_[other->second]) - p);
                        if (glm::all(glm::lessThanEqual(distance, dvec3(tolerance_)))) return other->second;
                    }
                }
            }
        }
        cells_.emplace(key(floor(p / side_)), vertex);
        return vertex;
    }

  private:
    static constexpr double CELL = 16.0;  // Tolerances along a side, so that few places are near another
                                          // cell.

    static uint64_t key(dvec3 cell) {
        const std::array<double, 3> words{cell.x + 0.0, cell.y + 0.0, cell.z + 0.0};  // No -0.
        return hash_words(std::as_bytes(std::span(words)));
    }

    const std::vector<vec3>& positions_;
    double tolerance_, side_;
    std::unordered_multimap<uint64_t, uint32_t> cells_;
};

// The triangles, with each corner replaced by the lowest vertex at the same place.
std::vector<uvec3> welded_triangles(const TriangleMesh& mesh) {
    float greatest = 0.0f;
    for (const uvec3 t : mesh.triangles) {
        for (glm::length_t i = 0; i < 3; ++i) {
            const vec3 p = abs(mesh.positions[t[i]]);
            greatest = std::max({greatest, p.x, p.y, p.z});
        }
    }
    Welder welder(mesh.positions, 0x1p-22 * double(greatest));
    constexpr uint32_t UNKNOWN = UINT32_MAX;
    std::vector<uint32_t> first(mesh.positions.size(), UNKNOWN);
    std::vector<uvec3> triangles = mesh.triangles;
    for (uvec3& t : triangles) {
        for (glm::length_t i = 0; i < 3; ++i) {
            uint32_t& vertex = first[t[i]];
            if (vertex == UNKNOWN) vertex = welder.find(t[i]);
            t[i] = vertex;
        }
    }
    return triangles;
}

// For each vertex of the triangles, one that represents all vertices connected to it.
std::vector<uint32_t> connected(const std::vector<uvec3>& triangles, size_t vertices) {
    std::vector<uint32_t> root(vertices);
    std::iota(root.begin(), root.end(), 0u);
    const auto root_of = [&](uint32_t i) {
        while (root[i] != i)
            i = root[i] = root[root[i]];
        return i;
    };
    for (const uvec3 t : triangles) {
        for (const uint32_t other : {t.y, t.z}) {
            const uint32_t a = root_of(t.x), b = root_of(other);
            root[std::max(a, b)] = std::min(a, b);
        }
    }
    for (uint32_t i = 0; i < vertices; ++i)
        root[i] = root_of(i);
    return root;
}

uint64_t hash_edge(uint32_t from, uint32_t to) {
    const std::array<uint32_t, 2> edge{from, to};
    return hash_words(std::as_bytes(std::span(edge)));
}

}  // namespace

std::vector<MeshSolid> find_mesh_solids(const TriangleMesh& mesh) {
    const std::vector<uvec3> triangles = welded_triangles(mesh);
    const std::vector<uint32_t> root = connected(triangles, mesh.positions.size());
    std::vector<MeshSolid> solids;
    std::vector<uint64_t> edges;  // The signed sum of the edges' hashes: 0 if closed, otherwise only by
                                  // chance.
    std::unordered_map<uint32_t, size_t> places;  // By root.
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        const uvec3 t = triangles[i];
        const auto [place, is_new] = places.try_emplace(root[t.x], solids.size());
        if (is_new) {
            solids.emplace_back();
            edges.push_back(0);
        }
        MeshSolid& solid = solids[place->second];
        for (const auto& [from, to] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)})
            edges[place->second] += hash_edge(from, to) - hash_edge(to, from);
        const uvec3 own = mesh.triangles[i];
        const vec3 a = mesh.positions[own.x], b = mesh.positions[own.y], c = mesh.positions[own.z];
        for (const vec3 corner : {a, b, c})
            solid.box.extend(corner);
        solid.volume += dot(dvec3(a), glm::cross(dvec3(b), dvec3(c))) / 6.0;
        solid.triangles.push_back(i);
    }
    for (size_t i = 0; i < solids.size(); ++i)
        solids[i].closed = edges[i] == 0;
    return solids;
}

}  // namespace candela
