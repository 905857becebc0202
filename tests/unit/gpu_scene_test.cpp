// Scene -> records: which lights come out and how likely they are, the order of ids, normals and tables.
#include "render/gpu_scene.h"

#include <cstring>
#include <set>

#include <gtest/gtest.h>

#include "shared/bvh_node.h"
#include "shared/material.h"
#include "shared/primitive.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

vec3 floats(uvec4 word) {
    return std::bit_cast<vec3>(uvec3(word));
}

Light light(const GpuScene& gpu, uint32_t i) {
    const uvec4* w = &gpu.tables[gpu.table_starts.z + i * LIGHT_WORDS];
    return {
        w[0].w, floats(w[0]), floats(w[1]), floats(w[2]), floats(w[3]), w[1].w, std::bit_cast<float>(w[3].w)};
}

double area(const Light& l) {
    return double(length(cross(l.e1, l.e2))) * (l.kind == LIGHT_TRIANGLE ? 0.5 : 1.0);
}

// The triangle at that position in leaf order.
Primitive triangle(const GpuScene& gpu, uint32_t i) {
    const uvec4* w = &gpu.primitives[i * PRIMITIVE_WORDS];
    return {PRIMITIVE_TRIANGLE, floats(w[0]), floats(w[1]), floats(w[2]), w[0].w, w[1].w, w[2].w};
}

Shape emitter(Quad quad, vec3 radiance, bool two_sided = false) {
    return {
        .geometry = quad, .material = 0, .emission = Emission{.radiance = radiance, .two_sided = two_sided}};
}

Scene scene_of(std::vector<Shape> shapes) {
    Scene scene;
    add_diffuse(scene, vec3(0.25f, 0.5f, 0.75f));
    scene.shapes = std::move(shapes);
    return scene;
}

const Quad SQUARE = parallelogram(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));

TEST(GpuScene, AParallelogramIsOneLightForItsTwoTriangles) {
    const Quad slanted = parallelogram(vec3(100, -50, 3), vec3(1, 0.3f, 0.1f), vec3(-0.2f, 1.7f, 0.3f));
    for (const Quad& quad : {SQUARE, slanted}) {
        const GpuScene gpu = build_gpu_scene(scene_of({emitter(quad, vec3(2))}));
        ASSERT_EQ(gpu.light_count, 1u);
        ASSERT_EQ(gpu.primitive_count, 2u);
        const Light l = light(gpu, 0);
        EXPECT_EQ(l.kind, LIGHT_PARALLELOGRAM);
        EXPECT_EQ(l.p, quad.corners[0]);
        EXPECT_EQ(l.e1, quad.corners[1] - quad.corners[0]);
        EXPECT_EQ(l.e2, quad.corners[3] - quad.corners[0]);
        EXPECT_EQ(l.radiance, vec3(2));
        EXPECT_EQ(l.two_sided, 0u);
        EXPECT_NEAR(double(l.pdf_area) * area(l), 1.0, 1e-6);
        EXPECT_EQ(triangle(gpu, 0).light, 0u);
        EXPECT_EQ(triangle(gpu, 1).light, 0u);
    }
}

TEST(GpuScene, AnyOtherQuadIsTwoLightsThatCoverIt) {
    const Quad kite{{vec3(0, 0, 0), vec3(2, 0, 0), vec3(3, 3, 0), vec3(0, 2, 0)}};
    const GpuScene gpu = build_gpu_scene(scene_of({emitter(kite, vec3(1))}));
    ASSERT_EQ(gpu.light_count, 2u);
    double covered = 0.0, probability = 0.0;
    for (const uint32_t i : {0u, 1u}) {
        const Light l = light(gpu, i);
        EXPECT_EQ(l.kind, LIGHT_TRIANGLE);
        EXPECT_GT(cross(l.e1, l.e2).z, 0.0f) << "the light faces another way than the quad";
        covered += area(l);
        probability += area(l) * double(l.pdf_area);
        // Equal radiance: equal density everywhere.
        EXPECT_NEAR(l.pdf_area, 1.0 / 6.0, 1e-6);
    }
    EXPECT_NEAR(covered, 6.0, 1e-6);
    EXPECT_NEAR(probability, 1.0, 1e-6);
    std::set<uint32_t> lights;
    for (const uint32_t i : {0u, 1u}) {
        const Primitive t = triangle(gpu, i);
        const Light l = light(gpu, t.light);
        EXPECT_EQ(l.p, t.a);
        EXPECT_EQ(l.p + l.e1, t.b);
        EXPECT_EQ(l.p + l.e2, t.c);
        lights.insert(t.light);
    }
    EXPECT_EQ(lights.size(), 2u);
}

TEST(GpuScene, LightsAreChosenByAreaLuminanceAndSides) {
    const Quad large = parallelogram(vec3(0), vec3(3, 0, 0), vec3(0, 2, 0));
    TriangleMesh mesh{.positions = {vec3(0), vec3(2, 0, 0), vec3(0, 2, 0), vec3(0, 0, 4)},
                      .normals = {},
                      .triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)}};
    const GpuScene gpu = build_gpu_scene(scene_of({
        emitter(SQUARE, vec3(1)),
        emitter(large, vec3(0, 1, 0)),
        emitter(SQUARE, vec3(0.5f), true),
        {.geometry = mesh, .material = 0, .emission = Emission{.radiance = vec3(3), .two_sided = false}},
    }));
    const std::vector<double> powers{1.0, 6.0 * 0.7152, 1.0, 3.0 * 2.0, 3.0 * 4.0};
    ASSERT_EQ(gpu.light_count, powers.size());
    double total = 0.0, probability = 0.0;
    for (const double power : powers)
        total += power;
    for (uint32_t i = 0; i < gpu.light_count; ++i) {
        const Light l = light(gpu, i);
        const double pmf = std::bit_cast<float>(gpu.tables[gpu.table_starts.w + i].z);
        EXPECT_NEAR(pmf, powers[i] / total, 1e-6) << i;
        EXPECT_NEAR(double(l.pdf_area) * area(l), pmf, 1e-6) << i;
        EXPECT_EQ(l.two_sided, i == 2 ? 1u : 0u);
        probability += double(l.pdf_area) * area(l);
    }
    EXPECT_NEAR(probability, 1.0, 1e-6);
}

TEST(GpuScene, EmittersWithoutAreaOrRadianceAreHarmless) {
    const Quad flat = parallelogram(vec3(0), vec3(1, 0, 0), vec3(2, 0, 0));
    EXPECT_EQ(build_gpu_scene(scene_of({emitter(flat, vec3(1))})).light_count, 0u);
    EXPECT_EQ(build_gpu_scene(scene_of({emitter(SQUARE, vec3(0))})).light_count, 0u);
    const GpuScene gpu = build_gpu_scene(scene_of({emitter(SQUARE, vec3(0)), emitter(SQUARE, vec3(1))}));
    for (uint32_t i = 0; i < gpu.light_count; ++i)
        EXPECT_TRUE(std::isfinite(light(gpu, i).pdf_area));
}

TEST(GpuScene, IdsFollowTheOrderOfTheSceneAndEveryTriangleIsThere) {
    const TriangleMesh mesh = triangle_soup(100, 0.3f, 1);
    Scene scene = scene_of({{.geometry = SQUARE, .material = 0, .emission = {}}});
    add_diffuse(scene, vec3(1));
    scene.shapes.push_back({.geometry = mesh, .material = 1, .emission = {}});
    const GpuScene gpu = build_gpu_scene(scene);
    ASSERT_EQ(gpu.primitive_count, 102u);
    std::set<uint32_t> ids;
    for (uint32_t i = 0; i < gpu.primitive_count; ++i) {
        const Primitive t = triangle(gpu, i);
        ids.insert(t.id);
        EXPECT_EQ(t.light, NO_LIGHT);
        EXPECT_EQ(t.material, t.id < 2 ? 0u : 1u);
        if (t.id < 2) {
            EXPECT_EQ(t.a, SQUARE.corners[0]);
            EXPECT_EQ(t.b, SQUARE.corners[t.id + 1]);
            EXPECT_EQ(t.c, SQUARE.corners[t.id + 2]);
        } else {
            const uvec3 corners = mesh.triangles[t.id - 2];
            EXPECT_EQ(t.a, mesh.positions[corners.x]);
            EXPECT_EQ(t.b, mesh.positions[corners.y]);
            EXPECT_EQ(t.c, mesh.positions[corners.z]);
        }
    }
    EXPECT_EQ(ids.size(), 102u);
    EXPECT_EQ(*ids.rbegin(), 101u);
}

TEST(GpuScene, OnlySmoothMeshesHaveNormals) {
    EXPECT_FALSE(
        build_gpu_scene(scene_of({{.geometry = SQUARE, .material = 0, .emission = {}}})).has_normals);

    TriangleMesh smooth = sphere_mesh(4, 6);
    smooth.normals = smooth.positions;
    const GpuScene gpu = build_gpu_scene(scene_of({{.geometry = SQUARE, .material = 0, .emission = {}},
                                                   {.geometry = smooth, .material = 0, .emission = {}},
                                                   {.geometry = SQUARE, .material = 0, .emission = {}}}));
    EXPECT_TRUE(gpu.has_normals);
    for (uint32_t i = 0; i < gpu.primitive_count; ++i) {
        const Primitive t = triangle(gpu, i);
        const uvec4 normals = gpu.tables[gpu.table_starts.x + i * NORMALS_WORDS];
        const bool of_the_sphere = t.id >= 2 && t.id < 2 + smooth.triangles.size();
        EXPECT_EQ(normals.w, of_the_sphere ? 1u : 0u);
        if (of_the_sphere) {
            EXPECT_EQ(normals, pack_normals(t.a, t.b, t.c)[0]);
        }
    }
}

TEST(GpuScene, TablesFollowEachOther) {
    Scene scene = scene_of({emitter(SQUARE, vec3(1))});
    add_diffuse(scene, vec3(1));
    const GpuScene gpu = build_gpu_scene(scene);
    EXPECT_EQ(gpu.table_starts, uvec4(0, 0, 2 * MATERIAL_WORDS, 2 * MATERIAL_WORDS + LIGHT_WORDS));
    EXPECT_EQ(gpu.tables.size(), 2 * MATERIAL_WORDS + LIGHT_WORDS + ALIAS_WORDS);
    EXPECT_EQ(gpu.tables[0].x, MATERIAL_DIFFUSE);
    EXPECT_EQ(std::bit_cast<vec3>(uvec3(gpu.tables[0].y, gpu.tables[0].z, gpu.tables[0].w)),
              vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(gpu.bytes(), (gpu.nodes.size() + gpu.primitives.size() + gpu.tables.size()) * 16);
}

TEST(GpuScene, AnEmptySceneIsARootWithoutChildren) {
    const GpuScene gpu = build_gpu_scene(scene_of({}));
    EXPECT_EQ(gpu.primitive_count, 0u);
    EXPECT_EQ(gpu.light_count, 0u);
    EXPECT_EQ(gpu.nodes.size(), BVH_NODE_WORDS);
}

}  // namespace
}  // namespace candela
