// Tangents as MikkTSpace defines them: triangles around a vertex that are connected and equally oriented
// share one, the average of theirs. Corner c is corner c % 3 of triangle c / 3; edge c goes from it to the
// next one.
#include "scene/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "scene/mesh.h"

namespace candela {
namespace {

constexpr uint32_t NONE = std::numeric_limits<uint32_t>::max();

uint32_t next_corner(uint32_t c) {
    return c % 3 == 2 ? c - 2 : c + 1;
}
uint32_t previous_corner(uint32_t c) {
    return c % 3 == 0 ? c + 2 : c - 1;
}

// For each of `count` items, the first one whose key, an array of integers, is the same.
template <class Key>
std::vector<uint32_t> first_equal(size_t count, Key key) {
    std::vector<uint32_t> table(std::bit_ceil(2 * count + 1), NONE);  // Hash to item; at most half full.
    const size_t mask = table.size() - 1;
    std::vector<uint32_t> first(count);
    for (size_t i = 0; i < count; ++i) {
        const auto sought = key(uint32_t(i));
        size_t slot = hash_words(std::as_bytes(std::span(sought))) & mask;
        while (table[slot] != NONE && key(table[slot]) != sought)
            slot = (slot + 1) & mask;
        if (table[slot] == NONE) table[slot] = uint32_t(i);
        first[i] = table[slot];
    }
    return first;
}

// The bits of a number, the same for 0 and -0.
uint32_t bits_of(float x) {
    return std::bit_cast<uint32_t>(x + 0.0f);
}

// The direction of v within the plane with unit normal n; 0 if v has no length, is not finite or, up to the
// rounding of a float normal, has no direction there.
dvec3 direction_in_plane(dvec3 v, dvec3 n) {
    constexpr double PARALLEL = 1e-7;
    const dvec3 direction = normalize(v);  // NaN without a length, so that the comparison is false.
    const dvec3 flat = direction - dot(direction, n) * n;
    return length(flat) > PARALLEL ? normalize(flat) : dvec3(0.0);
}

// The tangent where u is unknown: a unit vector orthogonal to the unit normal, near +X if possible.
dvec3 default_tangent(dvec3 n) {
    const dvec3 axis = std::abs(n.x) < 0.99 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    return normalize(axis - dot(axis, n) * n);
}

// The inputs of tangents, by corners.
class Corners {
  public:
    Corners(const TriangleMesh& mesh, uint32_t uv_set)
        : mesh_(mesh), uvs_(uv_set == 0 ? mesh.uv0 : mesh.uv1) {
        if (!mesh.normals.empty() && std::ranges::count(mesh.normals, vec3(0.0f)) == 0) return;
        flat_normals_.reserve(mesh.triangles.size());
        for (uint32_t c = 0; c < count(); c += 3) {
            const dvec3 n = cross(edge(c, c + 1), edge(c, c + 2));
            flat_normals_.push_back(n == dvec3(0.0) ? vec3(0, 0, 1) : vec3(normalize(n)));
        }
    }

    uint32_t count() const { return uint32_t(3 * mesh_.triangles.size()); }
    uint32_t vertex(uint32_t c) const { return mesh_.triangles[c / 3][glm::length_t(c % 3)]; }
    vec3 position(uint32_t c) const { return mesh_.positions[vertex(c)]; }
    vec2 uv(uint32_t c) const { return uvs_[vertex(c)]; }
    // For each corner a number, the same for all that MikkTSpace treats as one vertex.
    std::vector<uint32_t> same_vertices() const {
        if (!flat_normals_.empty())
            return first_equal(count(), [&](uint32_t c) { return key(vertex(c), normal(c)); });
        const std::vector<uint32_t> first =
            first_equal(mesh_.positions.size(), [&](uint32_t v) { return key(v, mesh_.normals[v]); });
        std::vector<uint32_t> numbers(count());
        for (uint32_t c = 0; c < count(); ++c)
            numbers[c] = first[vertex(c)];
        return numbers;
    }
    // The mesh's normal, of any length above 0; the triangle's if there is none.
    vec3 normal(uint32_t c) const {
        const vec3 n = mesh_.normals.empty() ? vec3(0.0f) : mesh_.normals[vertex(c)];
        return n == vec3(0.0f) ? flat_normals_[c / 3] : n;
    }
    dvec3 unit_normal(uint32_t c) const { return normalize(dvec3(normal(c))); }
    dvec3 edge(uint32_t from, uint32_t to) const { return dvec3(position(to)) - dvec3(position(from)); }

  private:
    std::array<uint32_t, 8> key(uint32_t v, vec3 n) const {
        const vec3 p = mesh_.positions[v];
        const vec2 t = uvs_[v];
        return {bits_of(p.x), bits_of(p.y), bits_of(p.z), bits_of(n.x),
                bits_of(n.y), bits_of(n.z), bits_of(t.x), bits_of(t.y)};
    }

    const TriangleMesh& mesh_;
    const std::vector<vec2>& uvs_;
    std::vector<vec3> flat_normals_;  // Unit normals of the triangles; empty if every vertex has a normal.
};

// What a triangle contributes to its corners.
struct Facet {
    enum class Kind {
        useful,
        without_uv_area,  // Its tangent is unknown, and its orientation is that of the first group it joins.
        without_edge,     // Two corners coincide: it has no neighbours.
    };
    Kind kind = Kind::useful;
    bool mirrored = false;  // Its texture coordinates run clockwise.
    dvec3 tangent{0.0};     // Where u grows, unit.
};

// The facet of the triangle whose first corner is c. Ref: Mikkelsen, equations 18 and 19.
Facet facet_of(const Corners& corners, uint32_t c) {
    const vec3 p = corners.position(c);
    const vec3 q = corners.position(c + 1);
    const vec3 r = corners.position(c + 2);
    if (p == q || q == r || r == p) return {.kind = Facet::Kind::without_edge};
    const vec2 uv1 = corners.uv(c + 1) - corners.uv(c);
    const vec2 uv2 = corners.uv(c + 2) - corners.uv(c);
    // In floats, so that the sign of an area near 0 is the same as in the program that baked the normal map.
    const float area = uv1.x * uv2.y - uv1.y * uv2.x;
    const dvec3 edge1 = corners.edge(c, c + 1);
    const dvec3 edge2 = corners.edge(c, c + 2);
    const dvec3 along_u = edge1 * double(uv2.y) - edge2 * double(uv1.y);
    const dvec3 along_v = edge2 * double(uv1.x) - edge1 * double(uv2.x);
    Facet facet{.mirrored = !(area > 0.0f)};
    if (std::abs(area) > FLOAT_MIN && along_u != dvec3(0.0) && along_v != dvec3(0.0))
        facet.tangent = normalize(facet.mirrored ? -along_u : along_u);
    else
        facet.kind = Facet::Kind::without_uv_area;
    return facet;
}

// For each edge the one of a neighbouring triangle that runs the other way, or NONE. Where more than two
// triangles share an edge, the first of either direction belong together, then the second ones.
std::vector<uint32_t> find_twins(const std::vector<Facet>& facets, const std::vector<uint32_t>& vertices) {
    const auto count = uint32_t(vertices.size());
    const std::vector<uint32_t> lines = first_equal(count, [&](uint32_t c) {
        const auto [lo, hi] = std::minmax(vertices[c], vertices[next_corner(c)]);
        return std::array<uint32_t, 2>{lo, hi};
    });
    // The edges along a line without a twin so far, all of one direction.
    struct Queue {
        uint32_t first = NONE;
        uint32_t last = NONE;
    };
    std::vector<Queue> queues(count);
    std::vector<uint32_t> successors(count, NONE);
    std::vector<uint32_t> twins(count, NONE);
    for (uint32_t c = 0; c < count; ++c) {
        if (facets[c / 3].kind == Facet::Kind::without_edge) continue;
        Queue& queue = queues[lines[c]];
        if (queue.first == NONE) {
            queue = {c, c};
        } else if (vertices[queue.first] == vertices[c]) {
            successors[queue.last] = c;
            queue.last = c;
        } else {
            twins[c] = queue.first;
            twins[queue.first] = c;
            queue.first = successors[queue.first];
        }
    }
    return twins;
}

// Connected triangles of one orientation around a vertex.
struct Group {
    bool mirrored = false;
    dvec3 tangent{0.0};  // While it grows, a sum; then unit.
};

class Grouping {
  public:
    explicit Grouping(const Corners& corners) : corners_(corners), group_of_(corners.count(), NONE) {
        const std::vector<uint32_t> vertices = corners.same_vertices();
        facets_.reserve(corners.count() / 3);
        for (uint32_t c = 0; c < corners.count(); c += 3)
            facets_.push_back(facet_of(corners, c));
        twins_ = find_twins(facets_, vertices);
        for (uint32_t c = 0; c < corners.count(); ++c) {
            if (facets_[c / 3].kind == Facet::Kind::useful && group_of_[c] == NONE) form_group(c);
        }
        adopt_groups(vertices);
    }

    // The tangent of a corner, and -1 if the texture is mirrored there, else 1.
    vec4 tangent(uint32_t c) const {
        if (group_of_[c] == NONE) return {vec3(default_tangent(corners_.unit_normal(c))), -1.0f};
        const Group& group = groups_[group_of_[c]];
        return {vec3(group.tangent), group.mirrored ? -1.0f : 1.0f};
    }

  private:
    // Puts a corner, and the corners that are reached from it to either side, into a group.
    void form_group(uint32_t c) {
        groups_.push_back({.mirrored = facets_[c / 3].mirrored});
        join_last_group(c);
        for (uint32_t i = left_of(c); i != NONE && join_last_group(i);)
            i = left_of(i);
        for (uint32_t i = right_of(c); i != NONE && join_last_group(i);)
            i = right_of(i);
        constexpr double CANCELLED = 1e-9;  // [rad]; rounding leaves less than this.
        dvec3& tangent = groups_.back().tangent;
        tangent = length(tangent) > CANCELLED ? normalize(tangent) : default_tangent(corners_.unit_normal(c));
    }

    // The corners at the same vertex beyond the two edges of corner c.
    uint32_t left_of(uint32_t c) const { return twins_[c] == NONE ? NONE : next_corner(twins_[c]); }
    uint32_t right_of(uint32_t c) const { return twins_[previous_corner(c)]; }

    // False if the corner is in a group already, or oriented otherwise.
    bool join_last_group(uint32_t c) {
        if (group_of_[c] != NONE) return false;
        Group& group = groups_.back();
        Facet& facet = facets_[c / 3];
        const bool useful = facet.kind == Facet::Kind::useful;
        const auto is_free = [&](uint32_t corner) { return group_of_[corner] == NONE; };
        if (!useful && is_free(next_corner(c)) && is_free(previous_corner(c)))
            facet.mirrored = group.mirrored;
        if (facet.mirrored != group.mirrored) return false;
        group_of_[c] = uint32_t(groups_.size() - 1);
        if (useful) group.tangent += weighted_tangent(c, facet);
        return true;
    }

    // The triangle's tangent in the plane of the corner's normal, times its angle there [rad].
    dvec3 weighted_tangent(uint32_t c, const Facet& facet) const {
        const dvec3 n = corners_.unit_normal(c);
        const dvec3 to_next = direction_in_plane(corners_.edge(c, next_corner(c)), n);
        const dvec3 to_previous = direction_in_plane(corners_.edge(c, previous_corner(c)), n);
        const double angle = std::acos(std::clamp(dot(to_next, to_previous), -1.0, 1.0));
        return angle * direction_in_plane(facet.tangent, n);
    }

    // Puts the corners of triangles without neighbours into the group of the first other one at their vertex.
    void adopt_groups(const std::vector<uint32_t>& vertices) {
        if (vertices.empty()) return;
        std::vector<uint32_t> model(*std::ranges::max_element(vertices) + size_t{1}, NONE);
        const auto is_orphan = [&](size_t c) { return facets_[c / 3].kind == Facet::Kind::without_edge; };
        for (size_t c = 0; c < vertices.size(); ++c) {
            if (!is_orphan(c) && model[vertices[c]] == NONE) model[vertices[c]] = uint32_t(c);
        }
        for (size_t c = 0; c < vertices.size(); ++c) {
            if (is_orphan(c) && model[vertices[c]] != NONE) group_of_[c] = group_of_[model[vertices[c]]];
        }
    }

    const Corners& corners_;
    std::vector<Facet> facets_;
    std::vector<uint32_t> twins_;
    std::vector<Group> groups_;
    std::vector<uint32_t> group_of_;  // Group of each corner.
};

// The tangent of each corner.
std::vector<vec4> corner_tangents(const TriangleMesh& mesh, uint32_t uv_set) {
    const Corners corners(mesh, uv_set);
    const Grouping grouping(corners);
    std::vector<vec4> tangents(corners.count());
    for (uint32_t c = 0; c < corners.count(); ++c)
        tangents[c] = grouping.tangent(c);
    return tangents;
}

}  // namespace

void add_tangents(TriangleMesh& mesh, uint32_t uv_set) {
    assert(uv_set < 2);
    assert((uv_set == 0 ? mesh.uv0 : mesh.uv1).size() == mesh.positions.size());
    const std::vector<vec4> tangents = corner_tangents(mesh, uv_set);
    const auto corner = [&](uint32_t c) -> uint32_t& { return mesh.triangles[c / 3][glm::length_t(c % 3)]; };
    // The first corner of a vertex keeps it, as do those with the same tangent.
    constexpr vec4 UNUSED(0.0f);
    std::vector<vec4> of_vertices(mesh.positions.size(), UNUSED);
    std::vector<uint32_t> others;
    for (uint32_t c = 0; c < tangents.size(); ++c) {
        vec4& tangent = of_vertices[corner(c)];
        if (tangent == UNUSED)
            tangent = tangents[c];
        else if (tangent != tangents[c])
            others.push_back(c);
    }
    const std::vector<uint32_t> first = first_equal(others.size(), [&](uint32_t i) {
        const vec4 t = tangents[others[i]];
        return std::array<uint32_t, 5>{corner(others[i]), bits_of(t.x), bits_of(t.y), bits_of(t.z),
                                       bits_of(t.w)};
    });
    for (uint32_t i = 0; i < others.size(); ++i) {
        if (first[i] == i) {
            corner(others[i]) = append_vertex(mesh, mesh, corner(others[i]));
            of_vertices.push_back(tangents[others[i]]);
        } else {
            corner(others[i]) = corner(others[first[i]]);
        }
    }
    for (size_t i = 0; i < of_vertices.size(); ++i) {
        if (of_vertices[i] != UNUSED) continue;
        const bool smooth = !mesh.normals.empty() && mesh.normals[i] != vec3(0.0f);
        const dvec3 n = smooth ? normalize(dvec3(mesh.normals[i])) : dvec3(0, 0, 1);
        of_vertices[i] = vec4(vec3(default_tangent(n)), -1.0f);
    }
    mesh.tangents = std::move(of_vertices);
}

}  // namespace candela
