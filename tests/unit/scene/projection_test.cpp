// Where cameras show points.
#include "scene/projection.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace candela {
namespace {

using glm::dvec2;

constexpr uvec2 PICTURE(40, 20);

// It looks along -x from (1, 2, 3), with +z up.
Camera some_camera() {
    Camera camera;
    camera.position = {1, 2, 3};
    camera.look_at = {0, 2, 3};
    camera.up = {0, 0, 1};
    camera.vertical_fov = PI / 2;
    return camera;
}

// In the axes of that camera.
dvec3 direction(double right, double up, double forward) {
    return {-forward, right, up};
}

void expect_at(const std::optional<dvec2>& place, dvec2 expected) {
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->x, expected.x, 1e-6);
    EXPECT_NEAR(place->y, expected.y, 1e-6);
}

std::vector<Camera> some_cameras() {
    std::vector<Camera> cameras(6, some_camera());
    cameras[1].principal_offset = {0.25f, -0.5f};
    cameras[1].focal_ratio = 2.0f;
    cameras[2].panorama = Panorama{};
    cameras[3].panorama = Panorama{Mapping::fisheye, 0.9f * PI};
    cameras[4].panorama = Panorama{Mapping::equisolid, 1.2f * PI};
    cameras[4].principal_offset = {0.25f, -0.5f};
    cameras[5].ortho_height = 5.0;
    return cameras;
}

TEST(Projection, ShowsDirectionsInTheirPlaces) {
    const std::vector<Camera> cameras = some_cameras();
    const auto place = [&](size_t camera, dvec3 d) {
        return Projection(cameras[camera], PICTURE).place_of_direction(d);
    };
    // The upper edge of the picture is at 45 degrees.
    expect_at(place(0, direction(0, 2, 2)), {20, 0});
    expect_at(place(0, direction(-1, 0, 2)), {15, 10});
    // Pixels are half as wide, and the middle is a quarter of the height to the right, and half of it up.
    expect_at(place(1, direction(-1, 0, 2)), {20 + 5 - 10, 0});
    expect_at(place(2, direction(1, 0, 0)), {30, 10});
    expect_at(place(2, direction(0, 1, 1)), {20, 5});
    expect_at(place(3, direction(0, 1, 1)), {20, 10 - 10 * 45 / 81.0});
    expect_at(place(4, direction(1, 0, 0)), {25 + 10 * std::sin(PI / 4) / std::sin(0.3 * PI), 0});
    EXPECT_FALSE(place(0, direction(0, 0, -1)));
    EXPECT_FALSE(place(0, direction(1, 0, 0)));
    EXPECT_FALSE(place(2, dvec3(0)));
    EXPECT_FALSE(place(5, direction(0, 0, 1)));
    const Projection parallel(cameras[5], PICTURE);
    expect_at(parallel.place_of(dvec3(1, 2, 3) + direction(2.5, 1, -7)), {30, 6});
    expect_at(Projection(cameras[0], PICTURE).place_of(dvec3(1, 2, 3) + direction(0, 2, 2)), {20, 0});
}

TEST(Projection, SeesDirectionsWhereItShowsThem) {
    for (const Camera& camera : some_cameras()) {
        if (camera.ortho_height) continue;
        const Projection projection(camera, PICTURE);
        size_t seen = 0;
        for (int i = 0; i < 800; ++i) {
            const dvec2 place(i % 40 + 0.5, i / 40 + 0.5);
            const auto d = projection.direction_at(place);
            if (!d) continue;
            ++seen;
            expect_at(projection.place_of_direction(*d), place);
        }
        EXPECT_GT(seen, 100u);
    }
    EXPECT_FALSE(Projection(some_cameras()[3], PICTURE).direction_at({31, 10})) << "outside of the circle";
}

TEST(Projection, GoesTheShorterWayAround) {
    const std::vector<Camera> cameras = some_cameras();
    const Projection around(cameras[2], PICTURE), plane(cameras[0], PICTURE);
    EXPECT_EQ(around.way({39, 3}, {2, 4}), dvec2(3, 1));
    EXPECT_EQ(around.way({2, 4}, {39, 3}), dvec2(-3, -1));
    EXPECT_EQ(around.way({2, 4}, {12, 3}), dvec2(10, -1));
    EXPECT_EQ(plane.way({39, 3}, {2, 4}), dvec2(-37, 1));
}

}  // namespace
}  // namespace candela
