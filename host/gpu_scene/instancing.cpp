// See instancing.h. The bounds of rounding are in units of U, half the distance between floats around 1.
#include "gpu_scene/instancing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

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

// Whether the transform turns, mirrors and scales, but within the rounding of files' floats does not shear.
bool is_similarity(const Transform& transform) {
    constexpr double TOLERANCE = 1e-5;
    const dmat3 linear = transform.linear();
    const dmat3 products = transpose(linear) * linear;
    const double mean = (products[0][0] + products[1][1] + products[2][2]) / 3.0;
    double off = 0.0;
    for (const int i : {0, 1, 2}) {
        for (const int k : {0, 1, 2})
            off = std::max(off, std::abs(products[i][k] - (i == k ? mean : 0.0)));
    }
    return off <= TOLERANCE * mean;  // False for NaN.
}

bool emits_alike(const Shape& a, const Shape& b) {
    return a.emission == b.emission && a.beam == b.beam;
}

// Tells which shapes emit alike.
class Emitters {
  public:
    explicit Emitters(const Scene& scene) : scene_(scene) {}

    ShownMesh shown_by(uint32_t index, uint32_t mesh) {
        const Shape& shape = scene_.shapes[index];
        if (!shape.emission) return {mesh};
        const vec3 factor = shape.emission->radiance.factor;
        // All but textures, of which there are few.
        const Kind kind(mesh, shape.material, factor.x, factor.y, factor.z, shape.emission->two_sided);
        std::vector<uint32_t>& known = first_[kind];
        const auto same = std::ranges::find_if(
            known, [&](uint32_t other) { return emits_alike(scene_.shapes[other], shape); });
        if (same != known.end()) return {mesh, *same};
        known.push_back(index);
        return {mesh, index};
    }

  private:
    using Kind = std::tuple<uint32_t, uint32_t, float, float, float, bool>;

    const Scene& scene_;
    std::map<Kind, std::vector<uint32_t>> first_;
};

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
    std::map<ShownMesh, uint64_t> uses;
    std::set<ShownMesh> moving;
    std::vector<std::pair<uint32_t, ShownMesh>> possible;
    Emitters emitters(scene);
    for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance == nullptr || !is_even_enough(instance->transform)) continue;
        if (shape.emission && !is_similarity(instance->transform)) continue;
        possible.emplace_back(i, emitters.shown_by(i, instance->mesh));
        ++uses[possible.back().second];
        if (scene.motion && scene.motion->moves_shape(i)) moving.insert(possible.back().second);
    }
    const auto has_tree = [&](const ShownMesh& shown) {
        const std::vector<uvec3>& triangles = scene.meshes[shown.mesh].triangles;
        const uint64_t count = uses.at(shown);
        if (moving.contains(shown)) return true;
        return count >= std::max(rule.min_uses, 1u) && !triangles.empty() &&
               count * triangles.size() >= rule.min_triangles;
    };
    Instancing result;
    for (const auto& [shown, count] : uses) {
        if (has_tree(shown)) result.meshes.push_back(shown);
    }
    result.is_instance.resize(scene.shapes.size());
    for (const auto& [shape, shown] : possible) {
        if (!has_tree(shown)) continue;
        result.is_instance[shape] = true;
        result.shapes.push_back(shape);
        result.shown.push_back(shown);
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
