// The choice of meshes with their own trees, their instances' records, and the arrays.
#include "gpu_scene/instancing.h"

#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "base/error.h"
#include "gpu_scene/gpu_scene.h"
#include "probe/random.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

Transform moved(dvec3 shift, dvec3 scale = dvec3(1)) {
    Transform transform;
    transform.append(glm::scale(glm::dmat4(1.0), scale));
    transform.append(glm::translate(glm::dmat4(1.0), shift));
    return transform;
}

// Copies of the mesh, one unit apart, besides those that the scene has.
void add_copies(Scene& scene, TriangleMesh mesh, int count) {
    scene.meshes.push_back(std::move(mesh));
    for (int i = 0; i < count; ++i) {
        scene.shapes.push_back(
            {.geometry = MeshInstance{uint32_t(scene.meshes.size() - 1), moved(dvec3(3 * i, 0, 0))},
             .material = 0,
             .emission = {}});
    }
}

Scene empty_scene() {
    Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 1.0f);
    add_diffuse(scene, vec3(0.5f));
    return scene;
}

TEST(Instancing, MeshesThatAreUsedOnceOrAreTinyAreBaked) {
    const InstancingRule rule{.min_uses = 2, .min_triangles = 1000};
    Scene scene = empty_scene();
    add_copies(scene, triangle_soup(5000, 0.1f, 1), 1);
    add_copies(scene, triangle_soup(499, 0.1f, 1), 2);
    EXPECT_TRUE(choose_instances(scene, rule).shapes.empty());
    add_copies(scene, triangle_soup(500, 0.1f, 1), 2);
    const Instancing chosen = choose_instances(scene, rule);
    EXPECT_EQ(chosen.shapes, (std::vector<uint32_t>{3, 4}));
    EXPECT_EQ(chosen.meshes, std::vector<ShownMesh>{{2}});
    EXPECT_EQ(chosen.shown, (std::vector<ShownMesh>{{2}, {2}}));
    EXPECT_EQ(chosen.is_instance, (std::vector{false, false, false, true, true}));
}

TEST(Instancing, WhatEmitsAloneOrIsShearedTooFarIsBaked) {
    const InstancingRule rule{.min_uses = 2, .min_triangles = 1};
    Scene scene = empty_scene();
    add_copies(scene, triangle_soup(10, 0.1f, 1), 4);
    scene.shapes[1].emission = Emission{vec3(1), false};
    // The mesh's y becomes longer by far along x; scaled unevenly first, nothing of the kind happens.
    glm::dmat4 shear(1.0);
    shear[1][0] = 20.0;
    std::get<MeshInstance>(scene.shapes[2].geometry).transform.append(shear);
    scene.shapes[3].geometry = MeshInstance{0, moved(dvec3(0), dvec3(1e-3, 1, 1e3))};
    EXPECT_EQ(choose_instances(scene, rule).shapes, (std::vector<uint32_t>{0, 3}));
}

// Shapes that emit alike, of one material, are instances of one mesh; but not one that is scaled unevenly.
TEST(Instancing, ShapesThatEmitAlikeShareTheirLights) {
    Scene scene = empty_scene();
    const uint32_t other = add_diffuse(scene, vec3(0.25f));
    add_copies(scene, triangle_soup(10, 0.1f, 1), 9);
    for (const size_t i : {0, 1, 2, 3, 4, 5, 6})
        scene.shapes[i].emission = Emission{vec3(1, 2, 3), false};
    scene.shapes[1].geometry = MeshInstance{0, moved(dvec3(0), dvec3(-2, 2, 2))};
    scene.shapes[2].geometry = MeshInstance{0, moved(dvec3(0), dvec3(1, 1, 1.0001))};
    scene.shapes[3].material = scene.shapes[4].material = other;
    scene.shapes[5].emission->two_sided = true;
    scene.shapes[6].emission->radiance.factor.z = 4.0f;
    const Instancing chosen = choose_instances(scene, {.min_uses = 2, .min_triangles = 1});
    EXPECT_EQ(chosen.shapes, (std::vector<uint32_t>{0, 1, 3, 4, 7, 8}));
    EXPECT_EQ(chosen.shown, (std::vector<ShownMesh>{{0, 0}, {0, 0}, {0, 3}, {0, 3}, {0}, {0}}));
    EXPECT_EQ(chosen.meshes, (std::vector<ShownMesh>{{0, 0}, {0, 3}, {0}}));
}

// The kernel's arithmetic, in the order of shaders/scene/instance.glsl.
vec3 vector_to_scene(const Instance& i, vec3 v) {
    const auto& [r0, r1, r2] = i.to_mesh;
    return (v.x * cross(r1, r2) + v.y * cross(r2, r0) + v.z * cross(r0, r1)) / dot(r0, cross(r1, r2));
}

vec3 point_to_mesh(const Instance& i, vec3 p) {
    const vec3 v = p - i.centre;
    return {dot(i.to_mesh[0], v), dot(i.to_mesh[1], v), dot(i.to_mesh[2], v)};
}

// A turned, scaled, sheared and perhaps mirrored instance, somewhere in the frame.
Transform random_transform(Random& random) {
    const auto signed_unit = [&] { return 2.0 * double(random.unit()) - 1.0; };
    Transform transform;
    glm::dmat4 shear(1.0);
    shear[1][0] = signed_unit();
    shear[2][0] = signed_unit();
    transform.append(shear);
    const double size = std::pow(10.0, 3.0 * signed_unit());
    transform.append(glm::scale(glm::dmat4(1.0), size * dvec3(random.bits() % 2 == 0 ? 1 : -1, 1.5, 0.3)));
    transform.append(glm::rotate(glm::dmat4(1.0), 3.0 * signed_unit(), dvec3(random.direction())));
    transform.append(glm::translate(glm::dmat4(1.0), 1000.0 * dvec3(random.cube())));
    return transform;
}

TEST(Instancing, RecordsBringPointsToTheSceneAndBackWithinTheirError) {
    Random random(3);
    const SceneFrame frame{.origin = dvec3(100, -50, 20), .unit = 2048.0};
    const SceneFrame mesh_frame{.origin = dvec3(3, 4, 5), .unit = 2.0};
    const std::array boxes{Box{vec3(-0.5f), vec3(0.2f)}, Box{vec3(-0.1f), vec3(0.45f, 0.5f, 0.1f)}};
    double worst = 0.0;
    for (int k = 0; k < 2000; ++k) {
        const Transform transform = random_transform(random);
        const PlacedInstance placed = place_instance(transform, frame, mesh_frame, boxes);
        const Instance& record = placed.record;
        ASSERT_GT(record.error, 0.0f);
        for (int i = 0; i < 20; ++i) {
            const Box& box = boxes[size_t(i % 2)];
            const vec3 q = mix(box.lo, box.hi, 0.5f * random.cube() + 0.5f);
            const dvec3 exact =
                (transform.point(mesh_frame.origin + mesh_frame.unit * dvec3(q)) - frame.origin) / frame.unit;
            ASSERT_TRUE(all(lessThanEqual(dvec3(placed.box.lo), exact)));
            ASSERT_TRUE(all(lessThanEqual(exact, dvec3(placed.box.hi))));
            // The kernel's point, and where a ray that begins there begins in the mesh's space, seen from the
            // scene again.
            const vec3 p = record.centre + vector_to_scene(record, q);
            const dvec3 off = dvec3(point_to_mesh(record, p)) - dvec3(q);
            const dvec3 in_scene = transform.linear() * off * (mesh_frame.unit / frame.unit);
            worst = std::max(worst, length(in_scene) / double(record.error));
            ASSERT_LT(length(in_scene), double(record.error));
            ASSERT_LT(length(dvec3(p) - exact), 2.0 * double(record.error));
        }
    }
    EXPECT_GT(worst, 0.02) << "the bound is far from what happens";
}

TEST(Instancing, AMeshIsStoredOnce) {
    Scene scene = empty_scene();
    const TriangleMesh mesh = sphere_mesh(24, 32);
    add_copies(scene, mesh, 100);
    const uint32_t red = add_diffuse(scene, vec3(0.9f, 0.1f, 0.1f));
    scene.shapes[7].material = red;
    add_shape(scene, parallelogram(vec3(-9, -1, 9), vec3(400, 0, 0), vec3(0, 0, -18)), 0);
    const GpuScene one = build_gpu_scene(scene_of_mesh(mesh));
    const GpuScene gpu = build_gpu_scene(scene, choose_frame(scene), {.min_uses = 2, .min_triangles = 1});
    EXPECT_EQ(gpu.instances.size(), 100u);
    EXPECT_EQ(gpu.baked_primitives, 1u);
    EXPECT_EQ(gpu.primitive_count, one.primitive_count + 1);
    EXPECT_EQ(gpu.id_count, 100 * one.id_count + 2);
    ASSERT_EQ(gpu.meshes.size(), 1u);
    EXPECT_EQ(gpu.meshes[0].first_primitive, 1u);
    EXPECT_EQ(gpu.meshes[0].primitives, one.primitive_count);
    EXPECT_EQ(gpu.meshes[0].triangles, mesh.triangles.size());
    EXPECT_LT(gpu.bytes(), one.bytes() + 100 * 100 + 1000);  // 100 bytes an instance.
    EXPECT_GT(gpu.bvh_depth, one.bvh_depth + 1);

    size_t reds = 0;
    for (const InstancePlace& place : gpu.instances) {
        const uvec4* w = &gpu.arrays[ARRAY_NODES][size_t{place.node} * BVH_NODE_WORDS];
        const Instance record = instance_unpack(w[0], w[1], w[2], w[3]);
        reds += record.material == red;
        // The tree of the mesh begins where the record says.
        const uvec4* root = &gpu.arrays[ARRAY_NODES][size_t{record.root} * BVH_NODE_WORDS];
        EXPECT_FALSE(is_instance(bvh_node_unpack(root[0], root[1], root[2], root[3])));
    }
    EXPECT_EQ(reds, 1u);

    // What is baked instead has the same surfaces.
    const GpuScene baked =
        build_gpu_scene(scene, choose_frame(scene), {.min_uses = ~0u, .min_triangles = ~0u});
    EXPECT_TRUE(baked.instances.empty());
    EXPECT_EQ(baked.id_count, gpu.id_count);
}

TEST(Instancing, TheLightsOfLampsAreStoredOnce) {
    constexpr uint32_t LAMPS = 1000;
    Scene scene = empty_scene();
    const TriangleMesh mesh = sphere_mesh(10, 11);
    const auto lights = uint32_t(mesh.triangles.size());
    add_copies(scene, mesh, LAMPS);
    for (Shape& shape : scene.shapes)
        shape.emission = Emission{vec3(1), false};
    add_shape(scene, parallelogram(vec3(-9, -1, 9), vec3(400, 0, 0), vec3(0, 0, -18)), 0,
              Emission{vec3(1), false});
    const GpuScene gpu = build_gpu_scene(scene);
    EXPECT_EQ(gpu.instances.size(), LAMPS);
    EXPECT_EQ(gpu.primitive_count, lights + 1);
    EXPECT_EQ(gpu.light_groups.placed, LAMPS + 1);
    EXPECT_EQ(gpu.light_count, LAMPS + 1 + lights);
    EXPECT_EQ(gpu.arrays[ARRAY_LIGHTS].size(), (LAMPS + 1 + lights) * LIGHT_WORDS);
    EXPECT_EQ(gpu.arrays[ARRAY_LIGHT_ALIAS].size(), (LAMPS + 1 + lights + 1) / 2);
    EXPECT_EQ(gpu.arrays[ARRAY_LIGHT_TRAILS].size(), (LAMPS + 1 + lights + 3) / 4);
    // A node has at least two children.
    EXPECT_LE(gpu.arrays[ARRAY_LIGHT_TREE].size(),
              (LAMPS + 1 + lights) * LIGHT_TREE_WIDTH * LIGHT_TREE_WORDS);
    for (const InstancePlace& place : gpu.instances) {
        const uvec4* lamp = &gpu.arrays[ARRAY_LIGHTS][size_t{instance_at(gpu, place).lamp} * LIGHT_WORDS];
        EXPECT_EQ(lamp[0], uvec4(place.node, lamp[0].y, LAMPS + 1, LIGHT_LAMP));
        EXPECT_EQ(lamp[1].x, lights);
    }
}

TEST(Instancing, TooManyTrianglesThatEmitAreAnErrorBeforeTheyAreMade) {
    Scene scene = empty_scene();
    add_copies(scene, triangle_soup(1000, 0.1f, 1), 16778);
    EXPECT_NO_THROW(build_gpu_scene(scene));
    for (Shape& shape : scene.shapes)
        shape.emission = Emission{vec3(1), false};
    EXPECT_EQ(build_gpu_scene(scene).light_count, 16778u + 1000u);
    for (Shape& shape : scene.shapes)
        shape.geometry = MeshInstance{0, moved(dvec3(0), dvec3(1, 1, 2))};
    try {
        build_gpu_scene(scene);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(
            error.what(),
            "the scene has 16778000 triangles that emit, each of which is a light, but at most 16777216 "
            "are possible; let fewer copies of a mesh emit, or simpler ones");
    }
}

}  // namespace
}  // namespace candela
