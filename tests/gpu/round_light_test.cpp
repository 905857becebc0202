// Samples of spheres and disks that emit: over the solid angle of a sphere from outside, over the area else.
#include "gpu/light_fixture.h"
#include "selftest/charts.h"

namespace candela {
namespace {

constexpr vec3 RADIANCE(3, 2, 1);

Scene scene_of(const decltype(Shape::geometry)& geometry, bool two_sided) {
    Scene scene = scene_of_mesh({});
    scene.shapes = {{.geometry = geometry,
                     .material = 0,
                     .emission = Emission{.radiance = RADIANCE, .two_sided = two_sided}}};
    return scene;
}

class RoundLightTest : public LightTest {
  protected:
    static constexpr uint32_t CELLS = 16;
    static constexpr size_t SAMPLES = 100000;

    // Adds to a histogram the point (a, b) of [0, 1]^2.
    static void count(std::vector<double>& cells, double a, double b) {
        const auto cell = [](double x) { return uint32_t(std::clamp(x, 0.0, 1.0 - 1e-9) * CELLS); };
        ++cells[cell(a) * CELLS + cell(b)];
    }
    static double uniformity(const std::vector<double>& cells) {
        return pearson_p_value(cells, std::vector<double>(cells.size(), 1.0));
    }
};

struct Place {
    Sphere sphere;
    vec3 from;
};

// From far away to almost touching; a tiny sphere and a huge one; away from the origin.
const std::vector<Place> OUTSIDE{
    {{vec3(0, 0, -3), 1.0f}, vec3(0)},
    {{vec3(1, 2, 3), 0.25f}, vec3(-1, 0.5f, 2)},
    {{vec3(5, 4, 3), 1.0f}, vec3(300, 400, 500)},
    {{vec3(0, 2, 0), 1e-3f}, vec3(0.5f, 0, 0)},
    {{vec3(0), 1e-3f}, vec3(60, 0, 80)},
    {{vec3(0, -1e4f, 0), 1e4f}, vec3(3, 1, 2)},
    {{vec3(0, 0, -1), 1.0f}, vec3(0, 0, 0.01f)},
    {{vec3(10, 0, 0), 2.0f}, vec3(7.999f, 0, 0)},
};

// In 1 - cos of the angle to the axis and the angle around it. The density has the error of 1 - cos(max) =
// sin^2 / (1 + sqrt(1 - sin^2)): sin^2 is off by 16 * 2^-24 of itself (the centre as seen from the point
// counts twice), and that of the root is as much over twice the root.
TEST_F(RoundLightTest, ASphereIsUniformOverTheSolidAngleThatItFills) {
    const double level = sidak_level(CHI_SQUARED_ALPHA, OUTSIDE.size());
    for (size_t k = 0; k < OUTSIDE.size(); ++k) {
        SCOPED_TRACE(k);
        const auto& [sphere, from] = OUTSIDE[k];
        const glm::dvec3 to_center = glm::dvec3(sphere.center) - glm::dvec3(from);
        const double sine = double(sphere.radius) / length(to_center), root = std::sqrt(1.0 - sine * sine);
        const double h_max = sine * sine / (1.0 + root), pdf = 1.0 / (2.0 * M_PI * h_max);
        const glm::dvec3 axis = normalize(to_center);
        const auto [x, y] = axes_around(axis);
        std::vector<double> cells(CELLS * CELLS);
        size_t met = 0, outside = 0;
        for (const LightSample& s :
             sample(build_gpu_scene(scene_of(sphere, false)), random_items(from, SAMPLES, 80))) {
            const glm::dvec3 wi(s.wi), chord = wi - axis;
            ASSERT_NEAR(length(wi), 1.0, 0x1p-20);
            const double h = 0.5 * dot(chord, chord);
            outside += h > h_max;
            count(cells, h / h_max, turn_of(dot(wi, y), dot(wi, x)));
            ASSERT_NEAR(s.pdf, pdf, pdf * 0x1p-20 * (1.0 + 1.0 / root));
            ASSERT_EQ(s.Li, RADIANCE);
            ASSERT_EQ(s.occluded, 0u);
            if (s.light_met == NO_LIGHT) continue;
            ++met;
            ASSERT_NEAR(s.pdf_met, s.pdf, double(s.pdf) * 0x1p-22);
            ASSERT_EQ(s.Li_met, RADIANCE);
        }
        EXPECT_GT(uniformity(cells), level);
        // Rays past the limb: the centre's distance carries 4 roundings, which count in radii.
        const double limb = std::min(1.0, 2.0 * 8 * 0x1p-24 / sine) * SAMPLES;
        EXPECT_GE(double(met), SAMPLES - 10.0 - 2.0 * limb);
        EXPECT_LE(double(outside), 10.0 + 2.0 * limb);
    }
}

// The point is uniform over the whole area; the density is that of the area, taken to solid angle. From
// inside, a sphere shines only if it is two-sided.
TEST_F(RoundLightTest, ASphereFromInsideIsUniformOverItsArea) {
    const Sphere sphere{vec3(1, 2, 3), 2.0f};
    const double level = sidak_level(CHI_SQUARED_ALPHA, 3);
    for (const vec3 from : {vec3(1, 2, 3), vec3(2, 3, 3), vec3(1, 2, 4.99f)}) {
        std::vector<double> cells(CELLS * CELLS);
        for (const LightSample& s :
             sample(build_gpu_scene(scene_of(sphere, true)), random_items(from, SAMPLES, 81))) {
            const glm::dvec3 n =
                normalize(glm::dvec3(from) + glm::dvec3(s.shadow) - glm::dvec3(sphere.center));
            const glm::dvec3 to_light = glm::dvec3(sphere.center) + 2.0 * n - glm::dvec3(from);
            count(cells, (n.z + 1.0) / 2.0, turn_of(n.y, n.x));
            const double distance = length(to_light), cosine = dot(to_light, n) / distance;
            ASSERT_LE(length(glm::dvec3(s.wi) - to_light / distance), 1e-4 / distance);
            // What the shadow ray's end, about 10^-4 off the sphere, tells of the point.
            const double pdf = distance * distance / (16.0 * M_PI * cosine);
            ASSERT_NEAR(s.pdf, pdf, pdf * 1e-3 * (1.0 / distance + 1.0 / cosine));
            ASSERT_EQ(s.Li, RADIANCE);
            ASSERT_EQ(s.occluded, 0u);
            ASSERT_EQ(s.light_met, 0u);
            ASSERT_NEAR(s.pdf_met, s.pdf, double(s.pdf) * 1e-4 * (1.0 / distance + 1.0 / cosine));
        }
        EXPECT_GT(uniformity(cells), level);
        for (const LightSample& s :
             sample(build_gpu_scene(scene_of(sphere, false)), random_items(from, 1000, 82)))
            ASSERT_EQ(s.Li, vec3(0.0f));
    }
}

// An ellipse, in the coordinates of its axes; its front is where cross(e1, e2) points.
TEST_F(RoundLightTest, ADiskIsUniformOverItsArea) {
    const Disk disk{.center = vec3(1, 2, 3), .e1 = vec3(2, 0, 0), .e2 = vec3(1, 3, 0)};
    const double level = sidak_level(CHI_SQUARED_ALPHA, 3);
    for (const vec3 from : {vec3(0, 0, 5), vec3(1, 2, 3.5f), vec3(4, 0, -20)}) {
        std::vector<double> cells(CELLS * CELLS);
        for (const LightSample& s :
             sample(build_gpu_scene(scene_of(disk, false)), random_items(from, SAMPLES, 83))) {
            const glm::dvec3 p(glm::dvec3(from) + glm::dvec3(s.shadow));  // Moved along z alone.
            const double y = (p.y - 2.0) / 3.0, x = (p.x - 1.0 - y) / 2.0;
            ASSERT_LE(x * x + y * y, 1.0 + 1e-5);
            count(cells, x * x + y * y, turn_of(y, x));
            const glm::dvec3 to_light = glm::dvec3(p.x, p.y, 3.0) - glm::dvec3(from);
            const double distance = length(to_light), cosine = std::abs(to_light.z) / distance;
            ASSERT_LE(length(glm::dvec3(s.wi) - to_light / distance), 0x1p-20);
            const double pdf = distance * distance / (6.0 * M_PI * cosine);
            ASSERT_NEAR(s.pdf, pdf, pdf * 0x1p-22 * (4.0 + 2.0 / cosine));
            ASSERT_EQ(s.Li, from.z > 3.0f ? RADIANCE : vec3(0.0f));
            ASSERT_EQ(s.occluded, 0u);
            if (s.light_met == NO_LIGHT) continue;  // Over the rim by a rounding.
            ASSERT_NEAR(s.pdf_met, s.pdf, pdf * 0x1p-20 * (4.0 + 2.0 / cosine));
        }
        EXPECT_GT(uniformity(cells), level);
    }
}

}  // namespace
}  // namespace candela
