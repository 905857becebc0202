// One room at every scale, far from the origin and turned: its picture stays the same.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "render/render_fixture.h"
#include "scene/geometry.h"
#include "scene/mesh.h"

namespace candela {
namespace {

// Where the room lies in the world: turned, scaled, and then moved.
struct Place {
    double scale = 1.0;
    dvec3 shift{0.0};  // In widths of the room.
    glm::dmat3 turn{1.0};

    dvec3 point(dvec3 p) const { return scale * (turn * p + shift); }
    dvec3 vector(dvec3 v) const { return scale * (turn * v); }
    Quad quad(dvec3 a, dvec3 b, dvec3 c, dvec3 d) const { return {{point(a), point(b), point(c), point(d)}}; }
};

// A ring of squares that is bent into a wave, with the wave's normals.
TriangleMesh wave(const Place& place) {
    TriangleMesh mesh;
    std::vector<dvec3> positions;
    for (uint32_t i = 0; i <= 12; ++i) {
        for (uint32_t k = 0; k <= 4; ++k) {
            const double x = 0.1 + 0.8 * i / 12;
            positions.push_back(place.point(dvec3(x, 0.05 + 0.03 * std::sin(9 * x), 0.1 + 0.05 * k)));
            mesh.normals.emplace_back(place.turn * dvec3(-0.27 * std::cos(9 * x), 1, 0));
        }
    }
    set_positions(mesh, std::move(positions));
    for (uint32_t i = 0; i < 12; ++i) {
        for (uint32_t k = 0; k < 4; ++k)
            add_polygon(mesh, std::array{5 * i + k, 5 * i + k + 1, 5 * i + k + 6, 5 * i + k + 5});
    }
    return mesh;
}

// Two triangles of a quad.
void add_triangles(TriangleMesh& mesh, uvec4 q) {
    mesh.triangles.emplace_back(q.x, q.y, q.z);
    mesh.triangles.emplace_back(q.x, q.z, q.w);
}

// Every kind of primitive, light and material, smooth normals, a medium, a lens, a sky; a lamp 1 mm under the
// ceiling of a room of 1 m.
Scene room(const Place& place) {
    Scene scene;
    const double s = place.scale;
    const uint32_t white = add_diffuse(scene, vec3(0.7f));
    const uint32_t red = add_diffuse(scene, vec3(0.6f, 0.1f, 0.1f));
    const uint32_t black = add_diffuse(scene, vec3(0));
    const uint32_t metal = add_material(scene, ConductorMaterial{vec3(0.9f, 0.7f, 0.4f), 0.2f});
    const uint32_t leaf =
        add_material(scene, DiffuseTransmissionMaterial{vec3(0.3f), vec3(0.5f, 0.4f, 0.3f)});
    const uint32_t glass =
        add_material(scene, DielectricMaterial{.inside = {vec3(dvec3(2.0, 0.5, 1.0) / s)}});
    const auto add = [&](dvec3 a, dvec3 b, dvec3 c, dvec3 d, uint32_t material,
                         std::optional<Emission> emission = {}) {
        add_shape(scene, place.quad(a, b, c, d), material, emission);
    };
    add({0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}, white);
    add({0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, white);
    add({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, white);
    add({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, red);
    add({1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}, white);
    add({0.3, 0.999, 0.3}, {0.7, 0.999, 0.3}, {0.7, 0.999, 0.7}, {0.3, 0.999, 0.7}, black,
        Emission{vec3(8, 7, 6), false});
    add({0.2, 0.3, 0.5}, {0.5, 0.35, 0.5}, {0.5, 0.6, 0.4}, {0.2, 0.55, 0.4}, leaf);
    add({0.1, 0, 0.7}, {0.4, 0, 0.7}, {0.4, 0.3, 0.7}, {0.1, 0.3, 0.7}, metal);
    add_shape(scene, Sphere{place.point({0.7, 0.2, 0.6}), 0.2 * s}, glass);
    add_shape(scene, Sphere{place.point({0.15, 0.8, 0.3}), 0.04 * s}, black, Emission{vec3(9), false});
    add_shape(scene,
              Disk{place.point({0.5, 0.7, 0.05}), place.vector({0.1, 0.01, 0}), place.vector({0, 0.1, 0.02})},
              black, Emission{vec3(2), true});
    add_shape(scene, wave(place), white);
    scene.lights = {{"", PointLight{place.point({0.8, 0.6, 0.9}), vec3(float(0.2 * s * s))}},
                    {"", SpotLight{place.point({0.5, 0.9, 1.2}),
                                   place.vector({-0.2, -0.8, -0.7}),
                                   vec3(float(0.5 * s * s)),
                                   {0.2f, 0.4f}}},
                    {"", DirectionalLight{place.vector({0.3, -0.3, -1}), vec3(0.3f, 0.2f, 0.1f)}}};
    Camera camera;
    camera.position = place.point({0.5, 0.5, 2.2});
    camera.look_at = place.point({0.5, 0.45, 0.5});
    camera.up = vec3(place.turn * dvec3(0, 1, 0));
    camera.vertical_fov = 0.6f;
    camera.lens = {.radius = float(0.01 * s), .focal_distance = float(1.7 * s)};
    scene.cameras.push_back(camera);
    scene.environment = constant_environment(vec3(0.2f, 0.3f, 0.5f));
    return scene;
}

class ScaleTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 64;

    Accumulation render_room(const Place& place, uint32_t spp, uint32_t seed = 1) const {
        return render(room(place), independent_settings(SIZE, Estimator::mis, seed), spp);
    }

    double mean_of_room(const Place& place) const {
        const Image image = image_of(render_room(place, 32));
        return image_mean(image, 0).mean + image_mean(image, 1).mean + image_mean(image, 2).mean;
    }

    std::vector<float> positions_of_room(const Place& place) const {
        const Scene scene = room(place);
        Renderer renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings_for(SIZE, SIZE));
        return renderer.positions();
    }
};

TEST_F(ScaleTest, APowerOfTwoChangesNoBit) {
    const Accumulation first = render_room({}, 2);
    const std::vector<float> positions = positions_of_room({});
    for (const int exponent : {-30, -13, 1, 30}) {
        const Place place{.scale = std::ldexp(1.0, exponent)};
        EXPECT_TRUE(render_room(place, 2).values == first.values) << "at 2^" << exponent;
        const std::vector<float> scaled = positions_of_room(place);
        for (size_t i = 0; i < positions.size(); ++i)
            ASSERT_EQ(scaled[i], std::ldexp(positions[i], exponent)) << "at 2^" << exponent;
    }
}

// With the same seed, the pictures differ by rounding, and by the few paths that it sends elsewhere.
TEST_F(ScaleTest, TheMeanStaysAtAnyScaleAndPlace) {
    const double first = mean_of_room({});
    for (const double scale : {1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 0.1, 1e3, 1e6})
        EXPECT_NEAR(mean_of_room({.scale = scale}) / first, 1.0, 1e-4) << "at a scale of " << scale;
    for (const double shift : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7})
        EXPECT_NEAR(mean_of_room({.shift = dvec3(shift, -0.3 * shift, 0.7 * shift)}) / first, 1.0, 1e-4)
            << "moved by " << shift;
    EXPECT_NEAR(mean_of_room({.scale = 1e-6, .shift = dvec3(1e7, 0, 1e7)}) / first, 1.0, 1e-4);
}

// Frames around normals turn with the room, but not every number does: the samples are others.
TEST_F(ScaleTest, ThePictureStaysHoweverTheRoomIsTurned) {
    const uint32_t spp = sized(test_effort(), 256);
    const Image first = image_of(render_room({}, spp));
    uint32_t seed = 2;
    for (const dvec3 axis : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)}) {
        SCOPED_TRACE(seed);
        const auto turn = glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(90.0), axis));
        expect_same_expectation(first, image_of(render_room({.turn = turn}, spp, seed++)));
    }
}

// The camera is rounded once, when it is in the frame: so is what it sees.
TEST_F(ScaleTest, PositionsAreThoseOfTheWorld) {
    const Place place{.scale = 1e-3, .shift = dvec3(4e6, 0, -1e6)};
    const std::vector<float> here = positions_of_room({});
    const std::vector<float> there = positions_of_room(place);
    size_t hits = 0;
    for (size_t i = 0; i < here.size(); i += 4) {
        if (here[i + 3] == INFINITE) continue;
        ++hits;
        const vec3 expected(place.point(dvec3(here[i], here[i + 1], here[i + 2])));
        // Half a step of the world's floats, and the rounding of either frame.
        const vec3 step = 0x1p-23f * abs(expected) + 1e-3f * 1e-6f;
        for (glm::length_t c = 0; c < 3; ++c)
            ASSERT_NEAR(there[i + size_t(c)], expected[c], step[c]);
        ASSERT_NEAR(there[i + 3], 1e-3f * here[i + 3], 1e-9f);
    }
    EXPECT_GT(hits, here.size() / 8);
}

// A sheet of paper just above a floor: light that falls at 45 degrees throws its shadow as far beyond its
// edge as it lies high.
class FloorTest : public RenderTest {
  protected:
    // Radiance of the floor, seen from straight above, at places beyond the sheet's edge [m]. The floor is
    // turned about `axis` by `angle`, and everything with it.
    std::vector<float> floor_beyond_the_sheet(double floor_size, dvec3 axis, double angle, double gap,
                                              const std::vector<double>& places) const {
        const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), angle, axis));
        const Place place{.turn = turn};
        Scene scene;
        const uint32_t white = add_diffuse(scene, vec3(1));
        const double h = 0.5 * floor_size;
        add_shape(scene, place.quad({-h, 0, h}, {h, 0, h}, {h, 0, -h}, {-h, 0, -h}), white);
        // The sheet ends at x = 0.
        add_shape(scene, place.quad({-1, gap, 1}, {0, gap, 1}, {0, gap, -1}, {-1, gap, -1}), white);
        add_shape(scene, place.quad({-5.1, 5, -0.1}, {-5.1, 5, 0.1}, {-4.9, 5.1, 0.1}, {-4.9, 5.1, -0.1}),
                  white, Emission{vec3(1000), true});
        std::vector<float> values;
        for (const double x : places) {
            Camera camera;
            camera.position = place.point({x, 3, 0});
            camera.look_at = place.point({x, 0, 0});
            camera.up = vec3(turn * dvec3(0, 0, -1));
            camera.vertical_fov = 1e-6f;
            scene.cameras = {camera};
            RenderSettings settings = settings_for(8, 8);
            settings.max_depth = 1;
            const Image image = image_of(render(scene, settings, 16));
            values.push_back(float(image_mean(image, 0).mean));
        }
        return values;
    }
};

TEST_F(FloorTest, ASheetOfPaperHasItsOwnShadowAndTheFloorHasNone) {
    struct Case {
        double floor_size;
        double angle;
        double gap;
    };
    for (const auto& [floor_size, angle, gap] :
         {Case{10, 0, 1e-4}, Case{10, 0.3, 1e-4}, Case{1e2, 0, 1e-4}, Case{1e2, 0.3, 1e-3},
          Case{1e4, 0, 1e-4}, Case{1e4, 0.3, 0.05}, Case{1e5, 0, 1e-3}, Case{1e5, 0.3, 0.5}}) {
        SCOPED_TRACE(floor_size);
        // The shadow ends about `gap` beyond the sheet.
        const std::vector<float> values = floor_beyond_the_sheet(floor_size, normalize(dvec3(1, 0, 2)), angle,
                                                                 gap, {0.4 * gap, 2.5 * gap, 1.5});
        EXPECT_LT(values[0], 0.02f * values[2]);
        EXPECT_GT(values[1], 0.9f * values[2]);
    }
}

// Ten thousand cubes of 1 m on a plain of 10 km, seen next to the one in the corner: as if only those nearby
// were there, and that one were the origin.
TEST_F(ScaleTest, CubesOnAPlainOfTenKilometresLookAlike) {
    const auto plain = [](dvec3 corner, double reach) {
        Scene scene = scene_with_camera(corner + dvec3(2.2, 1.5, 3), corner + dvec3(0, 0.4, 0), 0.6f);
        const uint32_t white = add_diffuse(scene, vec3(0.7f));
        const uint32_t brown = add_diffuse(scene, vec3(0.7f, 0.4f, 0.2f));
        add_shape(scene, parallelogram(corner + dvec3(-50, 0, 9950), dvec3(10000, 0, 0), dvec3(0, 0, -10000)),
                  white);
        TriangleMesh cubes;
        std::vector<dvec3> positions;
        for (double x = 0; x <= reach; x += 100) {
            for (double z = 0; z <= reach; z += 100) {
                const auto first = uint32_t(positions.size());
                for (unsigned i = 0; i < 8; ++i) {
                    positions.push_back(
                        corner + dvec3(x + (i & 1u ? 0.5 : -0.5), i & 2u ? 1 : 0, z + (i & 4u ? 0.5 : -0.5)));
                }
                for (const uvec4 side : {uvec4(0, 4, 6, 2), uvec4(1, 3, 7, 5), uvec4(2, 6, 7, 3),
                                         uvec4(0, 2, 3, 1), uvec4(4, 5, 7, 6)})
                    add_triangles(cubes, first + side);
            }
        }
        set_positions(cubes, std::move(positions));
        add_shape(scene, std::move(cubes), brown);
        scene.environment = constant_environment(vec3(0.5f));
        return scene;
    };
    const uint32_t spp = sized(test_effort(), 256);
    const Scene many = plain(dvec3(-4950, 0, -4950), 9900);
    EXPECT_EQ(triangle_count(many), 2u + 100 * 100 * 10);
    const Scene few = plain(dvec3(0), 1500);
    expect_same_expectation(image_of(render(many, independent_settings(SIZE, Estimator::mis, 1), spp)),
                            image_of(render(few, independent_settings(SIZE, Estimator::mis, 2), spp)));
}

// A ring of 1 mm on a floor of 100 m, away from its middle: as on a floor of 10 cm.
TEST_F(ScaleTest, ARingOfAMillimetreLiesOnAFloorOfAHundredMetres) {
    const auto ring = [](dvec3 at, double floor_size) {
        Scene scene = scene_with_camera(at + dvec3(0.002, 0.0015, 0.003), at + dvec3(0, 0.0001, 0), 0.5f);
        const uint32_t white = add_diffuse(scene, vec3(0.7f));
        const uint32_t gold = add_diffuse(scene, vec3(0.7f, 0.5f, 0.2f));
        const double h = 0.5 * floor_size;
        add_shape(scene, parallelogram(dvec3(-h, 0, h), dvec3(2 * h, 0, 0), dvec3(0, 0, -2 * h)), white);
        constexpr uint32_t AROUND = 24, ACROSS = 8;
        TriangleMesh mesh;
        std::vector<dvec3> positions;
        for (uint32_t i = 0; i < AROUND; ++i) {
            for (uint32_t k = 0; k < ACROSS; ++k) {
                const double a = 2.0 * M_PI * i / AROUND, b = 2.0 * M_PI * k / ACROSS;
                const double radius = 5e-4 + 1.2e-4 * std::cos(b);
                positions.push_back(
                    at + dvec3(radius * std::cos(a), 1.2e-4 * (1.0 + std::sin(b)), radius * std::sin(a)));
                const uint32_t next = (i + 1) % AROUND * ACROSS, above = (k + 1) % ACROSS;
                add_triangles(mesh, {i * ACROSS + k, i * ACROSS + above, next + above, next + k});
            }
        }
        set_positions(mesh, std::move(positions));
        add_shape(scene, std::move(mesh), gold);
        scene.environment = constant_environment(vec3(1));
        return scene;
    };
    const uint32_t spp = sized(test_effort(), 256);
    const Image small =
        image_of(render(ring(dvec3(0), 0.1), independent_settings(SIZE, Estimator::mis, 1), spp));
    for (const dvec3 at : {dvec3(0), dvec3(30, 0, -20)}) {
        const Image large =
            image_of(render(ring(at, 100), independent_settings(SIZE, Estimator::mis, 2), spp));
        expect_same_expectation(small, large);
    }
}

}  // namespace
}  // namespace candela
