// Filters of pixels: what they make of an edge.
#include <cmath>
#include <utility>
#include <vector>

#include "render_fixture.h"

namespace candela {
namespace {

// The filter at a place relative to the pixel's centre [pixels], up to a factor, by its definition.
double filter_at(const PixelFilter& filter, glm::dvec2 place) {
    const glm::dvec2 p = place / (0.5 * double(filter.width));  // In halves of the width.
    if (std::abs(p.x) > 1.0 || std::abs(p.y) > 1.0) return 0.0;
    const auto window = [](double x) {
        return 0.35875 + 0.48829 * std::cos(M_PI * x) + 0.14128 * std::cos(2 * M_PI * x) +
               0.01168 * std::cos(3 * M_PI * x);
    };
    switch (filter.shape) {
        case FilterShape::tent:
            return (1.0 - std::abs(p.x)) * (1.0 - std::abs(p.y));
        case FilterShape::gaussian:
            return dot(p, p) <= 1.0 ? std::exp(-4.5 * dot(p, p)) : 0.0;
        case FilterShape::blackman_harris:
            return window(p.x) * window(p.y);
        case FilterShape::box:
            break;
    }
    return 1.0;
}

class PixelFilterTest : public RenderTest {};

// A slanted edge through the middle of the picture, white on the left: a pixel shows the share of its filter
// that is on that side. The share is a sum over a grid of midpoints. The edge crosses one or two cells of
// each row, which count wholly or not at all; where the filter is as high as it gets, 8 times its mean, these
// errors add up to 8 sqrt(GRID) / GRID^2 / 2, a fifteenth of the noise.
TEST_F(PixelFilterTest, AnEdgeHasTheProfileOfTheFilter) {
    constexpr uint32_t WIDTH = 14, HEIGHT = 4, SPP = 4096, GRID = 400;
    const glm::dvec2 normal = normalize(glm::dvec2(1.0, 0.3));  // To the right and down, in the picture.
    Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.0f);
    scene.cameras[0].ortho_height = double(HEIGHT);
    add_diffuse(scene, vec3(0));
    const dvec3 across(normal.x, -normal.y, 0), along(normal.y, normal.x, 0);
    add_shape(scene, parallelogram(-50.0 * across - 50.0 * along, 50.0 * across, 100.0 * along), 0,
              Emission{.radiance = vec3(1), .two_sided = true});
    const GpuScene gpu_scene = build_gpu_scene(scene);
    RenderSettings settings = settings_for(WIDTH, HEIGHT);
    settings.sampler = SamplerKind::independent;
    const double n = samples(SPP);
    for (const PixelFilter filter :
         {PixelFilter{}, PixelFilter{FilterShape::box, 3.5f}, PixelFilter{FilterShape::box, 0.5f},
          PixelFilter{FilterShape::tent, 2.0f}, PixelFilter{FilterShape::gaussian, 3.0f},
          PixelFilter{FilterShape::gaussian, 10.0f}, PixelFilter{FilterShape::blackman_harris, 1.5f},
          PixelFilter{FilterShape::blackman_harris, 4.0f}}) {
        SCOPED_TRACE(int(filter.shape) + double(filter.width));
        settings.filter = filter;
        const Image image = image_of(render(gpu_scene, scene.cameras[0], settings, samples(SPP)));
        std::vector<std::pair<double, double>> cells;  // Place along the normal, and weight.
        double all = 0.0;
        for (uint32_t k = 0; k < GRID * GRID; ++k) {
            const glm::dvec2 cell = (glm::dvec2(k % GRID, k / GRID) + 0.5) / double(GRID) - 0.5;
            const glm::dvec2 place = double(filter.width) * cell;
            cells.emplace_back(dot(place, normal), filter_at(filter, place));
            all += cells.back().second;
        }
        for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
            const glm::dvec2 centre(i % WIDTH + 0.5 - WIDTH / 2.0, i / WIDTH + 0.5 - HEIGHT / 2.0);
            double white = 0.0;
            for (const auto& [place, weight] : cells)
                white += dot(centre, normal) + place < 0.0 ? weight : 0.0;
            const double share = white / all, value = plane(image, "", 0)[i];
            const double error = std::sqrt(share * (1.0 - share) / n);
            // Where less than one sample is expected, the normal distribution says nothing.
            if (std::min(share, 1.0 - share) * n < 10.0) {
                ASSERT_NEAR(value, share, 40.0 / n) << i;
                continue;
            }
            ASSERT_GT(normal_p_value((value - share) / error), sidak_level(TEST_ALPHA, WIDTH * HEIGHT))
                << i << ": " << value << ", not " << share;
        }
    }
}

}  // namespace
}  // namespace candela
