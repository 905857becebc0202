// See instancing.h. The bounds of rounding are in units of U, half the distance between floats around 1.
#include "gpu_scene/instancing.h"

#include <algorithm>
#include <cmath>

#include "gpu_scene/ray_error.h"

namespace candela {
namespace {

constexpr double U = 1.0 / 16777216.0;

using glm::dmat3;

dmat3 absolute(const dmat3& m) {
    return {abs(m[0]), abs(m[1]), abs(m[2])};
}

// |m| |m^-1|, by elements.
dmat3 condition(const dmat3& m) {
    return absolute(m) * absolute(inverse(m));
}

bool is_even_enough(const Transform& transform) {
    const dvec3 rows = condition(transform.linear()) * dvec3(1.0);
    return std::max({rows.x, rows.y, rows.z}) <= double{MAX_INSTANCE_CONDITION};  // False for NaN.
}

// The elements of the matrix of cofactors with each difference replaced by a sum, which bound the rounding of
// both.
dmat3 absolute_cofactors(const dmat3& rows) {
    const auto sums = [](dvec3 a, dvec3 b) {
        return dvec3(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
    };
    const dmat3 a = absolute(rows);
    return {sums(a[1], a[2]), sums(a[2], a[0]), sums(a[0], a[1])};
}

}  // namespace

Instancing choose_instances(const Scene& scene, const InstancingRule& rule) {
    std::vector<uint64_t> uses(scene.meshes.size());
    Instancing result;
    result.is_instance.resize(scene.shapes.size());
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        result.is_instance[i] = instance != nullptr && !shape.emission && is_even_enough(instance->transform);
        if (result.is_instance[i]) ++uses[instance->mesh];
    }
    const auto has_tree = [&](uint32_t mesh) {
        return uses[mesh] >= std::max(rule.min_uses, 1u) && !scene.meshes[mesh].triangles.empty() &&
               uses[mesh] * scene.meshes[mesh].triangles.size() >= rule.min_triangles;
    };
    for (uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        if (has_tree(mesh)) result.meshes.push_back(mesh);
    }
    for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
        if (!result.is_instance[i]) continue;
        result.is_instance[i] = has_tree(std::get<MeshInstance>(scene.shapes[i].geometry).mesh);
        if (result.is_instance[i]) result.shapes.push_back(i);
    }
    return result;
}

PlacedInstance place_instance(const Transform& transform, const SceneFrame& frame,
                              const SceneFrame& mesh_frame, std::span<const Box> boxes) {
    const dmat3 to_scene = (mesh_frame.unit / frame.unit) * transform.linear();
    const dmat3 rows = transpose(inverse(to_scene));
    PlacedInstance placed;
    for (glm::length_t i = 0; i < 3; ++i)
        placed.record.to_mesh[size_t(i)] = vec3(rows[i]);
    placed.record.centre = frame.point(transform.point(mesh_frame.origin));

    const dvec3 centre(placed.record.centre);
    dvec3 reach(0.0), lo(INFINITE), hi(-INFINITE);  // From the centre: in the mesh's space; of the box.
    for (const Box& box : boxes) {
        reach = max(reach, max(abs(dvec3(box.lo)), abs(dvec3(box.hi))));
        const dvec3 middle = to_scene * (0.5 * (dvec3(box.lo) + dvec3(box.hi)));
        const dvec3 half = absolute(to_scene) * (0.5 * (dvec3(box.hi) - dvec3(box.lo)));
        lo = min(lo, middle - half);
        hi = max(hi, middle + half);
    }

    // A point p = centre + vector_to_scene(q): 8 roundings of the numerator and 5 of the determinant, by
    // which it is divided; one of the sum.
    const dmat3 cofactors = absolute_cofactors(rows);
    const double det = std::abs(determinant(rows));
    const double det_terms = dot(abs(rows[0]), cofactors[0]);
    const dvec3 size = absolute(to_scene) * reach;
    const dvec3 of_point = (8.0 + 5.0 * det_terms / det) / det * (cofactors * reach) + abs(centre) + size;
    // A ray that begins there: one rounding of its origin, one of the difference to the centre, and three of
    // the products with to_mesh, on the way back to the scene.
    const dmat3 growth = condition(to_scene);
    const dvec3 of_origin = abs(centre) + 2.0 * size + 3.0 * (growth * size);
    placed.record.error = power_of_two_above(U * length(of_point + of_origin));

    // Rays from elsewhere are off by what INSTANCE_RAY_ERROR says for the coordinates of their origin, and by
    // as much for the centre's; and to_mesh itself is rounded.
    const dvec3 of_ray = abs(centre) + 6.0 * (growth * abs(centre)) + 4.0 * (growth * size);
    const dvec3 spare = 2.0 * U * (of_point + of_ray);
    placed.box = {vec3(centre + lo - spare), vec3(centre + hi + spare)};
    return placed;
}

glm::dmat3 map_to_mesh(const Instance& instance) {
    const auto& rows = instance.to_mesh;
    return transpose(dmat3(dvec3(rows[0]), dvec3(rows[1]), dvec3(rows[2])));
}

}  // namespace candela
