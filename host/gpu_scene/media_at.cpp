// See media_at.h.
#include "gpu_scene/media_at.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <vector>

#include "shared/material.h"
#include "shared/primitive.h"

namespace candela {
namespace {

// Upwards, so that it meets the surface of a lake; along no axis and in no plane that scenes are likely to
// have edges in.
const dvec3 DIRECTION = normalize(dvec3(0.123456, 0.978, 0.0765432));

// What a ray tells about one medium.
struct Passage {
    int exits = 0;  // Less the entries.
    double nearest_exit = INFINITE;
};

// Counts where the ray from `o` along DIRECTION crosses a primitive: at `t`, out of the solid or into it.
void cross(Passage& passage, double t, bool out) {
    if (t <= 0.0) return;
    passage.exits += out ? 1 : -1;
    if (out) passage.nearest_exit = std::min(passage.nearest_exit, t);
}

// Ref: Moeller and Trumbore 1997, Fast, Minimum Storage Ray/Triangle Intersection.
void cross_triangle(Passage& passage, dvec3 o, dvec3 a, dvec3 b, dvec3 c) {
    const dvec3 e1 = b - a, e2 = c - a, p = glm::cross(DIRECTION, e2), s = o - a, q = glm::cross(s, e1);
    const double det = dot(e1, p);
    const double u = dot(s, p) / det, v = dot(DIRECTION, q) / det;
    if (det == 0.0 || u < 0.0 || v < 0.0 || u + v > 1.0) return;
    cross(passage, dot(e2, q) / det, det < 0.0);
}

void cross_sphere(Passage& passage, dvec3 o, dvec3 centre, double radius) {
    const double middle = dot(centre - o, DIRECTION);
    const dvec3 nearest = o + middle * DIRECTION - centre;
    const double half_chord_squared = radius * radius - dot(nearest, nearest);
    if (half_chord_squared <= 0.0) return;
    cross(passage, middle - std::sqrt(half_chord_squared), false);
    cross(passage, middle + std::sqrt(half_chord_squared), true);
}

void cross_disk(Passage& passage, dvec3 o, dvec3 centre, dvec3 e1, dvec3 e2) {
    const dvec3 n = glm::cross(e1, e2);
    const double cosine = dot(n, DIRECTION);
    const double t = dot(n, centre - o) / cosine;
    const dvec3 p = o + t * DIRECTION - centre;
    const double x = dot(glm::cross(p, e2), n), y = dot(glm::cross(e1, p), n), squared = dot(n, n);
    if (cosine == 0.0 || x * x + y * y > squared * squared) return;
    cross(passage, t, cosine > 0.0);
}

dvec3 point_of(uvec4 word) {
    return dvec3(std::bit_cast<vec4>(word));
}

}  // namespace

uvec2 media_at(const GpuScene& scene, dvec3 point) {
    const auto medium_of = [&](uint32_t material) {
        return scene.arrays[ARRAY_MATERIALS][size_t{material} * MATERIAL_WORDS].x >> 8;
    };
    bool any = false;
    for (uint32_t i = 0; i < scene.material_count; ++i)
        any |= medium_of(i) != MEDIUM_SAME;
    if (!any) return uvec2(0);

    const dvec3 o = (point - scene.frame.origin) / scene.frame.unit;
    std::map<uint32_t, Passage> passages;
    for (uint32_t i = 0; i < scene.primitive_count; ++i) {
        const uint32_t medium = medium_of(scene.arrays[ARRAY_SURFACES][i].z & (MAX_MATERIALS - 1));
        if (medium == MEDIUM_SAME) continue;
        const uvec4* w = &scene.arrays[ARRAY_PRIMITIVES][size_t{i} * PRIMITIVE_WORDS];
        const dvec3 a = point_of(w[0]), b = point_of(w[1]), c = point_of(w[2]);
        Passage& passage = passages[medium];
        if (w[0].w == (PRIMITIVE_TAG | PRIMITIVE_SPHERE)) {
            cross_sphere(passage, o, a, b.x);
        } else if (w[0].w == (PRIMITIVE_TAG | PRIMITIVE_DISK)) {
            cross_disk(passage, o, a, b, c);
        } else {
            cross_triangle(passage, o, a, b, c);
            cross_triangle(passage, o, a, c, point_of(uvec4(w[0].w, w[1].w, w[2].w, 0)));
        }
    }

    std::vector<std::pair<uint32_t, Passage>> around;
    std::ranges::copy_if(passages, std::back_inserter(around),
                         [](const auto& p) { return p.second.exits > 0; });
    std::ranges::sort(around, {}, [](const auto& p) {
        return std::pair(-int(p.first >> MEDIUM_INDEX_BITS), p.second.nearest_exit);
    });
    around.resize(MEDIA_AT_ONCE);
    return uvec2(around[0].first | around[1].first << MEDIUM_BITS,
                 around[2].first | around[3].first << MEDIUM_BITS);
}

}  // namespace candela
