// The thin lens: nothing changes where it is sharp, and elsewhere a point becomes an image of the aperture,
// of a known size, shape and brightness.
#include <cmath>
#include <complex>

#include "render_fixture.h"

namespace candela {
namespace {

constexpr float BRIGHT = 100.0f;

class LensTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 64;
    static constexpr double HALF_WIDTH = 0.045;  // Half width of the film, at distance 1.

    static RenderSettings settings(uint32_t seed) { return independent_settings(SIZE, Estimator::mis, seed); }

    // A camera at the origin that looks along -Z at a black world.
    static Scene black_scene(Lens lens) {
        Scene scene = scene_with_camera(dvec3(0), dvec3(0, 0, -1), float(2.0 * std::atan(HALF_WIDTH)));
        scene.cameras[0].lens = lens;
        add_diffuse(scene, vec3(0));
        return scene;
    }
};

TEST_F(LensTest, ALensWithoutRadiusIsThePinhole) {
    Scene scene = scene_of_everything();
    const auto hash = [&](Lens lens) {
        scene.cameras[0].lens = lens;
        return image_hash(image_of(render(scene, settings_for(48, 32), 8)));
    };
    const uint64_t pinhole = hash({});
    EXPECT_EQ(hash({.radius = 0, .focal_distance = 3.7f, .blades = 0, .rotation = 0}), pinhole);
    EXPECT_EQ(hash({.radius = 0, .focal_distance = 0.1f, .blades = 5, .rotation = 1}), pinhole);
    EXPECT_NE(hash({.radius = 0.01f, .focal_distance = 3.7f, .blades = 0, .rotation = 0}), pinhole);
}

// The edges of what lies in the plane of focus are where they were, up to one sample that rounding may move
// across.
TEST_F(LensTest, ThePlaneOfFocusIsSharp) {
    constexpr uint32_t SPP = 16;
    for (const uint32_t blades : {0u, 6u}) {
        Scene scene = black_scene({});
        add_shape(scene, parallelogram(vec3(-0.06f, -0.09f, -3), vec3(0.13f, 0, 0), vec3(0, 0.15f, 0)), 0,
                  Emission{vec3(BRIGHT), false});
        const Image pinhole = image_of(render(scene, settings(1), SPP));
        scene.cameras[0].lens = {.radius = 0.3f, .focal_distance = 3, .blades = blades, .rotation = 0};
        const Image lens = image_of(render(scene, settings(1), SPP));
        for (size_t i = 0; i < lens.pixel_count(); ++i)
            ASSERT_NEAR(plane(lens, "", 0)[i], plane(pinhole, "", 0)[i], 1.01 * double(BRIGHT) / SPP);
        EXPECT_GT(image_mean(lens, 0).mean, 10.0);  // The quad covers a quarter of the picture.
    }
}

// The same with a principal point off the middle and pixels that are not square: the plane of focus is the
// one across the camera's axis.
TEST_F(LensTest, ThePlaneOfFocusIsAcrossTheAxis) {
    constexpr uint32_t SPP = 16;
    Scene scene = black_scene({});
    scene.cameras[0].principal_offset = vec2(0.6f, -0.4f);
    scene.cameras[0].focal_ratio = 0.5f;
    // Around the middle of the picture, where a metre ahead is 0.108 m to the left and 0.036 m down.
    add_shape(scene, parallelogram(vec3(-0.5f, -0.21f, -3), vec3(0.3f, 0, 0), vec3(0, 0.12f, 0)), 0,
              Emission{vec3(BRIGHT), false});
    const Image pinhole = image_of(render(scene, settings(1), SPP));
    scene.cameras[0].lens = {.radius = 0.3f, .focal_distance = 3, .blades = 0, .rotation = 0};
    const Image lens = image_of(render(scene, settings(1), SPP));
    for (size_t i = 0; i < lens.pixel_count(); ++i)
        ASSERT_NEAR(plane(lens, "", 0)[i], plane(pinhole, "", 0)[i], 1.01 * double(BRIGHT) / SPP);
    EXPECT_GT(image_mean(lens, 0).mean, 10.0);
}

// A picture of a small lamp out of focus, whose moments are estimates with a known variance.
struct Blur {
    const Image& image;
    double pixel;  // Width of a pixel on the film at distance 1.

    // Position of a pixel's centre on the film at distance 1, right and up.
    std::complex<double> at(size_t i) const {
        const double half = 0.5 * image.data.width();
        return pixel * std::complex<double>(double(i % image.data.width()) + 0.5 - half,
                                            half - double(i / image.data.width()) - 0.5);
    }
    // Mean of g(position) over the blur, weighted by radiance, and its standard error (of a quotient, to
    // first order).
    template <class G>
    std::pair<double, double> mean(const G& g) const {
        double sum = 0.0, weighted = 0.0, variance = 0.0;
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            sum += double(plane(image, "", 0)[i]);
            weighted += double(plane(image, "", 0)[i]) * g(at(i));
        }
        const double value = weighted / sum;
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const double deviation = g(at(i)) - value;
            variance += double(plane(image, "Variance", 0)[i]) * deviation * deviation;
        }
        return {value, std::sqrt(variance) / sum};
    }
};

// Every point of the aperture sees a lamp elsewhere, by as much to each side of where the pinhole sees it.
TEST_F(LensTest, ABlurLiesAroundThePinholesImage) {
    constexpr float DISTANCE = 6.0f, LAMP_RADIUS = 0.03f;
    Scene scene = black_scene({.radius = 0.05f, .focal_distance = 2, .blades = 0, .rotation = 0});
    scene.cameras[0].principal_offset = vec2(0.6f, -0.4f);
    scene.cameras[0].focal_ratio = 0.5f;
    const dvec3 lamp(-0.1 * DISTANCE, -0.03 * DISTANCE, -DISTANCE);
    add_shape(scene, Disk{lamp, dvec3(LAMP_RADIUS, 0, 0), dvec3(0, LAMP_RADIUS, 0)}, 0,
              Emission{vec3(BRIGHT), false});
    const Image image = image_of(render(scene, settings(2), 512));
    const Blur blur{image, 1.0};  // In pixels.
    // One metre away, a pixel is as high as 2 HALF_WIDTH / SIZE, and twice as wide.
    const double pixel = 2.0 * HALF_WIDTH / SIZE;
    const double x = -0.1 / (2.0 * pixel) + 0.6 * SIZE, y = -0.03 / pixel + 0.4 * SIZE;
    ASSERT_LT(std::abs(x), 0.1 * SIZE);  // All of the blur is in the picture.
    ASSERT_LT(std::abs(y), 0.1 * SIZE);
    const auto [mean_x, error_x] = blur.mean([](auto z) { return z.real(); });
    const auto [mean_y, error_y] = blur.mean([](auto z) { return z.imag(); });
    EXPECT_GT(normal_p_value((mean_x - x) / error_x), TEST_ALPHA) << mean_x << ", not " << x;
    EXPECT_GT(normal_p_value((mean_y - y) / error_y), TEST_ALPHA) << mean_y << ", not " << y;
    EXPECT_LT(std::max(error_x, error_y), 0.5);
}

struct Aperture {
    uint32_t blades;
    float focus, lamp, rotation;
};

class BlurTest : public LensTest, public testing::WithParamInterface<Aperture> {
  protected:
    static constexpr double LENS_RADIUS = 0.1;

    // Radius of the circle of confusion on the film at distance 1. A ray from the point a of the aperture
    // through the point at distance d hits the plane of focus at a (1 - f / d), which is seen under 1 / f of
    // that.
    static double signed_radius() {
        return LENS_RADIUS * (1.0 / double(GetParam().focus) - 1.0 / double(GetParam().lamp));
    }
    // Area of the regular polygon in a unit circle; of the circle for 0 blades.
    static double unit_area() {
        const double n = GetParam().blades;
        return GetParam().blades == 0 ? M_PI : 0.5 * n * std::sin(2.0 * M_PI / n);
    }
    // Mean of the squared distance from its centre; (2 + cos(2 pi / n)) / 6, 1/2 for the circle.
    static double unit_moment() {
        return GetParam().blades == 0 ? 0.5 : (2.0 + std::cos(2.0 * M_PI / GetParam().blades)) / 6.0;
    }
};

constexpr float LAMP_SLOPE = 0.005f;  // Radius of the lamp over its distance.

TEST_P(BlurTest, IsAnImageOfTheAperture) {
    const Aperture p = GetParam();
    Scene scene = black_scene({.radius = float(LENS_RADIUS),
                               .focal_distance = p.focus,
                               .blades = p.blades,
                               .rotation = p.rotation});
    const float lamp_radius = LAMP_SLOPE * p.lamp;
    add_shape(scene, Disk{dvec3(0, 0, -p.lamp), dvec3(lamp_radius, 0, 0), dvec3(0, lamp_radius, 0)}, 0,
              Emission{vec3(BRIGHT), false});
    const Image image = image_of(render(scene, settings(2), samples(2048)));
    const Blur blur{image, 2.0 * HALF_WIDTH / SIZE};
    const auto expect = [&](const char* what, std::pair<double, double> mean, double expected,
                            double systematic) {
        const double beyond = std::max(0.0, std::abs(mean.first - expected) - systematic);
        EXPECT_GT(normal_p_value(beyond / mean.second), TEST_ALPHA)
            << what << ": " << mean.first << " +- " << mean.second << ", not " << expected;
    };

    // All light of the lamp arrives: from every point of the aperture, it covers (radius / distance)^2 pi of
    // the film.
    const double lamp_area = M_PI * double(LAMP_SLOPE) * double(LAMP_SLOPE);
    const double film_area = 4.0 * HALF_WIDTH * HALF_WIDTH;
    const ImageMean energy = image_mean(image, 0);
    EXPECT_LE(energy.error, 4.0 * largest_error() * energy.mean);
    expect("energy", {energy.mean, energy.error}, double(BRIGHT) * lamp_area / film_area, 1e-5 * energy.mean);

    // It lies around the axis, as wide as the aperture, the lamp and a pixel together. Variances add up, that
    // of a pixel (Sheppard's correction) but for the aliasing of the sharp edge on the grid, less than the
    // share of a pixel in the blur's area.
    const double radius = signed_radius();
    const double lamp_moment = 0.5 * lamp_area / M_PI;
    const double pixel_moment = blur.pixel * blur.pixel / 6.0;
    const double moment = unit_moment() * radius * radius + lamp_moment + pixel_moment;
    ASSERT_GT(std::abs(radius), 8.0 * blur.pixel);
    ASSERT_LT(std::abs(radius), 0.8 * HALF_WIDTH);
    expect("x", blur.mean([](auto z) { return z.real(); }), 0.0, 0.0);
    expect("y", blur.mean([](auto z) { return z.imag(); }), 0.0, 0.0);
    expect("moment", blur.mean([](auto z) { return std::norm(z); }), moment, 1e-3 * moment);
    // As wide as high, and not tilted: the second moments of a regular polygon are those of a circle.
    expect("stretch", blur.mean([](auto z) { return (z * z).real(); }), 0.0, 1e-3 * moment);
    expect("tilt", blur.mean([](auto z) { return (z * z).imag(); }), 0.0, 1e-3 * moment);

    // Its middle is as dim as its area is large.
    RunningMoments middle;
    double middle_variance = 0.0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        if (std::abs(blur.at(i)) > 0.3 * std::abs(radius)) continue;
        middle.add(double(plane(image, "", 0)[i]));
        middle_variance += double(plane(image, "Variance", 0)[i]);
    }
    const double middle_radiance = double(BRIGHT) * lamp_area / (unit_area() * radius * radius);
    expect("middle", {middle.mean(), std::sqrt(middle_variance) / double(middle.count())}, middle_radiance,
           1e-5 * middle_radiance);

    // Corners: the n-th power turns them all to one direction, along the real axis, upside down before the
    // focus.
    if (p.blades == 0) return;
    const auto corners = std::polar(1.0, double(p.rotation)) * (radius < 0.0 ? -1.0 : 1.0);
    const auto power = [&](auto z) { return std::pow(z / (corners * std::abs(radius)), double(p.blades)); };
    expect("turn", blur.mean([&](auto z) { return power(z).imag(); }), 0.0, 0.0);
    const auto [along, along_error] = blur.mean([&](auto z) { return power(z).real(); });
    EXPECT_GT(along, 10.0 * along_error);
}

INSTANTIATE_TEST_SUITE_P(Apertures, BlurTest,
                         testing::Values(Aperture{0, 2.0f, 6.0f, 0.0f}, Aperture{0, 3.0f, 1.5f, 0.5f},
                                         Aperture{3, 2.0f, 6.0f, 0.4f}, Aperture{3, 3.0f, 1.5f, 0.4f},
                                         Aperture{5, 2.0f, 6.0f, 0.0f}, Aperture{6, 2.0f, 6.0f, 0.2f}));

}  // namespace
}  // namespace candela
