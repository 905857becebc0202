// Operations on meshes, in double precision where a decision depends on it.
#include "scene/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "scene/polygon.h"

namespace candela {
namespace {

// Twice the area times the unit normal. In double, products of float differences are nearly exact.
glm::dvec3 scaled_normal(const TriangleMesh& mesh, uvec3 triangle) {
    const glm::dvec3 origin(mesh.positions[triangle.x]);
    return cross(glm::dvec3(mesh.positions[triangle.y]) - origin,
                 glm::dvec3(mesh.positions[triangle.z]) - origin);
}

// For each vertex, the one of least index that has the same position.
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

uint32_t append_vertex(TriangleMesh& mesh, const TriangleMesh& source, uint32_t index) {
    const auto append = [&](auto array) {
        if ((source.*array).empty()) return;
        const auto element = (source.*array)[index];  // A copy, since both may be one mesh.
        (mesh.*array).push_back(element);
    };
    std::apply([&](auto... arrays) { (append(arrays), ...); }, VERTEX_ARRAYS);
    return uint32_t(mesh.positions.size() - 1);
}

void set_positions(TriangleMesh& mesh, std::vector<glm::dvec3> positions) {
    glm::dvec3 lo(std::numeric_limits<double>::infinity());
    glm::dvec3 hi = -lo;
    for (const glm::dvec3 p : positions) {
        lo = min(lo, p);
        hi = max(hi, p);
    }
    const glm::dvec3 extent = hi - lo;
    const double size = std::max({extent.x, extent.y, extent.z});
    mesh.origin = glm::dvec3(0.0);
    if (size > 0.0) {
        int exponent = 0;
        std::frexp(size, &exponent);
        const double unit = std::ldexp(1.0, exponent);  // size < unit <= 2 size.
        mesh.origin = trunc((0.5 * lo + 0.5 * hi) / unit) * unit;
    }
    mesh.positions.clear();
    mesh.positions.reserve(positions.size());
    for (const glm::dvec3 p : positions)
        mesh.positions.emplace_back(p - mesh.origin);
}

void add_polygon(TriangleMesh& mesh, std::span<const uint32_t> corners) {
    if (corners.size() == 3) {
        mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
        return;
    }
    std::vector<vec3> positions;
    positions.reserve(corners.size());
    for (const uint32_t corner : corners)
        positions.push_back(mesh.positions[corner]);
    for (const uvec3 t : triangulate(positions))
        mesh.triangles.emplace_back(corners[t.x], corners[t.y], corners[t.z]);
}

Box local_bounds(const TriangleMesh& mesh) {
    Box box;
    for (const vec3 p : mesh.positions)
        box.extend(p);
    return box;
}

size_t count_coarse_triangles(const TriangleMesh& mesh) {
    constexpr double STEPS = 16.0;
    const auto greatest = [](dvec3 v) { return std::max({v.x, v.y, v.z}); };
    return size_t(std::ranges::count_if(mesh.triangles, [&](uvec3 t) {
        const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        const double side = greatest(max(a, max(b, c)) - min(a, min(b, c)));
        return side < STEPS * 0x1p-23 * greatest(abs(mesh.origin + a));
    }));
}

bool is_too_coarse(uint64_t coarse, uint64_t triangles) {
    return 100 * coarse > triangles;
}

size_t drop_flat_triangles(TriangleMesh& mesh) {
    const auto is_flat = [&](uvec3 t) { return scaled_normal(mesh, t) == glm::dvec3(0.0); };
    if (mesh.groups.empty()) return std::erase_if(mesh.triangles, is_flat);
    size_t kept = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (is_flat(mesh.triangles[i])) continue;
        mesh.triangles[kept] = mesh.triangles[i];
        mesh.groups[kept++] = mesh.groups[i];
    }
    const size_t dropped = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    mesh.groups.resize(kept);
    return dropped;
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
        constexpr double CANCELLED = 1e-9;  // [rad]; rounding leaves less than this.
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
            t[i] = append_vertex(mesh, mesh, t[i]);
            mesh.normals.back() = n;
        }
    }
}

std::vector<TriangleMesh> split_mesh(const TriangleMesh& mesh, std::span<const uint32_t> part_of,
                                     size_t count) {
    std::vector<TriangleMesh> parts(count, TriangleMesh{.origin = mesh.origin});
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        parts[part_of[i]].triangles.push_back(mesh.triangles[i]);
    for (size_t i = 0; i < mesh.groups.size(); ++i)
        parts[part_of[i]].groups.push_back(mesh.groups[i]);
    struct Copy {
        size_t part;     // The part to which the vertex was copied last.
        uint32_t index;  // Its index in that part.
    };
    std::vector<Copy> copies(mesh.positions.size(), {count, 0});
    for (size_t part = 0; part < count; ++part) {
        TriangleMesh& target = parts[part];
        for (uvec3& t : target.triangles) {
            for (glm::length_t i = 0; i < 3; ++i) {
                Copy& copy = copies[t[i]];
                if (copy.part != part) copy = {part, append_vertex(target, mesh, t[i])};
                t[i] = copy.index;
            }
        }
    }
    return parts;
}

TriangleMesh placed(const TriangleMesh& mesh, const Transform& transform, const SceneFrame& frame) {
    TriangleMesh result = mesh;
    result.origin = glm::dvec3(0.0);
    for (vec3& p : result.positions)
        p = frame.point(transform.point(mesh.origin + dvec3(p)));
    for (vec3& n : result.normals)
        n = transform.normal(n);
    for (vec4& t : result.tangents) {
        const glm::dvec3 direction = transform.vector(glm::dvec3(t));
        t = vec4(vec3(normalize(direction)), transform.mirrors() ? -t.w : t.w);
    }
    if (transform.mirrors()) {
        for (uvec3& t : result.triangles)
            std::swap(t.y, t.z);
    }
    return result;
}

}  // namespace candela
