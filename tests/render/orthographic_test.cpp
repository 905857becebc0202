// The orthographic camera: what it sees where, and how bright.
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

Scene scene_seen(dvec3 position, dvec3 look_at, vec3 up, double height) {
    Scene scene = scene_with_camera(position, look_at, 0.0f);
    scene.cameras[0].up = up;
    scene.cameras[0].ortho_height = height;
    add_diffuse(scene, vec3(0.5f));
    return scene;
}

class OrthographicTest : public RenderTest {};

// Pixels are squares on any plane across the view, however far away. A slope shows that depth is along the
// axis. Positions are rounded at 2^-24 of some units, a few times over.
TEST_F(OrthographicTest, APixelIsAsLargeAtAnyDistance) {
    for (const double scale : {1.0, 1e6}) {
        Scene scene =
            scene_seen(dvec3(0.5, 2, 3) * scale, dvec3(0.5, 2, -7) * scale, vec3(0, 2, 0), 2.0 * scale);
        // z = -x, in front of all of the view.
        add_shape(scene,
                  parallelogram(dvec3(-5, -5, 5) * scale, dvec3(10, 0, -10) * scale, dvec3(0, 10, 0) * scale),
                  0);
        const RenderSettings settings = settings_for(40, 20);
        Renderer renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings);
        const std::vector<float> positions = renderer.positions();
        for (uint32_t y = 0; y < 20; ++y) {
            for (uint32_t x = 0; x < 40; ++x) {
                const float* at = &positions[4 * (size_t(y) * 40 + x)];
                const double px = 0.5 + (double(x) + 0.5) / 10.0 - 2.0;
                ASSERT_NEAR(at[0] / scale, px, 1e-5);
                ASSERT_NEAR(at[1] / scale, 2.0 + 1.0 - (double(y) + 0.5) / 10.0, 1e-5);
                ASSERT_NEAR(at[2] / scale, -px, 1e-5);
                ASSERT_NEAR(at[3] / scale, 3.0 + px, 1e-5);
            }
        }
    }
}

// What lies behind the plane through the position is not seen.
TEST_F(OrthographicTest, RaysBeginInThePlaneOfTheCamera) {
    Scene scene = scene_seen(dvec3(0), dvec3(0, 0, -1), vec3(0, 1, 0), 2.0);
    scene.materials[0].model = DiffuseMaterial{vec3(0)};
    const Quad pane = parallelogram(vec3(-2, -2, 0.01f), vec3(4, 0, 0), vec3(0, 4, 0));
    add_shape(scene, pane, 0, Emission{.radiance = vec3(1), .two_sided = true});
    add_shape(scene, parallelogram(vec3(-2, -2, -5), vec3(4, 0, 0), vec3(0, 4, 0)), 0,
              Emission{.radiance = vec3(2), .two_sided = true});
    expect_pixels(image_of(render(scene, settings_for(8, 8), 4)), vec3(2));
}

// A floor under a point light, seen from above: I cos / d^2 over each pixel. Its mean comes from a grid of
// midpoints, whose error is far below the noise.
TEST_F(OrthographicTest, AFloorUnderAPointLightHasItsClosedFormInEveryPixel) {
    constexpr uint32_t WIDTH = 24, HEIGHT = 12, SPP = 256, GRID = 16;
    constexpr double VIEW = 6.0;  // Metres high.
    const dvec3 at(1.3, 2, -0.4);
    const vec3 intensity(1, 2, 3);
    Scene scene = scene_seen(dvec3(0, 1, 0), dvec3(0), vec3(0, 0, -1), VIEW);
    add_shape(scene, parallelogram(vec3(-50, 0, 50), vec3(100, 0, 0), vec3(0, 0, -100)), 0);
    scene.lights = {{"", PointLight{at, intensity}}};
    RenderSettings settings = settings_for(WIDTH, HEIGHT);
    settings.sampler = SamplerKind::independent;
    const Image image = image_of(render(scene, settings, SPP));
    const double level = sidak_level(TEST_ALPHA, size_t{3} * WIDTH * HEIGHT);
    const double pixel = VIEW / HEIGHT;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
        double mean = 0.0;
        for (uint32_t k = 0; k < GRID * GRID; ++k) {
            const double x = (i % WIDTH + (k % GRID + 0.5) / GRID - 0.5 * WIDTH) * pixel;
            const double z = (i / WIDTH + (k / GRID + 0.5) / GRID - 0.5 * HEIGHT) * pixel;
            const double distance = length(at - dvec3(x, 0, z));
            mean += 0.5 / M_PI * at.y / std::pow(distance, 3) / (GRID * GRID);
        }
        for (size_t c = 0; c < 3; ++c) {
            const double expected = mean * double(intensity[int(c)]);
            const double error = std::sqrt(double(plane(image, "Variance", c)[i]));
            ASSERT_LT(error, 0.02 * expected);
            ASSERT_GT(normal_p_value((double(plane(image, "", c)[i]) - expected) / error), level)
                << i << ": " << plane(image, "", c)[i] << ", not " << expected;
        }
    }
}

}  // namespace
}  // namespace candela
