// Small scenes for the tests of what a device reads of them, and its records read back.
#pragma once

#include <bit>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_scene/gpu_scene.h"
#include "shared/light.h"
#include "shared/primitive.h"
#include "support/scene_builders.h"

namespace candela {

inline vec3 floats(uvec4 word) {
    return std::bit_cast<vec3>(uvec3(word));
}

inline LightRecord light(const GpuScene& gpu, uint32_t i) {
    const uvec4* w = &gpu.arrays[ARRAY_LIGHTS][i * LIGHT_WORDS];
    return {.kind = w[0].w & LIGHT_KINDS,
            .p = floats(w[0]),
            .e1 = floats(w[1]),
            .e2 = floats(w[2]),
            .radiance = floats(w[3]),
            .spread = std::bit_cast<float>(w[0].w & ~LIGHT_KINDS),
            .two_sided = w[1].w >> 31,
            .pdf_area = std::bit_cast<float>(w[3].w),
            .pmf = std::bit_cast<float>(w[2].w),
            .error = std::bit_cast<float>(w[1].w & 0x7FFFFFFFu)};
}

// Entry i of an alias table.
inline AliasEntry entry(const std::vector<uvec4>& table, uint32_t i) {
    const uvec4 w = table[i / 2];
    return i % 2 == 0 ? AliasEntry{w.x, w.y} : AliasEntry{w.z, w.w};
}

// The probability of each light as a shader draws it: column i is kept for fractions below its threshold /
// 2^32.
inline std::vector<double> light_probabilities(const GpuScene& gpu) {
    const LightGroups& groups = gpu.light_groups;
    const double suns = groups.sun_fraction * 0x1p-31, sky = groups.sky_fraction * 0x1p-31;
    std::vector<double> probability(gpu.light_count);
    const auto add_table = [&](uint32_t first, uint32_t count, double fraction) {
        for (uint32_t i = 0; i < count; ++i) {
            const AliasEntry e = entry(gpu.arrays[ARRAY_LIGHT_ALIAS], first + i);
            const double kept = double(e.threshold) * 0x1p-32;
            probability[first + i] += fraction * kept / count;
            probability[first + e.alias] += fraction * (1.0 - kept) / count;
        }
    };
    add_table(0, groups.placed, 1.0 - suns - sky);
    add_table(groups.placed, groups.suns, suns);
    if (gpu.light_count > groups.placed + groups.suns) probability.back() = sky;
    return probability;
}

inline double area(const LightRecord& l) {
    return double(length(cross(l.e1, l.e2))) * (l.kind == LIGHT_TRIANGLE ? 0.5 : 1.0);
}

// A triangle of the scene, and what its surface says.
struct Triangle {
    vec3 a, b, c;
    Surface surface;
    uvec3 normals{0};  // Packed; 0 if it has none.
};

// All triangles by id, from the primitives in leaf order; ids are 0, 1, 2 ...
inline std::vector<Triangle> triangles(const GpuScene& gpu) {
    std::map<uint32_t, Triangle> by_id;
    for (uint32_t i = 0; i < gpu.primitive_count; ++i) {
        const uvec4* w = &gpu.arrays[ARRAY_PRIMITIVES][i * PRIMITIVE_WORDS];
        const uvec4 s = gpu.arrays[ARRAY_SURFACES][i];
        const Surface surface{uvec2(s.x, s.y),
                              s.z & (MAX_MATERIALS - 1),
                              s.z >> 31,
                              s.w,
                              std::bit_cast<float>(s.z & SURFACE_ERROR_BITS),
                              s.z >> 22 & 1};
        const vec3 d = std::bit_cast<vec3>(uvec3(w[0].w, w[1].w, w[2].w));
        const uvec4 n = gpu.has_normals ? gpu.arrays[ARRAY_NORMALS][i] : uvec4(0);
        EXPECT_TRUE(
            by_id.insert({s.x, {floats(w[0]), floats(w[1]), floats(w[2]), surface, uvec3(n)}}).second);
        if (s.y == s.x) {
            EXPECT_EQ(d, floats(w[2])) << "a triangle alone repeats its last vertex";
            continue;
        }
        const uvec3 second(n.x, n.z, n.w);
        EXPECT_TRUE(by_id.insert({s.y, {floats(w[0]), floats(w[2]), d, surface, second}}).second);
    }
    EXPECT_EQ(by_id.size(), gpu.id_count);
    std::vector<Triangle> all;
    for (const auto& [id, triangle] : by_id) {
        EXPECT_EQ(id, all.size());
        all.push_back(triangle);
    }
    return all;
}

// Whether the corners are these, in this order, starting with any of them.
inline bool same_corners(const Triangle& t, vec3 a, vec3 b, vec3 c) {
    const auto is = [&](vec3 x, vec3 y, vec3 z) { return t.a == x && t.b == y && t.c == z; };
    return is(a, b, c) || is(b, c, a) || is(c, a, b);
}

inline Shape emitter(Quad quad, vec3 radiance, bool two_sided = false) {
    return {
        .geometry = quad, .material = 0, .emission = Emission{.radiance = radiance, .two_sided = two_sided}};
}

inline Scene scene_of_shapes(std::vector<Shape> shapes) {
    Scene scene;
    add_diffuse(scene, vec3(0.25f, 0.5f, 0.75f));
    scene.shapes = std::move(shapes);
    return scene;
}

inline const Quad SQUARE = parallelogram(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));

}  // namespace candela
