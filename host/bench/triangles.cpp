// See triangles.h.
#include "bench/triangles.h"

#include <algorithm>
#include <cassert>
#include <cstdio>

#include "shared/primitive.h"

namespace candela {
namespace {

// The triangles of a range of primitives, by id.
std::vector<BenchTriangle> triangles_in(const GpuScene& scene, uint32_t first, uint32_t count) {
    std::vector<BenchTriangle> triangles;
    const auto put = [&](uint32_t id, const BenchTriangle& triangle) {
        if (triangles.size() <= id) triangles.resize(size_t{id} + 1);
        triangles[id] = triangle;
    };
    for (size_t i = first; i < size_t{first} + count; ++i) {
        const uvec4* const w = &scene.arrays[ARRAY_PRIMITIVES][i * PRIMITIVE_WORDS];
        const uvec4 surface = scene.arrays[ARRAY_SURFACES][i * SURFACE_WORDS];
        const vec3 a = uintBitsToFloat(uvec3(w[0])), c = uintBitsToFloat(uvec3(w[2]));
        put(surface.x, {a, uintBitsToFloat(uvec3(w[1])), c});
        if (surface.y != surface.x) put(surface.y, {a, c, uintBitsToFloat(uvec3(w[0].w, w[1].w, w[2].w))});
    }
    return triangles;
}

// In the frame of the scene.
vec3 placed(const BenchTriangles::Instance& instance, vec3 p) {
    return vec3(dvec3(instance.centre) + instance.to_scene * dvec3(p));
}

Box box_around(const std::vector<BenchTriangle>& triangles) {
    Box box;
    for (const BenchTriangle& t : triangles) {
        for (const vec3 p : {t.a, t.b, t.c})
            box.extend(p);
    }
    return box;
}

}  // namespace

BenchTriangles::BenchTriangles(const GpuScene& scene)
    : baked_(triangles_in(scene, 0, scene.baked_primitives)),
      count_(baked_.size()),
      bounds_(box_around(baked_)) {
    assert(scene.primitives_present == 1u << PRIMITIVE_TRIANGLES);
    std::vector<Box> boxes;
    for (const InstancedMesh& mesh : scene.meshes) {
        meshes_.push_back(triangles_in(scene, mesh.first_primitive, mesh.primitives));
        boxes.push_back(box_around(meshes_.back()));
    }
    for (const InstancePlace& place : scene.instances) {
        const candela::Instance record = instance_at(scene, place);
        instances_.push_back({place.mesh, record.first_id, inverse(map_to_mesh(record)), record.centre});
        count_ += meshes_[place.mesh].size();
        const Box& box = boxes[place.mesh];
        for (uint32_t corner = 0; corner < 8; ++corner)
            bounds_.extend(placed(instances_.back(),
                                  mix(box.lo, box.hi, vec3(corner & 1, corner >> 1 & 1, corner >> 2))));
    }
    std::ranges::sort(instances_, {}, &Instance::first_id);
}

BenchTriangle BenchTriangles::at(uint32_t id) const {
    if (id < baked_.size()) return baked_[id];
    const auto after = std::ranges::upper_bound(instances_, id, {}, &Instance::first_id);
    assert(after != instances_.begin());
    const Instance& instance = *std::prev(after);
    const auto& [a, b, c] = meshes_[instance.mesh].at(id - instance.first_id);
    return {placed(instance, a), placed(instance, b), placed(instance, c)};
}

std::string triangles_text(uint64_t triangles) {
    const auto text = [&](double unit, const char* letter) {
        char digits[40];
        std::snprintf(digits, sizeof digits, "%.3g %s triangles", double(triangles) / unit, letter);
        return std::string(digits);
    };
    // From 999 500 on, three digits would round to 1000 k.
    if (triangles >= 999'500'000) return text(1e9, "G");
    if (triangles >= 999'500) return text(1e6, "M");
    if (triangles >= 1000) return text(1e3, "k");
    return std::to_string(triangles) + " triangles";
}

}  // namespace candela
