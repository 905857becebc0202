// How far what pixels show has moved, of motions that are told.
#include "render_fixture.h"

namespace candela {
namespace {

class MotionTest : public RenderTest {
  protected:
    std::vector<vec2> motion(const RenderSettings& settings, const Camera& before,
                             const SceneMotion& moved) const {
        const GpuScene gpu = build_gpu_scene(scene_);
        Renderer renderer(device(), gpu, scene_.cameras[0], settings);
        return renderer.motion(gpu, scene_.cameras[0], {before, std::make_shared<const SceneMotion>(moved)});
    }

    // A camera 4 m before a wall that is larger than its view, whose height there is 4 m.
    Scene scene_ = [] {
        Scene scene = scene_with_camera(dvec3(0, 0, 4), dvec3(0), 2.0f * std::atan(0.5f));
        const uint32_t grey = add_diffuse(scene, vec3(0.5f));
        scene.meshes.push_back(
            {.positions = {vec3(-9, -9, 0), vec3(9, -9, 0), vec3(0, 9, 0)}, .triangles = {uvec3(0, 1, 2)}});
        add_shape(scene, MeshInstance{0, {}}, grey);
        return scene;
    }();
};

// Of 16 pixels to 4 m, the wall moves by 1 m to the right and 0.5 m down.
TEST_F(MotionTest, IsTheWayThroughThePicture) {
    glm::dmat4 before(1.0);
    before[3] = glm::dvec4(-1.0, 0.5, 0.0, 1.0);
    const SceneMotion moved{.cameras = {}, .shapes = {{0, {.now = glm::dmat4(1.0), .before = before}}}};
    for (const vec2 m : motion(settings_for(16, 16), scene_.cameras[0], moved)) {
        EXPECT_NEAR(m.x, 4.0, 1e-5);
        EXPECT_NEAR(m.y, 2.0, 1e-5);
    }
}

TEST_F(MotionTest, OfACropIsThatOfTheWhole) {
    Camera before = scene_.cameras[0];
    before.position += dvec3(0.3, 0.2, 1.0);
    const std::vector<vec2> whole = motion(settings_for(16, 16), before, {});
    RenderSettings settings = settings_for(16, 16);
    settings.crop = {3, 5, 12, 14};
    const std::vector<vec2> crop = motion(settings, before, {});
    ASSERT_EQ(crop.size(), 81u);
    for (size_t i = 0; i < crop.size(); ++i)
        EXPECT_EQ(crop[i], whole[(5 + i / 9) * 16 + 3 + i % 9]);
    EXPECT_NE(crop[0], crop[80]);
}

// With the corners of its mesh: two of them stay, and the third moves.
TEST_F(MotionTest, OfAMeshThatDeformsIsThatOfItsPoints) {
    ShapeMotion deformed{.corners = {uvec3(0, 1, 2)}};
    for (const vec3 p : scene_.meshes[0].positions)
        deformed.positions_now.emplace_back(p);
    deformed.positions_before = deformed.positions_now;
    deformed.positions_before[2].x -= 2.0;
    const std::vector<vec2> all =
        motion(settings_for(16, 16), scene_.cameras[0], {.cameras = {}, .shapes = {{0, deformed}}});
    for (size_t i = 0; i < all.size(); ++i) {
        const double y =
            2.0 - (double(i / 16) + 0.5) / 4.0;  // Of the pixel's centre in the plane of the wall.
        EXPECT_NEAR(all[i].x, 4.0 * 2.0 * (y + 9.0) / 18.0, 1e-5);
        EXPECT_NEAR(all[i].y, 0.0, 1e-5);
    }
}

}  // namespace
}  // namespace candela
