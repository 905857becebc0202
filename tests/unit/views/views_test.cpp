// Cameras around a scene: where they are, and that all of it fits exactly into their pictures.
#include "views/views.h"

#include <random>

#include "probe/scenes.h"
#include "unit/views/views_fixture.h"

namespace candela {
namespace {

// A vertical field of view is rounded to a float once.
constexpr double FOV_ROUNDING = 1e-6;

Scene scene_of_points(const std::vector<vec3>& points) {
    Scene scene;
    add_diffuse(scene, vec3(0.5f));
    TriangleMesh mesh{.positions = points};
    for (uint32_t i = 2; i < points.size(); ++i)
        mesh.triangles.emplace_back(i - 2, i - 1, i);
    scene.meshes.push_back(mesh);
    scene.shapes.push_back({.geometry = MeshInstance{}, .emission = {}});
    return scene;
}

std::vector<vec3> random_points(dvec3 middle = dvec3(0)) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    std::vector<vec3> points;
    for (int i = 0; i < 200; ++i)
        points.push_back(vec3(middle) +
                         vec3(3, 1, 2) * vec3(uniform(engine), uniform(engine), uniform(engine)));
    return points;
}

// The rectangle of the picture that shows the points [pixels].
struct Shown {
    glm::dvec2 lo{1e9}, hi{-1e9};

    Shown(const Camera& camera, uvec2 size, const std::vector<vec3>& points) {
        for (const vec3 point : points) {
            const glm::dvec2 at = pixel_of(camera, size, dvec3(point));
            lo = min(lo, at);
            hi = max(hi, at);
        }
    }
};

TEST(Views, AllVerticesTouchTheFrameOnTwoSidesAndAreInTheMiddleOfTheOthers) {
    for (const dvec3 middle : {dvec3(0), dvec3(1000, -2000, 500)}) {
        const std::vector<vec3> points = random_points(middle);
        const Surroundings surroundings(scene_of_points(points));
        for (const uvec2 size : {uvec2(640, 480), uvec2(200, 700)}) {
            for (const double margin : {0.0, 0.05, 0.4}) {
                for (const double degrees : {10.0, 40.0, 120.0}) {
                    const ViewStyle style{size, VerticalFov{glm::radians(degrees)}, margin};
                    const Camera camera = surroundings.view("a", {0.5 + degrees, -0.7, margin}, style);
                    const Shown shown(camera, size, points);
                    const double free = margin * std::min(size.x, size.y);
                    const glm::dvec2 first(free), last(glm::dvec2(size) - free);
                    const double tolerance = FOV_ROUNDING * 700;
                    EXPECT_GE(std::min(shown.lo.x, shown.lo.y), free - tolerance);
                    EXPECT_LE(shown.hi.x, last.x + tolerance);
                    EXPECT_LE(shown.hi.y, last.y + tolerance);
                    for (const glm::length_t axis : {0, 1})
                        EXPECT_NEAR(shown.lo[axis] + shown.hi[axis], double(size[axis]), tolerance);
                    EXPECT_NEAR(std::min(shown.lo.x, shown.lo.y), free, tolerance);
                }
            }
        }
    }
}

TEST(Views, ASphereIsAsFarAsItsTangents) {
    Scene scene;
    add_diffuse(scene, vec3(0.5f));
    add_shape(scene, Sphere{.center = dvec3(1, 2, 3), .radius = 2.0}, 0);
    const double angle = glm::radians(30.0);
    const Camera camera =
        Surroundings(scene).view("a", {0.3, 0.4, 0.5}, {uvec2(200, 100), VerticalFov{2.0 * angle}, 0.0});
    EXPECT_NEAR(length(camera.position - dvec3(1, 2, 3)), 2.0 / std::sin(angle), FOV_ROUNDING * 4.0);
    expect_close(camera.look_at, dvec3(1, 2, 3), 1e-12);
}

// A disk is seen as an ellipse: from the front, as wide as high.
TEST(Views, DisksAndQuadsAreWhole) {
    Scene scene;
    add_diffuse(scene, vec3(0.5f));
    const ViewStyle style{uvec2(100, 100), VerticalFov{glm::radians(90.0)}, 0.0};
    add_shape(scene, Disk{dvec3(0), dvec3(2, 0, 0), dvec3(0, 2, 0)}, 0);
    expect_close(Surroundings(scene).view("a", {}, style).position, dvec3(0, 0, 2), 1e-4 * 2);
    scene.shapes.clear();
    add_shape(scene, parallelogram(dvec3(-3, -1, 0), dvec3(6, 0, 0), dvec3(0, 2, 0)), 0);
    expect_close(Surroundings(scene).view("a", {}, style).position, dvec3(0, 0, 3), FOV_ROUNDING * 3);
}

TEST(Views, AzimuthZeroIsTheFrontAndTurnsTowardsX) {
    const auto place = [](double azimuth, double elevation) {
        return -axes_towards({glm::radians(azimuth), glm::radians(elevation)}).forward;
    };
    expect_close(place(0, 0), dvec3(0, 0, 1), 1e-15);
    expect_close(place(90, 0), dvec3(1, 0, 0), 1e-15);
    expect_close(place(-90, 0), dvec3(-1, 0, 0), 1e-15);
    expect_close(place(0, 30), dvec3(0, 0.5, std::sqrt(0.75)), 1e-15);
    for (const double elevation : {-90.0, 90.0}) {
        const CameraAxes axes = axes_towards({glm::radians(90.0), glm::radians(elevation)});
        expect_close(-axes.forward, dvec3(0, elevation / 90.0, 0), 1e-15);
        expect_close(axes.right, dvec3(0, 0, -1), 1e-15);
    }
    // Turned clockwise, its right points down, and its up to the right.
    const CameraAxes rolled = axes_towards({.roll = glm::radians(90.0)});
    expect_close(rolled.right, dvec3(0, -1, 0), 1e-15);
    expect_close(rolled.up, dvec3(1, 0, 0), 1e-15);
    expect_close(rolled.forward, dvec3(0, 0, -1), 1e-15);
}

TEST(Views, TheLensIsAnAngleOrAFocalLengthOfTheLongerSide) {
    const auto degrees = [](uvec2 size, decltype(ViewStyle::lens) lens) {
        return glm::degrees(double(vertical_fov({.size = size, .lens = lens})));
    };
    // The tables of makers of lenses: 50 mm sees 39.6 degrees of the 36 mm, and 27.0 of the 24 mm.
    EXPECT_NEAR(degrees({300, 200}, FocalLength{50}), 27.0, 0.05);
    EXPECT_NEAR(degrees({200, 300}, FocalLength{50}), 39.6, 0.05);
    EXPECT_NEAR(degrees({200, 200}, FocalLength{50}), 39.6, 0.05);
    EXPECT_NEAR(degrees({300, 200}, FocalLength{35}), 37.8, 0.05);
    EXPECT_NEAR(degrees({300, 200}, VerticalFov{glm::radians(40.0)}), 40.0, 1e-5);
}

TEST(Views, ATurntableHoldsAllAtEveryAzimuthFromOneDistance) {
    const std::vector<vec3> points = random_points();
    const Surroundings surroundings(scene_of_points(points));
    const ViewStyle style{uvec2(300, 200), FocalLength{35}, 0.0};
    for (const double elevation : {-0.5, 0.0, 0.4, 1.3}) {
        const std::vector<Camera> cameras = surroundings.turntable(360, elevation, style);
        ASSERT_EQ(cameras.size(), 360u);
        const dvec3 axis = shown_bodies(scene_of_points(points)).origin;
        double widest = 0.0;  // How close points come to the frame, in halves of its sides.
        for (size_t i = 0; i < cameras.size(); ++i) {
            const Shown shown(cameras[i], style.size, points);
            const glm::dvec2 reach =
                max(abs(shown.lo / glm::dvec2(150, 100) - 1.0), abs(shown.hi / glm::dvec2(150, 100) - 1.0));
            widest = std::max({widest, reach.x, reach.y});
            const dvec3 out = cameras[i].position - axis;
            EXPECT_NEAR(std::remainder(std::atan2(out.x, out.z) - glm::radians(double(i)), 2.0 * M_PI), 0.0,
                        1e-12);
            EXPECT_NEAR(length(out), length(cameras[0].position - axis), 1e-9);
        }
        EXPECT_LE(widest, 1.0 + FOV_ROUNDING);
        EXPECT_GE(widest, 1.0 - 1e-3);  // A degree off the extreme, a point is within 2e-4 of it.
        EXPECT_EQ(surroundings.turntable(4, elevation, style)[1].position, cameras[90].position);
    }
    const std::vector<Camera> few = surroundings.turntable(12, 0.0, style);
    EXPECT_EQ(few[0].name, "turntable_000");
    EXPECT_EQ(few[11].name, "turntable_011");
    EXPECT_EQ(surroundings.turntable(10001, 0.0, style)[7].name, "turntable_00007");
}

TEST(Views, ADomeIsSpreadEvenlyOverTheUpperHalf) {
    const std::vector<vec3> points = random_points(dvec3(5, 6, 7));
    const Surroundings surroundings(scene_of_points(points));
    const dvec3 middle = shown_bodies(scene_of_points(points)).origin;
    double radius = 0.0;
    for (const vec3 p : points)
        radius = std::max(radius, length(dvec3(p) - middle));
    constexpr uint32_t COUNT = 100;
    const double angle = glm::radians(20.0);
    const std::vector<Camera> cameras =
        surroundings.dome(COUNT, {uvec2(100, 100), VerticalFov{2.0 * angle}, 0.0});
    ASSERT_EQ(cameras.size(), COUNT);
    EXPECT_EQ(cameras[99].name, "dome_099");
    std::vector<dvec3> directions;
    dvec3 mean(0);
    for (const Camera& camera : cameras) {
        EXPECT_NEAR(length(camera.position - middle), radius / std::sin(angle), 10 * FOV_ROUNDING * radius);
        expect_close(normalize(camera.look_at - camera.position), normalize(middle - camera.position), 1e-12);
        directions.push_back(normalize(camera.position - middle));
        EXPECT_GT(directions.back().y, 0.0);
        mean += directions.back() / double(COUNT);
    }
    expect_close(mean, dvec3(0, 0.5, 0), 0.02);  // As of the half sphere.
    // Each has a share of 2 pi / COUNT. In the closest packing, of hexagons, neighbours would be 1.07 of its
    // root apart.
    for (size_t i = 0; i < COUNT; ++i) {
        double nearest = 2.0;
        for (size_t k = 0; k < COUNT; ++k) {
            if (k != i) nearest = std::min(nearest, length(directions[i] - directions[k]));
        }
        EXPECT_GT(nearest, 0.75 * std::sqrt(2.0 * M_PI / COUNT));
        EXPECT_LT(nearest, 1.2 * std::sqrt(2.0 * M_PI / COUNT));
    }
}

TEST(Views, WhatIsNotShownDoesNotMatter) {
    std::vector<vec3> points = random_points();
    Scene scene = scene_of_points(points);
    const Camera before = Surroundings(scene).view("a", {}, {});
    scene.meshes[0].positions.emplace_back(100, 0, 0);  // No triangle has it.
    EXPECT_EQ(Surroundings(scene).view("a", {}, {}), before);
    Material glass{.name = "nothing", .model = DiffuseMaterial{}};
    glass.opacity.value = 0.0f;
    scene.materials.push_back(glass);
    add_shape(scene, Sphere{.center = dvec3(0), .radius = 50.0}, 1);
    EXPECT_EQ(Surroundings(scene).view("a", {}, {}), before);
    scene.materials[1].opacity = {.value = 0.4f, .cutoff = 0.5f};
    EXPECT_EQ(Surroundings(scene).view("a", {}, {}), before);
    scene.materials[1].opacity = {.value = 0.6f, .cutoff = 0.5f};
    EXPECT_NE(Surroundings(scene).view("a", {}, {}), before);
}

TEST(Views, ASceneThatShowsNothingIsSeenAsASphere) {
    Scene scene;
    const ViewStyle style{uvec2(100, 100), VerticalFov{glm::radians(60.0)}, 0.0};
    expect_close(Surroundings(scene).view("a", {}, style).position, dvec3(0, 0, 2), 1e-6);
    const Scene point = scene_of_points({vec3(1, 2, 3), vec3(1, 2, 3), vec3(1, 2, 3)});
    expect_close(Surroundings(point).view("a", {}, style).position, dvec3(1, 2, 5), 1e-6);
}

// Many copies of a mesh are replaced by their boxes: all is in the picture, if not as close.
TEST(Views, ManyCopiesAreInThePicture) {
    std::vector<vec3> points;
    for (int i = 0; i < 30; ++i) {
        const std::vector<vec3> more = random_points();
        points.insert(points.end(), more.begin(), more.end());
    }
    Scene scene = scene_of_points(points);
    for (int i = 1; i < 400; ++i) {
        MeshInstance copy;
        ASSERT_TRUE(copy.transform.append(
            glm::dmat4(dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0), dvec4(10 * i, 0, 0, 1))));
        scene.shapes.push_back({.geometry = copy, .emission = {}});
    }
    EXPECT_LT(shown_bodies(scene).bodies.size(), size_t{200} * points.size());
    const Camera camera = Surroundings(scene).view("a", {.elevation = 0.3}, {});
    std::vector<vec3> ends;
    for (const vec3 p : random_points()) {
        ends.push_back(p);
        ends.push_back(p + vec3(3990, 0, 0));
    }
    const Shown shown(camera, ViewStyle().size, ends);
    EXPECT_GE(shown.lo.x, 0.05 * 512 - 1e-3);
    EXPECT_LE(shown.hi.x, 0.95 * 512 + 1e-3);
}

}  // namespace
}  // namespace candela
