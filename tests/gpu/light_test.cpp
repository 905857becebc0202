// Samples of flat lights: they are chosen by their power, points uniformly by area, and densities say so.
#include <cmath>

#include "gpu/light_fixture.h"

namespace candela {
namespace {

// One flat light per plane z = 0, 1, 2, ... (so that a sample tells its light), as expected from the scene
// alone.
struct ExpectedLight {
    vec3 p, e1, e2;
    bool triangle;
    bool two_sided;
    vec3 radiance;

    double area() const { return length(cross(glm::dvec3(e1), glm::dvec3(e2))) * (triangle ? 0.5 : 1.0); }
    double power() const {
        const double luminance = 0.2126 * radiance.x + 0.7152 * radiance.y + 0.0722 * radiance.z;
        return area() * luminance * (two_sided ? 2.0 : 1.0);
    }
};

const std::vector<ExpectedLight> LIGHTS{
    {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 2, 0), false, false, vec3(3, 2, 1)},
    {vec3(0, 0, 1), vec3(1, 0, 0), vec3(0.5f, 1, 0), false, true, vec3(0.1f)},
    {vec3(-1, -1, 2), vec3(3, 0, 0), vec3(0, 3, 0), true, false, vec3(0, 1, 0)},
    {vec3(0, 0, 3), vec3(0.01f, 0, 0), vec3(0, 0.01f, 0), false, false, vec3(5000)},
    {vec3(1, 1, 4), vec3(0, 2, 0), vec3(-2, 0, 0), true, true, vec3(0.2f, 0.3f, 2)},
};

Scene scene_of_lights() {
    Scene scene = scene_of_mesh({});
    scene.shapes.clear();
    for (const ExpectedLight& l : LIGHTS) {
        Shape shape{.geometry = parallelogram(l.p, l.e1, l.e2),
                    .emission = Emission{.radiance = l.radiance, .two_sided = l.two_sided}};
        if (l.triangle) {
            shape.geometry = TriangleMesh{
                .positions = {l.p, l.p + l.e1, l.p + l.e2}, .normals = {}, .triangles = {uvec3(0, 1, 2)}};
        }
        scene.shapes.push_back(shape);
    }
    return scene;
}

class FlatLightTest : public LightTest {
  protected:
    static constexpr uint32_t CELLS = 8;

    // The light whose plane the shadow ray's end is next to: 256 representable numbers at most.
    static size_t light_of(const LightItem& item, const LightSample& s) {
        return size_t(std::lround(item.from.z + s.shadow.z));
    }
    // The point on that light; the shadow ray's end is moved from there along the normal, z, alone.
    static glm::dvec3 point_of(const LightItem& item, const LightSample& s) {
        return {double(item.from.x) + double(s.shadow.x), double(item.from.y) + double(s.shadow.y),
                double(light_of(item, s))};
    }
    static double total_power() {
        double total = 0.0;
        for (const ExpectedLight& l : LIGHTS)
            total += l.power();
        return total;
    }
    // From random points above, between and below the lights, none of them nearer than 0.1 to a plane.
    static std::vector<LightItem> items(size_t count) {
        Random random(60);
        std::vector<LightItem> items = random_items(vec3(0), count, 61);
        for (LightItem& item : items) {
            item.from = 5.0f * random.cube();
            item.from.z = std::floor(item.from.z) + 2.1f + 0.8f * random.unit();
        }
        return items;
    }
};

TEST_F(FlatLightTest, LightsAreChosenByPowerAndPointsByArea) {
    std::vector<double> chosen(LIGHTS.size());
    std::vector<std::vector<double>> cells(LIGHTS.size(), std::vector<double>(CELLS * CELLS));
    const std::vector<LightItem> sampled = items(200000);
    const std::vector<LightSample> results = sample(build_gpu_scene(scene_of_lights()), sampled);
    for (size_t k = 0; k < sampled.size(); ++k) {
        const size_t i = light_of(sampled[k], results[k]);
        ASSERT_LT(i, LIGHTS.size());
        ++chosen[i];
        // Coordinates along e1 and e2, and from them ones in which the samples are uniform.
        const ExpectedLight& l = LIGHTS[i];
        const glm::dvec3 d(point_of(sampled[k], results[k]) - glm::dvec3(l.p)), e1(l.e1), e2(l.e2);
        const double det = e1.x * e2.y - e1.y * e2.x;
        glm::dvec2 at((d.x * e2.y - d.y * e2.x) / det, (e1.x * d.y - e1.y * d.x) / det);
        const double sum = at.x + at.y;
        if (l.triangle) at = glm::dvec2(sum * sum, sum > 0.0 ? at.y / sum : 0.0);
        ASSERT_TRUE(at.x > -1e-4 && at.x < 1.0001 && at.y > -1e-4 && at.y < 1.0001) << at.x << ' ' << at.y;
        const auto cell = [](double x) { return std::min(uint32_t(std::max(x, 0.0) * CELLS), CELLS - 1); };
        ++cells[i][cell(at.x) * CELLS + cell(at.y)];
    }

    const double level = sidak_level(CHI_SQUARED_ALPHA, 1 + LIGHTS.size());
    std::vector<double> powers;
    for (const ExpectedLight& l : LIGHTS)
        powers.push_back(l.power());
    EXPECT_GT(pearson_p_value(chosen, powers), level);
    for (const std::vector<double>& counts : cells) {
        EXPECT_GT(pearson_p_value(counts, std::vector<double>(counts.size(), 1.0)), level);
    }
}

// The density is that of the light times that of the point, taken to solid angle: pmf / area * distance^2 /
// cos.
TEST_F(FlatLightTest, ASampleSaysWhatArrivesAndHowLikelyItWas) {
    const std::vector<LightItem> sampled = items(20000);
    for (const SceneAccess access : {SceneAccess::texel_buffers, SceneAccess::storage_buffers}) {
        const std::vector<LightSample> results = sample(build_gpu_scene(scene_of_lights()), sampled, access);
        for (size_t i = 0; i < sampled.size(); ++i) {
            const LightSample& s = results[i];
            const ExpectedLight& l = LIGHTS[light_of(sampled[i], s)];
            const glm::dvec3 to_light = point_of(sampled[i], s) - glm::dvec3(sampled[i].from);
            const double distance = length(to_light);
            const double cosine = -to_light.z / distance;  // All lights face +z.
            ASSERT_LE(length(glm::dvec3(s.wi) - to_light / distance), 0x1p-20);
            ASSERT_EQ(s.Li, cosine > 0.0 || l.two_sided ? l.radiance : vec3(0.0f));
            const double pdf = l.power() / total_power() / l.area() * distance * distance / std::abs(cosine);
            // A cosine of 1e-2 has a relative error of 1e2 times 2^-22.
            ASSERT_NEAR(s.pdf, pdf, pdf * 0x1p-22 * (4.0 + 2.0 / std::abs(cosine)));
            // The shadow ray ends before the light, by at most 256 representable numbers, or 2^-16 near 0.
            const double gap = std::copysign(1.0, cosine) * (sampled[i].from.z + s.shadow.z - l.p.z);
            ASSERT_GT(gap, 0.0);
            ASSERT_LE(gap, std::max(257 * 0x1p-23 * 4.0, 0x1p-16) + 8 * 0x1p-24);
            ASSERT_LT(s.t_max, 1.0f);  // A millionth before the point, at most two.
            ASSERT_GE(s.t_max, 1.0f - 0x1p-19f);
            // A ray that meets the same light there says the same.
            if (s.light_met != light_of(sampled[i], s)) continue;
            ASSERT_EQ(s.Li_met, s.Li);
            ASSERT_NEAR(s.pdf_met, s.pdf, pdf * 0x1p-20 * (4.0 + 2.0 / std::abs(cosine)));
        }
    }
}

TEST_F(FlatLightTest, APointOnTheLightItselfReceivesNothingFromThere) {
    const LightItem at_the_sample{.from = vec3(0)};  // Light 0's corner.
    const LightItem in_the_plane{.from = vec3(-1, 0, 0)};
    for (const LightSample& s : sample(build_gpu_scene(scene_of_lights()), {at_the_sample, in_the_plane}))
        EXPECT_EQ(s.pdf, 0.0f);
}

// A panel that slopes a little, next to a coordinate plane, where offset_origin moves a point by 2^-16 only:
// seen from afar, the points are rounded by more.
TEST_F(FlatLightTest, AFarLightDoesNotShadowItself) {
    Scene scene = scene_with_camera(vec3(0), vec3(0, 0, -1), 1.0f);
    add_diffuse(scene, vec3(0.0f));
    scene.shapes.push_back(
        {.geometry = parallelogram(vec3(-1, 0, 0.01f), vec3(2, 0, 0.003f), vec3(0, 1, 0.002f)),
         .material = 0,
         .emission = Emission{.radiance = vec3(1), .two_sided = false}});
    const GpuScene gpu = build_gpu_scene(scene);
    uint32_t seed = 70;
    for (const float distance : {1.0f, 1e2f, 1e3f, 1e4f, 1e5f}) {
        const vec3 from = distance * normalize(vec3(0.5f, 0.4f, 1));
        for (const LightSample& s : sample(gpu, random_items(from, 2000, seed++)))
            ASSERT_EQ(s.occluded, 0u) << distance << " m away";
    }
}

}  // namespace
}  // namespace candela
