// Shapes -> primitives and lights: round shapes, their areas, powers and boxes.
#include "gpu_scene/flatten.h"

#include <cmath>

#include <gtest/gtest.h>

#include "gpu_scene/area_lights.h"
#include "gpu_scene/gpu_scene.h"
#include "probe/random.h"
#include "support/scene_builders.h"
#include "unit/gpu_scene/packed_scene.h"

namespace candela {
namespace {

Shape shape(const decltype(Shape::geometry)& geometry, uint32_t material,
            std::optional<Emission> emission = std::nullopt) {
    return {.geometry = geometry, .material = material, .emission = emission};
}

Scene scene_of(const std::vector<Shape>& shapes) {
    Scene scene;
    scene.materials.resize(8);
    scene.shapes = shapes;
    return scene;
}

FlatScene flatten_shapes(const std::vector<Shape>& shapes) {
    return flatten(scene_of(shapes), SceneFrame{});
}

AreaLights lights_of(const std::vector<Shape>& shapes) {
    return build_area_lights(scene_of(shapes), flatten_shapes(shapes));
}

const Sphere BALL{.center = dvec3(1, -2, 3), .radius = 0.5};
const Disk ELLIPSE{.center = dvec3(4, 5, 6), .e1 = dvec3(2, 0, 0), .e2 = dvec3(1, 0, -3)};

TEST(Flatten, ASphereIsOnePrimitiveAndOneLight) {
    const std::vector<Shape> shapes{shape(BALL, 7, Emission{.radiance = vec3(0, 2, 0), .two_sided = false})};
    const FlatScene flat = flatten_shapes(shapes);
    const auto [lights, pieces, of_pieces] = lights_of(shapes);
    ASSERT_EQ(flat.primitives.size(), 1u);
    EXPECT_EQ(flat.primitives[0].kind, PRIMITIVE_SPHERE);
    EXPECT_EQ(flat.primitives[0].a, vec3(BALL.center));
    EXPECT_EQ(flat.primitives[0].b.x, BALL.radius);
    EXPECT_EQ(flat.surfaces[0].material, 7u);
    EXPECT_EQ(flat.surfaces[0].light, 0u);
    EXPECT_EQ(of_pieces, std::vector<uint32_t>{0});
    ASSERT_EQ(lights.records.size(), 1u);
    EXPECT_EQ(lights.records[0].kind, LIGHT_SPHERE);
    EXPECT_EQ(lights.records[0].p, vec3(BALL.center));
    EXPECT_EQ(lights.records[0].e1.x, BALL.radius);
    EXPECT_EQ(lights.records[0].radiance, vec3(0, 2, 0));
    EXPECT_NEAR(1.0 / lights.records[0].pdf_area, M_PI, 1e-6);  // 4 pi / 2^2
    EXPECT_NEAR(lights.powers[0], M_PI * 2.0 * 0.7152, 2e-6);
}

TEST(Flatten, ADiskIsOnePrimitiveAndOneLight) {
    const std::vector<Shape> shapes{shape(ELLIPSE, 3, Emission{.radiance = vec3(1), .two_sided = true})};
    const FlatScene flat = flatten_shapes(shapes);
    const auto [lights, pieces, of_pieces] = lights_of(shapes);
    ASSERT_EQ(flat.primitives.size(), 1u);
    EXPECT_EQ(flat.primitives[0].kind, PRIMITIVE_DISK);
    EXPECT_EQ(flat.primitives[0].a, vec3(ELLIPSE.center));
    EXPECT_EQ(flat.primitives[0].b, vec3(ELLIPSE.e1));
    EXPECT_EQ(flat.primitives[0].c, vec3(ELLIPSE.e2));
    EXPECT_EQ(flat.surfaces[0].light, 0u);
    EXPECT_EQ(of_pieces, std::vector<uint32_t>{0});
    ASSERT_EQ(lights.records.size(), 1u);
    EXPECT_EQ(lights.records[0].kind, LIGHT_DISK);
    EXPECT_EQ(lights.records[0].two_sided, 1u);
    EXPECT_NEAR(1.0 / lights.records[0].pdf_area, 6.0 * M_PI,
                1e-5);  // The parallelogram of its axes is 6 m^2.
    EXPECT_NEAR(lights.powers[0], 12.0 * M_PI, 2e-5);
}

// The mean of a function of the angle to an axis over all directions, or over the projected solid angle of a
// hemisphere.
template <class F>
double mean_over_angles(double end, F weight) {
    constexpr int STEPS = 200000;
    double sum = 0.0;
    for (int i = 0; i < STEPS; ++i)
        sum += weight(end * (i + 0.5) / STEPS);
    return sum * end / STEPS;
}

// The power of a light in a beam is that of one to all sides, times the mean of the beam's factor.
TEST(Flatten, ABeamHasAPartOfThePower) {
    const auto power_of = [](const Geometry& geometry, const Beam& beam) {
        std::vector<Shape> shapes{shape(geometry, 0, Emission{.radiance = vec3(1)})};
        const double whole = lights_of(shapes).lights.powers[0];
        shapes[0].beam = beam;
        const PoweredLights lights = lights_of(shapes).lights;
        EXPECT_EQ(lights.records[0].kind == LIGHT_BEAM, beam.cone.has_value());
        EXPECT_EQ(lights.records[0].spread > 0.0f, beam.spread < PI);
        return lights.powers[0] / whole;
    };
    for (const double spread : {3.0, 1.0, 0.03, 0.01}) {
        SCOPED_TRACE(spread);
        const double mean = mean_over_angles(0.5 * spread, [&](double a) {
            return 2.0 * std::sin(a) * std::cos(a) * (1.0 - std::tan(a) / std::tan(0.5 * spread));
        });
        EXPECT_NEAR(power_of(ELLIPSE, {.spread = float(spread)}) / mean, 1.0, 1e-5);  // The record's bits.
    }
    for (const SpotFalloff falloff : {SpotFalloff::square, SpotFalloff::smoothstep}) {
        const double inner = std::cos(0.4), outer = std::cos(0.9);
        const double mean = mean_over_angles(0.9, [&](double a) {
            const double t = std::min((std::cos(a) - outer) / (inner - outer), 1.0);
            return 0.5 * std::sin(a) * t * t * (falloff == SpotFalloff::square ? 1.0 : 3.0 - 2.0 * t);
        });
        EXPECT_NEAR(power_of(BALL, {.cone = Cone{0.4f, 0.9f, falloff}}) / mean, 1.0, 1e-6);
    }
}

// Kernels contain beams only where a light has one.
TEST(Flatten, OnlyBeamsArePresentAsBeams) {
    Scene scene = scene_of(
        {shape(BALL, 0, Emission{.radiance = vec3(1)}), shape(ELLIPSE, 0, Emission{.radiance = vec3(1)})});
    EXPECT_EQ(build_gpu_scene(scene).lights_present, 1u << LIGHT_SPHERE | 1u << LIGHT_DISK);
    scene.shapes[0].beam.cone = Cone{};
    EXPECT_EQ(build_gpu_scene(scene).lights_present, 1u << LIGHT_BEAM | 1u << LIGHT_DISK);
    scene.shapes[1].beam.spread = 1.0f;
    EXPECT_EQ(build_gpu_scene(scene).lights_present,
              1u << LIGHT_BEAM | 1u << LIGHT_DISK | 1u << LIGHT_SPREAD);
}

TEST(Flatten, BlackShapesAreNoLights) {
    const Emission black{.radiance = vec3(0), .two_sided = true};
    const Disk without_area{.center = dvec3(0), .e1 = dvec3(1, 0, 0), .e2 = dvec3(2, 0, 0)};
    const std::vector<Shape> shapes{
        shape(BALL, 0), shape(BALL, 0, black), shape(ELLIPSE, 0), shape(ELLIPSE, 0, black),
        shape(without_area, 0, Emission{.radiance = vec3(1), .two_sided = false})};
    EXPECT_EQ(flatten_shapes(shapes).primitives.size(), 5u);
    const AreaLights area = lights_of(shapes);
    EXPECT_TRUE(area.lights.records.empty());
    EXPECT_EQ(area.of_pieces, std::vector<uint32_t>(3, NO_LIGHT));
    const std::vector<uvec4> surfaces = build_gpu_scene(scene_of(shapes)).arrays[ARRAY_SURFACES];
    ASSERT_EQ(surfaces.size(), 5u);
    for (const uvec4 surface : surfaces)
        EXPECT_EQ(surface.w, NO_LIGHT);
}

TEST(Flatten, IdsFollowTheOrderOfTheSceneAcrossKinds) {
    const Quad quad = parallelogram(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    const FlatScene flat = flatten_shapes({shape(BALL, 1), shape(quad, 2), shape(ELLIPSE, 3)});
    ASSERT_EQ(flat.primitives.size(), 3u);
    EXPECT_EQ(flat.id_count, 4u);
    const std::vector<uint> kinds{PRIMITIVE_SPHERE, PRIMITIVE_TRIANGLES, PRIMITIVE_DISK};
    const std::vector<uvec2> ids{uvec2(0, 0), uvec2(1, 2), uvec2(3, 3)};
    for (uint i = 0; i < 3; ++i) {
        EXPECT_EQ(flat.surfaces[i].id, ids[i]);
        EXPECT_EQ(flat.primitives[i].kind, kinds[i]);
        EXPECT_EQ(flat.surfaces[i].material, i + 1);
    }
    EXPECT_TRUE(flat.normals.empty());
}

// Only where an opacity or the colours of vertices say so do rays ask whether they pass.
TEST(Flatten, SurfacesSayWhetherRaysMayPass) {
    Scene scene;
    scene.materials.resize(4);
    scene.materials[1].opacity.value = 0.5f;
    scene.materials[2].opacity.value = {1.0f, Texture{}};
    scene.materials[3].vertex_colors = true;
    for (const uint32_t material : {0u, 1u, 2u, 3u})
        add_shape(scene, BALL, material);
    TriangleMesh mesh;
    add_triangle(mesh, vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    mesh.colors = {vec4(1), vec4(1), vec4(1)};
    add_shape(scene, mesh, 3);
    mesh.colors[2].w = 0.5f;
    add_shape(scene, mesh, 3);
    add_shape(scene, mesh, 0);
    std::vector<uint32_t> found;
    for (const Surface& surface : flatten(scene, SceneFrame{}).surfaces)
        found.push_back(surface.passable);
    EXPECT_EQ(found, (std::vector<uint32_t>{0, 1, 1, 0, 0, 1, 0}));
}

TEST(Flatten, EveryPrimitiveHasARecordOfNormalsIfOneIsSmooth) {
    TriangleMesh smooth = sphere_mesh(4, 6);
    smooth.normals = smooth.positions;
    Scene scene;
    scene.materials.resize(1);
    add_shape(scene, BALL, 0);
    add_shape(scene, smooth, 0);
    add_shape(scene, ELLIPSE, 0);
    const FlatScene flat = flatten(scene, SceneFrame{});
    ASSERT_EQ(flat.normals.size(), flat.primitives.size());
    for (size_t i = 0; i < flat.normals.size(); ++i) {
        const bool of_the_mesh = flat.primitives[i].kind == PRIMITIVE_TRIANGLES;
        EXPECT_EQ(flat.surfaces[i].has_normals, of_the_mesh ? 1u : 0u);
        if (!of_the_mesh) {
            EXPECT_EQ(flat.normals[i][0], uvec4(0));
        }
    }
}

TEST(Flatten, ProbabilitiesAreSharesOfAllPowers) {
    const Emission white{.radiance = vec3(1), .two_sided = false};
    const PoweredLights lights = lights_of({shape(BALL, 0, white), shape(ELLIPSE, 0, white)}).lights;
    const GpuScene gpu = build_gpu_scene(scene_of({shape(BALL, 0, white), shape(ELLIPSE, 0, white)}), {});
    const double sum = lights.powers[0] + lights.powers[1];
    for (const size_t i : {0u, 1u})
        EXPECT_NEAR(light(gpu, uint32_t(i)).pmf, lights.powers[i] / sum, 1e-7);
}

// Points of the surface, in double precision, lie in the box but for its roundings, and on each side of the
// box some point comes near.
TEST(Flatten, BoxesAreTheLeastOnes) {
    Random random(3);
    const FlatScene flat = flatten_shapes({shape(BALL, 0), shape(ELLIPSE, 0)});
    for (const Primitive& p : flat.primitives) {
        const Box box = bounds(p);
        glm::dvec3 lo(1e9), hi(-1e9);
        for (int i = 0; i < 200000; ++i) {
            const double phi = 2.0 * M_PI * double(random.unit());
            const glm::dvec3 point =
                glm::dvec3(p.a) + (p.kind == PRIMITIVE_SPHERE
                                       ? double(p.b.x) * normalize(glm::dvec3(random.direction()))
                                       : std::cos(phi) * glm::dvec3(p.b) + std::sin(phi) * glm::dvec3(p.c));
            lo = min(lo, point);
            hi = max(hi, point);
        }
        for (const int axis : {0, 1, 2}) {
            EXPECT_GE(lo[axis], box.lo[axis] - 1e-6);
            EXPECT_LE(hi[axis], box.hi[axis] + 1e-6);
            EXPECT_NEAR(lo[axis], box.lo[axis], 1e-3);
            EXPECT_NEAR(hi[axis], box.hi[axis], 1e-3);
        }
    }
}

// The image may be turned on the quad or mirrored; the bitangent, w cross(n, t), is where v grows.
TEST(Flatten, TangentsOfAQuadFollowItsImage) {
    const dvec3 e1(2, 0, 0), e2(0, 0, -3);
    for (size_t turn = 0; turn < 4; ++turn) {
        for (const bool mirrored : {false, true}) {
            Quad quad = parallelogram(vec3(0), vec3(e1), vec3(e2));
            for (size_t i = 0; i < 4; ++i)
                quad.uvs[i] = Quad{}.uvs[(turn + (mirrored ? 4 - i : i)) % 4];
            Scene scene;
            scene.materials.resize(1);
            scene.shapes.push_back(shape(quad, 0));
            const FlatScene flat = flatten(scene, SceneFrame{}, ATTRIBUTE_TANGENT);
            const uint packed = flat.attributes.at(0).x;
            const vec2 side = quad.uvs[1] - quad.uvs[0], other = quad.uvs[3] - quad.uvs[0];
            const dvec3 along_u = double(side.x) * e1 + double(other.x) * e2;
            const dvec3 along_v = double(side.y) * e1 + double(other.y) * e2;
            const dvec3 n = normalize(cross(e1, e2));
            const float w = dot(cross(n, along_u), along_v) > 0.0 ? 1.0f : -1.0f;
            EXPECT_EQ(packed, pack_tangent(vec4(vec3(normalize(along_u)), w))) << turn << ' ' << mirrored;
        }
    }
}

// Rays pass its back and see nothing of it.
TEST(Flatten, TheBackOfACulledShapeEmitsNothing) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].model = PrincipledMaterial{.double_sided = false};
    scene.shapes.push_back(shape(ELLIPSE, 0, Emission{.radiance = vec3(1), .two_sided = true}));
    const PoweredLights lights = build_area_lights(scene, flatten(scene, SceneFrame{})).lights;
    EXPECT_EQ(lights.records.at(0).two_sided, 0u);
    EXPECT_NEAR(lights.powers[0], 6.0 * M_PI, 2e-5);
}

}  // namespace
}  // namespace candela
