// Cameras whose axis is off the middle of the picture, and whose pixels are not square: what they see where.
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

class PrincipalPointTest : public RenderTest {};

// A wall across the view shows at each pixel what fx, fy, cx and cy say: its distance times ((x - cx) / fx,
// (y - cy) / fy), at the same depth everywhere. Positions are rounded at 2^-24 of some units, a
// few times over.
TEST_F(PrincipalPointTest, EachPixelLooksWhereTheIntrinsicsSay) {
    constexpr uint32_t WIDTH = 40, HEIGHT = 24;
    constexpr double FX = 50, FY = 30, CX = 5.25, CY = 31.5, DEPTH = 7;
    Scene scene = scene_with_camera(dvec3(1, 2, 3), dvec3(1, 2, -5), float(2 * std::atan(HEIGHT / (2 * FY))));
    scene.cameras[0].principal_offset = vec2((CX - WIDTH / 2.0) / HEIGHT, (CY - HEIGHT / 2.0) / HEIGHT);
    scene.cameras[0].focal_ratio = float(FX / FY);
    add_diffuse(scene, vec3(0.5f));
    add_shape(scene, parallelogram(vec3(-20, -20, 3 - DEPTH), vec3(40, 0, 0), vec3(0, 40, 0)), 0);
    const GpuScene gpu_scene = build_gpu_scene(scene);
    // Twice the picture, and a part of it, show the same place at the same point of the film.
    for (const uint32_t scale : {1u, 2u}) {
        RenderSettings settings = settings_for(scale * WIDTH, scale * HEIGHT);
        settings.crop = {3, 5, scale * WIDTH, scale * HEIGHT};
        Renderer renderer(device(), gpu_scene, scene.cameras[0], settings);
        const std::vector<float> positions = renderer.positions();
        for (uint32_t y = 5; y < scale * HEIGHT; ++y) {
            for (uint32_t x = 3; x < scale * WIDTH; ++x) {
                const float* at = &positions[4 * (size_t(y - 5) * settings.crop.width() + x - 3)];
                ASSERT_NEAR(at[0], 1 + DEPTH * ((x + 0.5) / scale - CX) / FX, 1e-5);
                ASSERT_NEAR(at[1], 2 - DEPTH * ((y + 0.5) / scale - CY) / FY, 1e-5);
                ASSERT_NEAR(at[2], 3 - DEPTH, 1e-5);
                ASSERT_NEAR(at[3], DEPTH, 1e-5);
            }
        }
    }
}

}  // namespace
}  // namespace candela
