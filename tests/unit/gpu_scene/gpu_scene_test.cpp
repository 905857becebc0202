// Scene -> records: which lights come out and how likely they are, the order of ids, normals and tables.
#include "gpu_scene/gpu_scene.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>

#include <gtest/gtest.h>

#include "shared/bvh_node.h"
#include "shared/material.h"
#include "shared/principled.h"
#include "unit/gpu_scene/packed_scene.h"

namespace candela {
namespace {

TEST(GpuScene, AParallelogramIsOneLightForItsTwoTriangles) {
    const Quad slanted = parallelogram(vec3(100, -50, 3), vec3(1, 0.3f, 0.1f), vec3(-0.2f, 1.7f, 0.3f));
    for (const Quad& quad : {SQUARE, slanted}) {
        const GpuScene gpu = build_gpu_scene(scene_of_shapes({emitter(quad, vec3(2))}), SceneFrame{});
        ASSERT_EQ(gpu.light_count, 1u);
        ASSERT_EQ(gpu.primitive_count, 1u);
        const LightRecord l = light(gpu, 0);
        EXPECT_EQ(l.kind, LIGHT_PARALLELOGRAM);
        EXPECT_EQ(l.p, vec3(quad.corners[0]));
        EXPECT_EQ(l.e1, vec3(quad.corners[1] - quad.corners[0]));
        EXPECT_EQ(l.e2, vec3(quad.corners[3] - quad.corners[0]));
        EXPECT_EQ(l.radiance, vec3(2));
        EXPECT_EQ(l.two_sided, 0u);
        EXPECT_NEAR(double(l.pdf_area) * area(l), 1.0, 1e-6);
        EXPECT_EQ(l.pmf, 1.0f);
        for (const Triangle& t : triangles(gpu))
            EXPECT_EQ(t.surface.light, 0u);
    }
}

TEST(GpuScene, AnyOtherQuadIsTwoLightsThatCoverIt) {
    const Quad kite{{dvec3(0, 0, 0), dvec3(2, 0, 0), dvec3(3, 3, 0), dvec3(0, 2, 0)}};
    const GpuScene gpu = build_gpu_scene(scene_of_shapes({emitter(kite, vec3(1))}), SceneFrame{});
    ASSERT_EQ(gpu.light_count, 2u);
    double covered = 0.0, probability = 0.0;
    for (const uint32_t i : {0u, 1u}) {
        const LightRecord l = light(gpu, i);
        EXPECT_EQ(l.kind, LIGHT_TRIANGLE);
        EXPECT_GT(cross(l.e1, l.e2).z, 0.0f) << "the light faces another way than the quad";
        covered += area(l);
        probability += double(l.pmf);
        // Equal radiance: equal density everywhere.
        EXPECT_NEAR(l.pmf * l.pdf_area, 1.0 / 6.0, 1e-6);
    }
    EXPECT_NEAR(covered, 6.0, 1e-6);
    EXPECT_NEAR(probability, 1.0, 1e-6);
    std::set<uint32_t> lights;
    for (const Triangle& t : triangles(gpu)) {
        const LightRecord l = light(gpu, t.surface.light);
        EXPECT_EQ(l.p, t.a);
        EXPECT_EQ(l.p + l.e1, t.b);
        EXPECT_EQ(l.p + l.e2, t.c);
        lights.insert(t.surface.light);
    }
    EXPECT_EQ(lights.size(), 2u);
}

TEST(GpuScene, LightsAreChosenByAreaLuminanceAndSides) {
    const Quad large = parallelogram(vec3(0), vec3(3, 0, 0), vec3(0, 2, 0));
    TriangleMesh mesh{.positions = {vec3(0), vec3(2, 0, 0), vec3(0, 2, 0), vec3(0, 0, 4)},
                      .normals = {},
                      .triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)}};
    Scene scene = scene_of_shapes(
        {emitter(SQUARE, vec3(1)), emitter(large, vec3(0, 1, 0)), emitter(SQUARE, vec3(0.5f), true)});
    add_shape(scene, mesh, 0, Emission{.radiance = vec3(3), .two_sided = false});
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    const std::vector<double> powers{1.0, 6.0 * 0.7152, 1.0, 3.0 * 2.0, 3.0 * 4.0};
    ASSERT_EQ(gpu.light_count, powers.size());
    const std::vector<double> chosen = light_probabilities(gpu);
    double total = 0.0, probability = 0.0;
    for (const double power : powers)
        total += power;
    for (uint32_t i = 0; i < gpu.light_count; ++i) {
        const LightRecord l = light(gpu, i);
        EXPECT_NEAR(chosen[i], powers[i] / total, 1e-6) << i;
        EXPECT_NEAR(double(l.pmf), chosen[i], 1e-6) << i;
        EXPECT_NEAR(double(l.pdf_area) * area(l), 1.0, 1e-6) << i;
        EXPECT_EQ(l.two_sided, i == 2 ? 1u : 0u);
        probability += double(l.pmf);
    }
    EXPECT_NEAR(probability, 1.0, 1e-6);
}

TEST(GpuScene, EmittersWithoutAreaOrRadianceAreHarmless) {
    const Quad flat = parallelogram(vec3(0), vec3(1, 0, 0), vec3(2, 0, 0));
    EXPECT_EQ(build_gpu_scene(scene_of_shapes({emitter(flat, vec3(1))})).light_count, 0u);
    EXPECT_EQ(build_gpu_scene(scene_of_shapes({emitter(SQUARE, vec3(0))})).light_count, 0u);
    const GpuScene gpu =
        build_gpu_scene(scene_of_shapes({emitter(SQUARE, vec3(0)), emitter(SQUARE, vec3(1))}), SceneFrame{});
    for (uint32_t i = 0; i < gpu.light_count; ++i)
        EXPECT_TRUE(std::isfinite(light(gpu, i).pdf_area));
}

TEST(GpuScene, IdsFollowTheOrderOfTheSceneAndEveryTriangleIsThere) {
    const TriangleMesh mesh = triangle_soup(100, 0.3f, 1);
    Scene scene = scene_of_shapes({{.geometry = SQUARE, .material = 0, .emission = {}}});
    add_diffuse(scene, vec3(1));
    add_shape(scene, mesh, 1);
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    ASSERT_EQ(gpu.id_count, 102u);
    EXPECT_EQ(gpu.primitive_count, 101u);  // No two of the soup touch.
    const std::vector<Triangle> all = triangles(gpu);
    for (uint32_t id = 0; id < all.size(); ++id) {
        const Triangle& t = all[id];
        EXPECT_EQ(t.surface.light, NO_LIGHT);
        EXPECT_EQ(t.surface.material, id < 2 ? 0u : 1u);
        if (id < 2) {
            EXPECT_TRUE(same_corners(t, vec3(SQUARE.corners[0]), vec3(SQUARE.corners[id + 1]),
                                     vec3(SQUARE.corners[id + 2])));
        } else {
            const uvec3 corners = mesh.triangles[id - 2];
            EXPECT_TRUE(same_corners(t, mesh.positions[corners.x], mesh.positions[corners.y],
                                     mesh.positions[corners.z]));
        }
    }
}

TEST(GpuScene, OnlySmoothMeshesHaveNormals) {
    EXPECT_FALSE(
        build_gpu_scene(scene_of_shapes({{.geometry = SQUARE, .material = 0, .emission = {}}})).has_normals);

    TriangleMesh smooth = sphere_mesh(4, 6);
    smooth.normals = smooth.positions;
    Scene scene = scene_of_shapes({{.geometry = SQUARE, .material = 0, .emission = {}}});
    add_shape(scene, smooth, 0);
    add_shape(scene, SQUARE, 0);
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    EXPECT_TRUE(gpu.has_normals);
    EXPECT_LT(gpu.primitive_count, 2 + smooth.triangles.size());
    const std::vector<Triangle> all = triangles(gpu);
    for (uint32_t id = 0; id < all.size(); ++id) {
        const Triangle& t = all[id];
        const bool of_the_sphere = id >= 2 && id < 2 + smooth.triangles.size();
        EXPECT_EQ(t.surface.has_normals, of_the_sphere ? 1u : 0u);
        EXPECT_EQ(t.normals, of_the_sphere
                                 ? uvec3(pack_octahedral(t.a), pack_octahedral(t.b), pack_octahedral(t.c))
                                 : uvec3(0));
        if (of_the_sphere) {
            const uvec3 corners = smooth.triangles[id - 2];
            EXPECT_TRUE(same_corners(t, smooth.positions[corners.x], smooth.positions[corners.y],
                                     smooth.positions[corners.z]));
        }
    }
}

TEST(GpuScene, ArraysHoldTheRecordsOfWhatThereIs) {
    Scene scene = scene_of_shapes({emitter(SQUARE, vec3(1))});
    add_diffuse(scene, vec3(1));
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    const std::array<uint32_t, ARRAY_COUNT> records{1, 1, 1, 0, 2, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0};
    uint64_t words = 0;
    for (const SceneArray& array : SCENE_ARRAYS) {
        EXPECT_EQ(gpu.arrays[array.number].size(), records[array.number] * array.words) << array.name;
        words += gpu.arrays[array.number].size();
    }
    EXPECT_EQ(gpu.bytes(), words * 16);
    const uvec4 material = gpu.arrays[ARRAY_MATERIALS][0];
    EXPECT_EQ(material.x, MATERIAL_DIFFUSE | MEDIUM_SAME << 8);
    EXPECT_EQ(std::bit_cast<vec3>(uvec3(material.y, material.z, material.w)), vec3(0.25f, 0.5f, 0.75f));
}

EnvironmentTexel texel(const GpuScene& gpu, uint32_t i) {
    const uvec4 w = gpu.arrays[ARRAY_ENVIRONMENT][i];
    return {floats(w), std::bit_cast<float>(w.w)};
}

// A third of the sky is 2 above its mean: the power, over pi, on the sphere around the square's box, whose
// radius is sqrt(2) / 2, is 1/2 * 2 * 4/3 pi; that of the square is 10.
TEST(GpuScene, TheSkyIsALightAndChosenByThePowerThatFallsOntoTheScene) {
    Scene scene = scene_of_shapes({emitter(SQUARE, vec3(10))});
    const std::vector<vec3> radiance{vec3(1), vec3(1.5f, 0.6089f / 0.7152f, 1), vec3(4)};
    scene.environment = Environment{.size = {3, 1}, .radiance = radiance, .rotation = 0.5f};
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    ASSERT_EQ(gpu.light_count, 2u);
    EXPECT_EQ(light(gpu, 1).kind, LIGHT_ENVIRONMENT);
    EXPECT_EQ(gpu.environment, ENVIRONMENT_VISIBLE);
    EXPECT_EQ(gpu.environment_size, uvec2(3, 1));
    EXPECT_EQ(gpu.environment_rotation, 0.5f);

    const double power = 4.0 / 3.0 * M_PI, pmf = power / (power + 10.0);
    EXPECT_NEAR(light_probabilities(gpu)[1], pmf, 1e-6);
    EXPECT_NEAR(light(gpu, 0).pmf, 1.0 - pmf, 1e-6);
    EXPECT_EQ(gpu.light_groups.placed, 1u);
    EXPECT_EQ(gpu.light_groups.suns, 0u);
    EXPECT_NEAR(light(gpu, 1).pmf, pmf, 1e-6);
    for (const uint32_t i : {0u, 1u, 2u}) {
        EXPECT_EQ(texel(gpu, i).radiance, radiance[i]);
        EXPECT_NEAR(texel(gpu, i).pdf, i == 2 ? 3.0 / (4.0 * M_PI) : 0.0, 1e-7);
    }
    EXPECT_EQ(gpu.arrays[ARRAY_ENVIRONMENT].size(), 3u);
    EXPECT_EQ(gpu.arrays[ARRAY_ENVIRONMENT_CDF].size(),
              2u);  // Of three columns and a row, two entries a word.

    scene.environment->visible = false;
    EXPECT_EQ(build_gpu_scene(scene).environment, ENVIRONMENT_HIDDEN);
}

TEST(GpuScene, TheSkyIsChosenForHalfOfTheSamplesAtMost) {
    Scene scene = scene_of_shapes({emitter(SQUARE, vec3(1)), emitter(SQUARE, vec3(2))});
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(50), vec3(150)}};
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    const std::vector<double> chosen = light_probabilities(gpu);
    EXPECT_NEAR(chosen[0], 1.0 / 6.0, 1e-6);
    EXPECT_NEAR(chosen[1], 2.0 / 6.0, 1e-6);
    EXPECT_NEAR(chosen[2], 0.5, 1e-6);
    EXPECT_NEAR(light(gpu, 0).pmf, 1.0 / 6.0, 1e-6);
    EXPECT_NEAR(light(gpu, 2).pmf, 0.5, 1e-6);
    EXPECT_NEAR(texel(gpu, 1).pdf, 1.0 / (2.0 * M_PI), 1e-7);
}

TEST(GpuScene, ASkyThatIsEvenOrLightsNothingIsNotSampled) {
    Scene black = scene_of_shapes({{.geometry = SQUARE, .material = 0, .emission = {}}});
    black.environment = Environment{.size = {1, 1}, .radiance = {vec3(0)}};
    Scene empty = scene_of_shapes({});
    empty.environment = Environment{.size = {2, 1}, .radiance = {vec3(1), vec3(2)}};
    Scene even = black;
    even.environment = Environment{.size = {2, 1}, .radiance = {vec3(1), vec3(1)}};
    for (const Scene* scene : {&black, &empty, &even}) {
        const GpuScene gpu = build_gpu_scene(*scene, SceneFrame{});
        EXPECT_EQ(gpu.light_count, 0u);
        EXPECT_EQ(gpu.environment, ENVIRONMENT_VISIBLE);
        EXPECT_EQ(texel(gpu, 0).pdf, 0.0f);
        EXPECT_EQ(gpu.even_sky, scene != &empty);
    }
}

TEST(GpuScene, AnEvenSkyLeavesAllSamplesToTheLamps) {
    Scene scene = scene_of_shapes({emitter(SQUARE, vec3(1))});
    scene.environment = Environment{.size = {1, 1}, .radiance = {vec3(100)}};
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    ASSERT_EQ(gpu.light_count, 1u);
    EXPECT_EQ(light(gpu, 0).pmf, 1.0f);
    EXPECT_EQ(texel(gpu, 0).radiance, vec3(100));
    EXPECT_EQ(texel(gpu, 0).pdf, 0.0f);
}

TEST(GpuScene, EveryMaterialHasItsRecord) {
    Scene scene;
    scene.materials = {
        {"", DiffuseMaterial{vec3(0.1f, 0.2f, 0.3f)}},
        {"", PhongMaterial{.diffuse = vec3(0.1f), .specular = vec3(0.4f, 0.5f, 0.6f), .exponent = 20.0f}},
        {"", MirrorMaterial{vec3(0.7f)}},
        {"", ConductorMaterial{.reflectance = vec3(0.8f), .alpha = 0.25f}},
        {"", DielectricMaterial{.ior = 1.5f, .exterior_ior = 1.2f, .inside = {vec3(1, 2, 3)}}},
        {"", DielectricMaterial{.fresnel = Fresnel::exact, .priority = 15}},
        {"", DiffuseTransmissionMaterial{vec3(0.2f), vec3(0.3f)}},
        {"", DiffuseTransmissionMaterial{vec3(0.2f), vec3(0.3f), Medium{vec3(1, 2, 3)}}},
        {"", DielectricMaterial{.ior = 1.5f, .inside = {vec3(1, 2, 3)}}},
        {"", PrincipledMaterial{.base_color = vec3(0.2f), .unlit = true}},
    };
    const std::vector<MaterialRecord> expected{
        {MATERIAL_DIFFUSE, MEDIUM_SAME, vec3(0.1f, 0.2f, 0.3f), vec3(0), 0.0f},
        {MATERIAL_PHONG, MEDIUM_SAME, vec3(0.1f), vec3(0.4f, 0.5f, 0.6f), 20.0f},
        {MATERIAL_MIRROR, MEDIUM_SAME, vec3(0.7f), vec3(0), 0.0f},
        {MATERIAL_CONDUCTOR, MEDIUM_SAME, vec3(0.8f), vec3(0), 0.25f},
        {MATERIAL_DIELECTRIC_SCHLICK, 1, vec3(0), vec3(1, 0, 0), 1.25f},
        {MATERIAL_DIELECTRIC_EXACT, 0xF002, vec3(0), vec3(0), 1.5f},
        {MATERIAL_DIFFUSE_TRANSMISSION, MEDIUM_SAME, vec3(0.2f), vec3(0.3f), 0.0f},
        {MATERIAL_DIFFUSE_TRANSMISSION, 3, vec3(0.2f), vec3(0.3f), 0.0f},
        {MATERIAL_DIELECTRIC_SCHLICK, 1, vec3(0), vec3(0), 1.5f},
        {MATERIAL_UNLIT, MEDIUM_SAME, vec3(0.2f), vec3(0), 0.0f},
    };
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    for (uint32_t i = 0; i < expected.size(); ++i) {
        const auto words = pack(expected[i]);
        EXPECT_EQ(gpu.arrays[ARRAY_MATERIALS][2 * i], words[0]) << i;
        EXPECT_EQ(gpu.arrays[ARRAY_MATERIALS][2 * i + 1], words[1]) << i;
    }
    EXPECT_EQ(gpu.materials_present,
              ((1u << MATERIAL_COUNT) - 1) & ~(1u << MATERIAL_PRINCIPLED | 1u << MATERIAL_PHASE));
    std::vector<uvec4> media;
    for (const auto& [absorption, ior] :
         {std::pair(vec3(0), 1.0f), {vec3(1, 2, 3), 1.5f}, {vec3(0), 1.5f}, {vec3(1, 2, 3), 1.0f}})
        std::ranges::copy(pack(MediumRecord{absorption, ior, vec3(0), 0.0f}), std::back_inserter(media));
    EXPECT_EQ(gpu.arrays[ARRAY_MEDIA], media);
    EXPECT_TRUE(gpu.has_media);
    EXPECT_FALSE(gpu.volumetric);
    EXPECT_FALSE(build_gpu_scene(scene_of_shapes({})).has_media);
    EXPECT_EQ(build_gpu_scene(scene_of_shapes({})).materials_present, 1u << MATERIAL_DIFFUSE);
}

// Shaders clamp what images give to the limits that loaders check.
TEST(GpuScene, LimitsOfMaterialsAreThoseOfTheShaders) {
    EXPECT_EQ(MIN_FACET_ALPHA, MIN_ALPHA);
    EXPECT_EQ(GREATEST_EXPONENT, MAX_PHONG_EXPONENT);
}

// Behind the records of all materials, those of principled ones, each with the images that it takes values
// from: textures that differ only in the channel are one.
TEST(GpuScene, PrincipledMaterialsHaveRecordsBehindTheOthers) {
    Scene scene;
    scene.images.emplace_back().image = std::make_shared<TexelImage>(
        TexelImage{.size = {1, 1}, .channels = 4, .texels = std::vector<std::byte>(4), .gamma = {}});
    Texture red, green;
    green.channel = 1;
    scene.materials = {
        {"", PrincipledMaterial{.metalness = {0.5f, red}, .roughness = {0.25f, green}, .ior = 1.4f}},
        {"", DiffuseMaterial{}},
        {"", PrincipledMaterial{.roughness = 0.0f, .transmission = 1.0f, .inside = Medium{vec3(1)}}}};
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    const std::vector<uvec4>& words = gpu.arrays[ARRAY_MATERIALS];
    ASSERT_EQ(words.size(), 3 * MATERIAL_WORDS + PRINCIPLED_WORDS + 1 + PRINCIPLED_WORDS);
    const uint32_t first = 3 * MATERIAL_WORDS;
    EXPECT_EQ(words[1],
              uvec4(std::bit_cast<uint32_t>(float(first) * 0x1p-24f), 0, 0, std::bit_cast<uint32_t>(1.4f)));
    EXPECT_EQ(std::bit_cast<float>(words[5].x), float(first + PRINCIPLED_WORDS + 1) * 0x1p-24f);
    EXPECT_EQ(std::bit_cast<vec4>(words[first]), vec4(0.5f, 0.25f, 0, 1));
    EXPECT_EQ(words[first + 7].z, 1u);
    constexpr uint32_t METALNESS = 3, ROUGHNESS = 4;  // Bits in principled_record.inc.
    EXPECT_EQ(words[first + PRINCIPLED_WORDS],
              uvec4(0, 1u << METALNESS | 1u << ROUGHNESS, 1u << 2 * ROUGHNESS, 0));
    EXPECT_EQ(gpu.principled, PRINCIPLED_HAS_METAL | PRINCIPLED_HAS_ROUGH | PRINCIPLED_HAS_DIFFUSE |
                                  PRINCIPLED_HAS_IMAGES | PRINCIPLED_HAS_VOLUME);
}

TEST(GpuScene, KindsOfPrimitivesArePresentOnlyIfTheyAre) {
    const auto present = [](std::vector<Shape> shapes) {
        return build_gpu_scene(scene_of_shapes(std::move(shapes))).primitives_present;
    };
    const Shape quad{.geometry = SQUARE, .material = 0, .emission = {}};
    const Shape sphere{.geometry = Sphere{}, .material = 0, .emission = {}};
    const Shape disk{.geometry = Disk{}, .material = 0, .emission = {}};
    EXPECT_EQ(present({}), 0u);
    EXPECT_EQ(present({quad}), 1u << PRIMITIVE_TRIANGLES);
    EXPECT_EQ(present({sphere, sphere}), 1u << PRIMITIVE_SPHERE);
    EXPECT_EQ(present({quad, disk}), 1u << PRIMITIVE_TRIANGLES | 1u << PRIMITIVE_DISK);
    EXPECT_EQ(present({quad, sphere, disk}),
              1u << PRIMITIVE_TRIANGLES | 1u << PRIMITIVE_SPHERE | 1u << PRIMITIVE_DISK);
}

TEST(GpuScene, KindsOfLightsArePresentOnlyIfTheyAre) {
    const Emission emission{.radiance = vec3(1)};
    const Shape quad{.geometry = SQUARE, .material = 0, .emission = emission};
    const Shape sphere{.geometry = Sphere{}, .material = 0, .emission = emission};
    Scene scene = scene_of_shapes({quad, Shape{.geometry = Sphere{}, .material = 0, .emission = {}}});
    EXPECT_EQ(build_gpu_scene(scene).lights_present, 1u << LIGHT_PARALLELOGRAM);
    EXPECT_EQ(build_gpu_scene(scene_of_shapes({})).lights_present, 0u);
    scene.shapes.push_back(sphere);
    scene.environment = Environment{.size = {1, 2}, .radiance = {vec3(1), vec3(2)}};
    EXPECT_EQ(build_gpu_scene(scene).lights_present,
              1u << LIGHT_PARALLELOGRAM | 1u << LIGHT_SPHERE | 1u << LIGHT_ENVIRONMENT);
}

// Two squares with a common edge and a separate triangle: 4 + 2 + 3 places.
TEST(GpuScene, OfCornersInOnePlaceTheFirstIsNamed) {
    const Quad next = parallelogram(vec3(1, 0, 0), vec3(1, 0, 1), vec3(0, 1, 0));
    const TriangleMesh triangle{
        .positions = {vec3(5), vec3(6, 5, 5), vec3(5, 6, 5)}, .normals = {}, .triangles = {uvec3(0, 1, 2)}};
    Scene scene = scene_of_shapes({Shape{.geometry = SQUARE, .material = 0, .emission = {}},
                                   Shape{.geometry = next, .material = 0, .emission = {}}});
    add_shape(scene, triangle, 0);
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    ASSERT_EQ(gpu.primitive_count, 3u);
    std::vector<vec3> corners;
    for (size_t i = 0; i < gpu.primitive_count; ++i) {
        const uvec4* w = &gpu.arrays[ARRAY_PRIMITIVES][i * PRIMITIVE_WORDS];
        const vec3 d = std::bit_cast<vec3>(uvec3(w[0].w, w[1].w, w[2].w));
        corners.insert(corners.end(), {floats(w[0]), floats(w[1]), floats(w[2]), d});
    }
    std::set<uint32_t> named;
    for (uint32_t i = 0; i < corners.size(); ++i) {
        const uint32_t first = gpu.list_corners[i / 4] >> 8 * (i % 4) & 255u;
        EXPECT_EQ(first, uint32_t(std::ranges::find(corners, corners[i]) - corners.begin()));
        named.insert(first);
    }
    EXPECT_EQ(named.size(), 9u);
}

TEST(GpuScene, AnEmptySceneIsARootWithoutChildren) {
    const GpuScene gpu = build_gpu_scene(scene_of_shapes({}));
    EXPECT_EQ(gpu.primitive_count, 0u);
    EXPECT_EQ(gpu.light_count, 0u);
    EXPECT_EQ(gpu.arrays[ARRAY_NODES].size(), BVH_NODE_WORDS);
}

}  // namespace
}  // namespace candela
