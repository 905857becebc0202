// Moving a camera by hand: what an orbit, a pan, a dolly and a flight keep, and the camera as JSON.
#include "view/camera_control.h"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

// Positions are a few metres, and a movement rounds some ten times.
constexpr float CAMERA_ROUNDING = 1e-5f;

void expect_near(dvec3 a, dvec3 b) {
    EXPECT_LT(length(a - b), CAMERA_ROUNDING)
        << a.x << ' ' << a.y << ' ' << a.z << ", not " << b.x << ' ' << b.y << ' ' << b.z;
}

// Two metres from the origin, looking at it along -Z.
Camera camera() {
    Camera camera;
    camera.name = "main";
    camera.position = dvec3(0, 0, 2);
    camera.look_at = dvec3(0);
    camera.vertical_fov = PI / 2;
    return camera;
}

// Where the pinhole camera shows a point: x to the right, y up, in heights of the picture from its centre.
vec2 shown_at(const Camera& camera, dvec3 point) {
    const dvec3 forward = normalize(camera.look_at - camera.position);
    const dvec3 right = normalize(cross(forward, dvec3(camera.up)));
    const dvec3 p = point - camera.position;
    const double height = 2.0 * std::tan(0.5 * double(camera.vertical_fov)) * dot(p, forward);
    return vec2(dot(p, right) / height, dot(p, cross(right, forward)) / height);
}

TEST(CameraControl, AQuarterOrbitComesFromTheSide) {
    Camera moved = camera();
    orbit(moved, PI / 2, 0.0f);
    expect_near(moved.position, dvec3(-2, 0, 0));  // What was in front is now to the right.
    expect_near(moved.look_at, dvec3(0));
    orbit(moved, -PI / 2, PI / 6);
    expect_near(moved.position, dvec3(0, 1, std::sqrt(3.0)));
}

TEST(CameraControl, AnOrbitKeepsItsDistanceAndCanBeUndone) {
    Camera moved = camera();
    moved.up = normalize(vec3(0.3f, 1.0f, -0.2f));
    const Camera before = moved;
    for (int i = 0; i < 100; ++i) {
        orbit(moved, 0.1f, 0.004f);
        EXPECT_NEAR(length(moved.position - moved.look_at), 2.0f, CAMERA_ROUNDING);
    }
    for (int i = 0; i < 100; ++i)
        orbit(moved, -0.1f, -0.004f);
    EXPECT_LT(length(moved.position - before.position), 100 * CAMERA_ROUNDING);
}

// Beyond a pole the picture would stand on its head, and at a pole it would have no right.
TEST(CameraControl, AnOrbitStopsBeforeThePoles) {
    for (const float direction : {1.0f, -1.0f}) {
        Camera moved = camera();
        for (int i = 0; i < 10; ++i)
            orbit(moved, 0.5f, direction);
        EXPECT_GT(moved.position.y * direction, 1.99f);
        EXPECT_LT(moved.position.y * direction, 2.0f);
        EXPECT_GT(length(cross(moved.look_at - moved.position, dvec3(moved.up))), 0.01f);
    }
}

TEST(CameraControl, APanMovesThePictureWithTheHand) {
    Camera moved = camera();
    moved.position = dvec3(1, 2, 3);
    moved.look_at = dvec3(-1, 0, 1);
    const dvec3 point = moved.look_at;
    pan(moved, vec2(0.25f, -0.125f));
    EXPECT_LT(length(shown_at(moved, point) - vec2(0.25f, -0.125f)), CAMERA_ROUNDING);
    EXPECT_NEAR(length(moved.look_at - moved.position), std::sqrt(12.0f), CAMERA_ROUNDING);
}

TEST(CameraControl, ADollyScalesTheDistanceAndNeverReachesIt) {
    Camera moved = camera();
    dolly(moved, 0.5f);
    expect_near(moved.position, dvec3(0, 0, 1));
    dolly(moved, 3.0f);
    expect_near(moved.position, dvec3(0, 0, 3));
    for (int i = 0; i < 1000; ++i)
        dolly(moved, 0.5f);
    EXPECT_GT(length(moved.look_at - moved.position), 0.0f);
    dolly(moved, 2.0f);
    EXPECT_TRUE(is_finite(vec3(moved.position)));
}

// Three metres of the world fill the height of its picture, at any distance.
TEST(CameraControl, AnOrthographicCameraPansAndZooms) {
    Camera moved = camera();
    moved.ortho_height = 3.0;
    pan(moved, vec2(0.25f, -0.5f));
    expect_near(moved.position, dvec3(-0.75, 1.5, 2));
    expect_near(moved.look_at, dvec3(-0.75, 1.5, 0));
    const Camera before = moved;
    dolly(moved, 0.5f);
    EXPECT_EQ(moved.ortho_height, 1.5);
    EXPECT_EQ(moved.position, before.position);
    for (const float factor : {0.5f, 2.0f}) {
        for (int i = 0; i < 1000; ++i)
            dolly(moved, factor);
        EXPECT_TRUE(*moved.ortho_height > 0.0 && is_finite(vec3(float(*moved.ortho_height))));
        std::string text = camera_json(moved, "far", uvec2(640, 480));
        text.insert(text.rfind('}'), R"(, "shapes": [])");
        SceneFolder folder;
        EXPECT_EQ(folder.load(text).cameras[0].ortho_height, moved.ortho_height);
    }
}

// It is read back for a film of the same shape, and of another size.
TEST(CameraControl, JsonHasThePrincipalPointAndBothFocalLengths) {
    Camera saved = camera();
    for (const float fov : {0.1f, 1.0f / 3, 2.9f}) {
        saved.vertical_fov = fov;
        saved.principal_offset = vec2(0.1f, -3.0f / 7);
        saved.focal_ratio = 1.01f;
        std::string text = camera_json(saved, "main", uvec2(1920, 1080));
        text.insert(text.rfind('}'), R"(, "film": {"size": [640, 360]}, "shapes": [])");
        SceneFolder folder;
        EXPECT_EQ(folder.load(text).cameras.at(0), saved) << text;
    }
}

TEST(CameraControl, JsonHasThePanoramaAndItsShift) {
    Camera saved = camera();
    saved.vertical_fov = 0.0f;
    for (const uvec2 size : {uvec2(1920, 1080), uvec2(360, 640)}) {
        for (const Mapping mapping : {Mapping::equirectangular, Mapping::fisheye, Mapping::equisolid}) {
            for (const float fov : {PI / 180.0f, PI, 1.0f / 3, 2.0f * PI}) {
                const bool has_circle = mapping != Mapping::equirectangular;
                saved.panorama = Panorama{mapping, has_circle ? fov : PI};
                saved.principal_offset = has_circle && fov > 1.0f ? vec2(0.1f, -3.0f / 7) : vec2(0.0f);
                std::string text = camera_json(saved, "main", size);
                text.insert(text.rfind('}'), R"(, "film": {"size": [)" + std::to_string(size.x) + ", " +
                                                 std::to_string(size.y) + "]}, \"shapes\": []");
                SceneFolder folder;
                EXPECT_EQ(folder.load(text).cameras.at(0), saved) << text;
            }
        }
    }
}

// Around the axis, at a distance of 2 m, the picture is 2 pi m high if it shows 180 degrees evenly; of an
// equisolid fisheye of that angle, 2 * 4 sin(45 degrees).
TEST(CameraControl, APanMovesAPanorama) {
    for (const auto& [mapping, height] :
         {std::pair(Mapping::equirectangular, 2 * M_PI), std::pair(Mapping::fisheye, 2 * M_PI),
          std::pair(Mapping::equisolid, 8 * std::sin(M_PI / 4))}) {
        Camera moved = camera();
        moved.vertical_fov = 0.0f;
        moved.panorama = Panorama{mapping};
        pan(moved, vec2(0.25f, 0.5f));
        EXPECT_NEAR(moved.look_at.x, -0.25 * height, 1e-6);
        EXPECT_NEAR(moved.look_at.y, -0.5 * height, 1e-6);
    }
}

TEST(CameraControl, APanMovesThePictureAsFarWithAnyPixels) {
    Camera moved = camera();
    moved.focal_ratio = 2.0f;
    pan(moved, vec2(0.25f, 0.25f));
    // The picture is 4 m high where the camera looks; along x, pixels show half as much.
    expect_near(moved.look_at, dvec3(-0.5, -1, 0));
}

TEST(CameraControl, AFlightGoesAlongTheCamerasAxes) {
    Camera moved = camera();
    orbit(moved, -PI / 2, 0.0f);  // Now it looks along -X, and its right is -Z.
    fly(moved, dvec3(1, 2, 3));
    expect_near(moved.position, dvec3(2 - 3, 2, -1));
    expect_near(moved.look_at, dvec3(-3, 2, -1));
}

// Numbers that no short decimal fraction equals, and a lens with everything that it can have.
TEST(CameraControl, TheLoaderReadsItsJsonBackBitForBit) {
    Camera saved = camera();
    saved.position = dvec3(1.0 / 3, -2e-7, 12345.678);
    saved.look_at = dvec3(std::nextafter(1.0, 2.0), 0.1, -3e5);
    saved.up = vec3(0.1f, 0.7f, 0.2f);
    for (const Lens& lens : {Lens{}, Lens{0.01f / 3, 7.1f, 0, 0.0f}, Lens{0.2f, 1e-3f, 6, 0.3f}}) {
        saved.lens = lens;
        for (const float fov : {0.1f, 0.686f, 1.0f / 3, 3.1f}) {
            saved.vertical_fov = fov;
            std::string text = camera_json(saved, "a \"view\"", uvec2(640, 480));
            text.insert(text.rfind('}'), R"(, "shapes": [])");
            SceneFolder folder;
            const Scene scene = folder.load(text);
            ASSERT_EQ(scene.cameras.size(), 1u);
            EXPECT_EQ(scene.cameras[0].name, "a \"view\"");
            Camera read = scene.cameras[0];
            read.name = saved.name;
            EXPECT_EQ(read, saved) << text;
        }
    }
    saved.lens = {};
    saved.vertical_fov = 0.0f;
    saved.ortho_height = 1.0 / 3;
    std::string text = camera_json(saved, "main", uvec2(640, 480));
    text.insert(text.rfind('}'), R"(, "shapes": [])");
    SceneFolder folder;
    EXPECT_EQ(folder.load(text).cameras.at(0), saved) << text;
}

}  // namespace
}  // namespace candela
