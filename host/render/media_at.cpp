// See media_at.h.
#include "render/media_at.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <vector>

#include "shared/instance.h"
#include "shared/material.h"
#include "shared/primitive.h"

namespace candela {
namespace {

// Upwards, so that it meets the surface of a lake; not along an axis or in a plane in which scenes are likely
// to have edges.
const dvec3 DIRECTION = normalize(dvec3(0.123456, 0.978, 0.0765432));

// One medium along a ray.
struct Passage {
    int exits = 0;  // Exits minus entries.
    double nearest_exit = INFINITE;
};

// Counts where the ray from `o` along DIRECTION crosses a primitive: at `t`, out of the solid or into it.
void cross(Passage& passage, double t, bool out) {
    if (t <= 0.0) return;
    passage.exits += out ? 1 : -1;
    if (out) passage.nearest_exit = std::min(passage.nearest_exit, t);
}

// Ref: Moeller and Trumbore 1997, Fast, Minimum Storage Ray/Triangle Intersection.
void cross_triangle(Passage& passage, dvec3 o, dvec3 d, dvec3 a, dvec3 b, dvec3 c) {
    const dvec3 e1 = b - a, e2 = c - a, p = glm::cross(d, e2), s = o - a, q = glm::cross(s, e1);
    const double det = dot(e1, p);
    const double u = dot(s, p) / det, v = dot(d, q) / det;
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

// Counts where the ray from o along d crosses primitive i; a sphere or disk only along DIRECTION.
void cross_primitive(Passage& passage, const GpuScene& scene, uint32_t i, dvec3 o, dvec3 d) {
    const uvec4* w = &scene.arrays[ARRAY_PRIMITIVES][size_t{i} * PRIMITIVE_WORDS];
    const dvec3 a = point_of(w[0]), b = point_of(w[1]), c = point_of(w[2]);
    if (w[0].w == (PRIMITIVE_TAG | PRIMITIVE_SPHERE)) {
        cross_sphere(passage, o, a, b.x);
    } else if (w[0].w == (PRIMITIVE_TAG | PRIMITIVE_DISK)) {
        cross_disk(passage, o, a, b, c);
    } else {
        cross_triangle(passage, o, d, a, b, c);
        cross_triangle(passage, o, d, a, c, point_of(uvec4(w[0].w, w[1].w, w[2].w, 0)));
    }
}

PackedBvhNode node_at(const GpuScene& scene, uint32_t i) {
    PackedBvhNode node;
    std::copy_n(&scene.arrays[ARRAY_NODES][size_t{i} * BVH_NODE_WORDS], BVH_NODE_WORDS, node.begin());
    return node;
}

// Whether the line through o along d meets a box around the children of that node.
bool meets_children(const GpuScene& scene, uint32_t i, dvec3 o, dvec3 d) {
    const BvhNode node = unpack(node_at(scene, i));
    Box box;
    for (uint32_t k = 0; k < bvh_child_count(node); ++k)
        box.extend(child_box(node, k));
    // The axes that may separate a line from a box are perpendicular to the line and to an edge.
    const dvec3 middle = 0.5 * (dvec3(box.lo) + dvec3(box.hi)), half = dvec3(box.hi) - middle;
    const dvec3 distance = abs(glm::cross(d, middle - o)), a = abs(d);
    return distance.x <= half.y * a.z + half.z * a.y && distance.y <= half.z * a.x + half.x * a.z &&
           distance.z <= half.x * a.y + half.y * a.x;
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
    for (uint32_t i = 0; i < scene.baked_primitives; ++i) {
        const uint32_t medium = medium_of(scene.arrays[ARRAY_SURFACES][i].z & (MAX_MATERIALS - 1));
        if (medium != MEDIUM_SAME) cross_primitive(passages[medium], scene, i, o, DIRECTION);
    }
    for (const InstancePlace& place : scene.instances) {
        const Instance instance = instance_at(scene, place);
        const uint32_t medium = medium_of(instance.material);
        if (medium == MEDIUM_SAME) continue;
        const glm::dmat3 to_mesh = map_to_mesh(instance);
        const dvec3 from = to_mesh * (o - dvec3(instance.centre)), along = to_mesh * DIRECTION;
        if (!meets_children(scene, instance.root, from, along)) continue;
        const auto& [first, count, triangles] = scene.meshes[place.mesh];
        for (uint32_t i = 0; i < count; ++i)
            cross_primitive(passages[medium], scene, first + i, from, along);
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
