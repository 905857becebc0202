// Surfaces that a camera sees from behind: how much of the picture they are, against known squares.
#include "scene/seen_from_behind.h"

#include <gtest/gtest.h>

#include "probe/scenes.h"
#include "scene/materials.h"

namespace candela {
namespace {

constexpr uvec2 SIZE(256, 128);

// A camera that sees 4 x 2 metres of the plane z = 0, either in perspective or with parallel rays; the
// materials 0, single-sided, and 1, double-sided.
Scene scene_seen(bool parallel) {
    Scene scene = scene_with_camera(dvec3(0, 0, 1), dvec3(0), 2.0f * std::atan(1.0f));
    if (parallel) scene.cameras[0].ortho_height = 2.0;
    scene.materials.clear();
    for (const bool double_sided : {false, true})
        add_material(scene, PrincipledMaterial{.double_sided = double_sided});
    return scene;
}

// A square of edge 1 around that place, which faces the camera or not, and may be mirrored by its instance.
void add_square(Scene& scene, vec3 middle, bool faces, uint32_t material, bool mirrored = false) {
    TriangleMesh mesh;
    const float x = faces ? 0.5f : -0.5f;
    add_triangle(mesh, vec3(-x, -0.5f, 0), vec3(x, -0.5f, 0), vec3(x, 0.5f, 0));
    add_triangle(mesh, vec3(-x, -0.5f, 0), vec3(x, 0.5f, 0), vec3(-x, 0.5f, 0));
    add_shape(scene, mesh, material);
    glm::dmat4 step(1.0);
    if (mirrored) step[0][0] = -1.0;
    step[3] = glm::dvec4(middle.x, middle.y, middle.z, 1.0);
    ASSERT_TRUE(std::get<MeshInstance>(scene.shapes.back().geometry).transform.append(step));
}

double share(const Scene& scene) {
    return share_seen_from_behind(scene, scene.cameras[0], SIZE).value();
}

TEST(SeenFromBehind, IsNotSoughtInAPanorama) {
    Scene scene = scene_seen(false);
    add_square(scene, vec3(0), false, 0);
    scene.cameras[0].panorama.emplace();
    EXPECT_FALSE(share_seen_from_behind(scene, scene.cameras[0], SIZE));
}

TEST(SeenFromBehind, IsTheShareOfThePicture) {
    for (const bool parallel : {false, true}) {
        for (const bool mirrored : {false, true}) {
            SCOPED_TRACE(testing::Message() << parallel << mirrored);
            Scene scene = scene_seen(parallel);
            add_square(scene, vec3(-1, 0, 0), true, 0, mirrored);
            EXPECT_EQ(share(scene), 0.0);
            add_square(scene, vec3(1, 0, 0), false, 0, mirrored);
            EXPECT_DOUBLE_EQ(share(scene), 1.0 / 8.0);
            // Something in front of a half of it.
            add_square(scene, vec3(1.5, 0, 0.1), true, 1);
            if (parallel) {
                EXPECT_DOUBLE_EQ(share(scene), 1.0 / 16.0);
            }
            make_double_sided(scene);
            EXPECT_EQ(share_seen_from_behind(scene, scene.cameras[0], SIZE), std::nullopt);
        }
    }
}

// The floor reaches behind the camera. It hides half of what is seen of the square.
TEST(SeenFromBehind, AFloorUnderTheCameraHidesWhatIsBelow) {
    Scene scene = scene_seen(false);
    add_square(scene, vec3(0, -1, 0), false, 0);
    EXPECT_DOUBLE_EQ(share(scene), 1.0 / 16.0);  // Its upper half; the rest is below the picture.
    add_shape(scene, parallelogram(vec3(-9, -0.75, 9), vec3(18, 0, 0), vec3(0, 0, -18)), 1);
    EXPECT_DOUBLE_EQ(share(scene), 1.0 / 32.0);
}

TEST(SeenFromBehind, FollowsThePrincipalPointAndBothFocalLengths) {
    Scene scene = scene_seen(false);
    add_square(scene, vec3(0, -1, 0), false, 0);
    Camera& camera = scene.cameras[0];
    camera.principal_offset = vec2(0, -0.25f);  // Upwards, so that all of it is seen,
    camera.focal_ratio = 2.0f;                  // twice as wide.
    EXPECT_DOUBLE_EQ(share(scene), 1.0 / 4.0);
}

TEST(SeenFromBehind, ClosedAndTransparentSolidsAreNotHollow) {
    Scene scene = scene_seen(false);
    add_shape(scene, sphere_mesh(8, 16), 0);
    scene.cameras[0].position = dvec3(0, 0, 5);
    EXPECT_EQ(share(scene), 0.0);
    std::get<PrincipledMaterial>(scene.materials[0].model).inside = Medium{};
    EXPECT_EQ(share_seen_from_behind(scene, scene.cameras[0], SIZE), std::nullopt);
}

TEST(SeenFromBehind, DoubleSidedSurfacesEmitFromBothSides) {
    Scene scene = scene_seen(false);
    add_square(scene, vec3(0), false, 0);
    scene.shapes[0].emission = Emission{};
    make_double_sided(scene);
    EXPECT_TRUE(scene.shapes[0].emission->two_sided);
    EXPECT_FALSE(is_culled(scene.materials[0]));
}

}  // namespace
}  // namespace candela
