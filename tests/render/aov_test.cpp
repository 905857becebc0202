// The images besides the colours: albedo and normal of the first hit; position, depth and distance of the
// pixel's centre.
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

// A camera at z = 3 looks down -z at a square in the plane z = 0 that covers the left half of the picture.
Scene half_covered() {
    Scene scene = scene_with_camera(dvec3(0, 0, 3), dvec3(0), 2.0f * std::atan(1.0f / 3.0f));
    add_diffuse(scene, vec3(0.1f, 0.2f, 0.3f));
    scene.shapes.push_back({.geometry = parallelogram(vec3(-2, -2, 0), vec3(2, 0, 0), vec3(0, 4, 0)),
                            .material = 0,
                            .emission = {}});
    return scene;
}

class AovTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 20;  // Film positions -1 .. 1 m in the plane z = 0.

    static RenderSettings settings() {
        RenderSettings s = settings_for(SIZE, SIZE);
        s.aovs = true;
        return s;
    }
};

TEST_F(AovTest, AlbedoNormalAndCoverageAreThoseOfTheFirstHit) {
    const Image image =
        make_image(render(half_covered(), settings(), 16), {.albedo = true, .normal = true}, {});
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const float covered = i % SIZE < SIZE / 2 ? 1.0f : 0.0f;
        ASSERT_EQ(image.find("A")->values[i], covered);
        ASSERT_FLOAT_EQ(image.find("Albedo.R")->values[i], 0.1f * covered);
        ASSERT_FLOAT_EQ(image.find("Albedo.G")->values[i], 0.2f * covered);
        ASSERT_FLOAT_EQ(image.find("Albedo.B")->values[i], 0.3f * covered);
        ASSERT_EQ(image.find("N.X")->values[i], 0.0f);
        ASSERT_EQ(image.find("N.Y")->values[i], 0.0f);
        ASSERT_EQ(image.find("N.Z")->values[i], covered);
    }
}

TEST_F(AovTest, NormalsFaceTheViewer) {
    Scene scene = half_covered();
    scene.shapes[0].geometry = parallelogram(vec3(-2, -2, 0), vec3(0, 4, 0), vec3(2, 0, 0));
    const Image image = make_image(render(scene, settings(), 1), {.normal = true}, {});
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        ASSERT_EQ(image.find("N.Z")->values[i], i % SIZE < SIZE / 2 ? 1.0f : 0.0f);
    }
}

// A unit sphere whose normals are its positions: interpolated ones point away from the centre.
TEST_F(AovTest, NormalsAreInterpolated) {
    Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.2f);
    add_diffuse(scene, vec3(0.5f));
    TriangleMesh ball = sphere_mesh(16, 16);
    ball.normals = ball.positions;
    add_shape(scene, ball, 0);
    const GpuScene gpu = build_gpu_scene(scene);
    Renderer renderer(device(), gpu, scene.cameras[0], settings());
    ASSERT_TRUE(renderer.render(64, [](double) { return true; }));
    const std::vector<float> positions = renderer.positions();
    const Image image = make_image(renderer.download(), {.normal = true}, {});
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const vec3 p(positions[4 * i], positions[4 * i + 1], positions[4 * i + 2]);
        const vec3 n(image.find("N.X")->values[i], image.find("N.Y")->values[i],
                     image.find("N.Z")->values[i]);
        // Within a triangle of the sphere, the interpolated normal differs from the direction of the position
        // by less than the square of half its edge (0.4 / 2). The mean over a pixel of 5 cm adds the turn of
        // the normal over half a pixel.
        ASSERT_LT(length(n - normalize(p)), 0.04f + 0.025f) << i;
        ASSERT_GT(length(n), 0.99f);
    }
}

// Centres of pixels are known in closed form; the position is rounded at 2^-24 of some metres, a few times
// over.
TEST_F(AovTest, PositionAndDepthAreThoseOfThePixelsCentre) {
    const Scene scene = half_covered();
    Renderer renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings());
    const std::vector<float> positions = renderer.positions();
    for (uint32_t y = 0; y < SIZE; ++y) {
        for (uint32_t x = 0; x < SIZE; ++x) {
            const float* at = &positions[(size_t(y) * SIZE + x) * 4];
            if (x >= SIZE / 2) {
                ASSERT_EQ(at[3], INFINITE);
                for (const int c : {0, 1, 2})
                    ASSERT_EQ(at[c], 0.0f);
                continue;
            }
            ASSERT_NEAR(at[0], (double(x) + 0.5) / 10.0 - 1.0, 2e-6);
            ASSERT_NEAR(at[1], 1.0 - (double(y) + 0.5) / 10.0, 2e-6);
            ASSERT_NEAR(at[2], 0.0, 2e-6);
            ASSERT_NEAR(at[3], 3.0, 2e-6);  // Along the axis, not along the ray.
        }
    }
}

// The length of the ray to that position; for parallel rays, the depth.
TEST_F(AovTest, DistancesAreAlongTheRays) {
    Scene scene = half_covered();
    const std::vector<float> distances =
        Renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings()).distances();
    ASSERT_EQ(distances.size(), size_t{SIZE} * SIZE);
    for (uint32_t i = 0; i < SIZE * SIZE; ++i) {
        const double x = (i % SIZE + 0.5) / 10.0 - 1.0, y = 1.0 - (i / SIZE + 0.5) / 10.0;
        if (x > 0.0) {
            ASSERT_EQ(distances[i], INFINITE);
        } else {
            ASSERT_NEAR(distances[i], std::sqrt(9.0 + x * x + y * y), 2e-6);
        }
    }
    scene.cameras[0].ortho_height = 2.0;
    const std::vector<float> parallel =
        Renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings()).distances();
    EXPECT_NEAR(parallel[0], 3.0, 2e-6);
}

TEST_F(AovTest, PositionsOfACropAreThoseOfTheWhole) {
    const Scene scene = half_covered();
    const GpuScene gpu = build_gpu_scene(scene);
    const std::vector<float> whole = Renderer(device(), gpu, scene.cameras[0], settings()).positions();
    RenderSettings s = settings();
    s.crop = {3, 5, 17, 9};
    const std::vector<float> part = Renderer(device(), gpu, scene.cameras[0], s).positions();
    for (uint32_t y = 0; y < 4; ++y) {
        for (uint32_t x = 0; x < 14 * 4; ++x) {
            ASSERT_EQ(part[y * 14 * 4 + x], whole[((y + 5) * SIZE + 3) * 4 + x]);
        }
    }
}

}  // namespace
}  // namespace candela
