// Ear clipping.
#include "scene/polygon.h"

#include <algorithm>
#include <numeric>

namespace candela {
namespace {

// The corners projected onto the coordinate plane where the polygon is largest, mirrored if need be so that
// it runs counter-clockwise.
std::vector<glm::dvec2> flatten(std::span<const vec3> corners) {
    const glm::dvec3 origin(corners[0]);
    glm::dvec3 normal(0.0);  // Newell's: twice the areas of the three projections.
    for (size_t i = 1; i + 1 < corners.size(); ++i) {
        normal += cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
    }
    const glm::dvec3 size = abs(normal);
    const glm::length_t axis = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
    glm::length_t u = (axis + 1) % 3;
    glm::length_t v = (axis + 2) % 3;
    if (normal[axis] < 0.0) std::swap(u, v);
    std::vector<glm::dvec2> flat;
    flat.reserve(corners.size());
    for (const vec3 corner : corners)
        flat.emplace_back(corner[u], corner[v]);
    return flat;
}

// Twice the area of a triangle, positive if it runs counter-clockwise.
double area(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether the corner ear.y of the remaining polygon is convex and no other corner lies in the triangle `ear`
// that it spans with its neighbours.
bool is_ear(const std::vector<glm::dvec2>& points, const std::vector<uint32_t>& remaining, uvec3 ear) {
    const glm::dvec2 a = points[ear.x];
    const glm::dvec2 b = points[ear.y];
    const glm::dvec2 c = points[ear.z];
    if (area(a, b, c) <= 0.0) return false;
    return std::none_of(remaining.begin(), remaining.end(), [&](uint32_t i) {
        const glm::dvec2 p = points[i];
        const bool is_corner = p == a || p == b || p == c;
        return !is_corner && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
    });
}

}  // namespace

std::vector<uvec3> triangulate(std::span<const vec3> corners) {
    if (corners.size() == 3) return {uvec3(0, 1, 2)};
    const std::vector<glm::dvec2> points = flatten(corners);
    std::vector<uint32_t> remaining(corners.size());
    std::iota(remaining.begin(), remaining.end(), 0u);
    std::vector<uvec3> triangles;
    triangles.reserve(corners.size() - 2);
    while (remaining.size() > 2) {
        const size_t n = remaining.size();
        const auto triangle_at = [&](size_t i) {
            return uvec3(remaining[(i + n - 1) % n], remaining[i], remaining[(i + 1) % n]);
        };
        size_t cut = 0;
        while (cut < n && !is_ear(points, remaining, triangle_at(cut)))
            ++cut;
        cut %= n;  // No ear: the polygon crosses itself or has no area.
        triangles.push_back(triangle_at(cut));
        remaining.erase(remaining.begin() + std::ptrdiff_t(cut));
    }
    return triangles;
}

}  // namespace candela
