// The sky: where its texels are, and that light samples find them in proportion to what they send.
#include "gpu/light_fixture.h"

namespace candela {
namespace {

struct DirectionItem {
    vec3 w;
    float unused = 0.0f;
};

struct Texel {
    vec3 radiance;
    float pdf;
};

// A scene with something in it, far below, where it hides next to nothing of the sky.
Scene scene_under(const Environment& environment) {
    Scene scene = scene_of_mesh({});
    scene.shapes = {{.geometry = parallelogram(vec3(-0.5f, -1000, -0.5f), vec3(1, 0, 0), vec3(0, 0, 1)),
                     .material = 0,
                     .emission = {}}};
    scene.environment = environment;
    return scene;
}

Environment random_sky(uvec2 size, float rotation) {
    Random random(size.x * 1000 + size.y);
    Environment sky{.size = size, .radiance = {}, .rotation = rotation};
    for (uint32_t i = 0; i < size.x * size.y; ++i)
        sky.radiance.push_back(std::exp2(6.0f * random.unit()) * (vec3(1.1f) + random.cube()));
    if (sky.radiance.size() > 2) sky.radiance[1] = vec3(0.0f);
    return sky;
}

double luminance_of(vec3 rgb) {
    return 0.2126 * double(rgb.x) + 0.7152 * double(rgb.y) + 0.0722 * double(rgb.z);
}

// Where a direction is in the map, in texels from its top left, as scene.h describes it: the centre is
// towards -Z, u grows to +X and v downwards from +Y; the map was turned about +Y, which takes -Z towards -X.
glm::dvec2 place_of(const Environment& sky, glm::dvec3 w) {
    const double longitude = std::atan2(w.x, -w.z) + double(sky.rotation);  // From -Z towards +X.
    const double colatitude = std::atan2(std::hypot(w.x, w.z), w.y);
    const double u = 0.5 + longitude / (2.0 * M_PI);
    return {(u - std::floor(u)) * sky.size.x, colatitude / M_PI * sky.size.y};
}

// Distance to the nearest border between texels [texels].
double to_border(double x) {
    return std::abs(x - std::round(x));
}

class EnvironmentTest : public LightTest {
  protected:
    std::vector<Texel> look_up(const Environment& sky, const std::vector<DirectionItem>& directions) const {
        const DeviceScene scene(device(), build_gpu_scene(scene_under(sky)), SceneAccess::texel_buffers);
        return map<Texel>(kernels::environment, directions, {}, &scene);
    }
};

TEST_F(EnvironmentTest, TexelsLieWhereTheConventionSays) {
    // Eight columns and four rows; each texel's red tells its index.
    Environment sky{.size = {8, 4}, .radiance = {}};
    for (int i = 0; i < 32; ++i)
        sky.radiance.emplace_back(float(i), 1.0f, 1.0f);
    // Texel (x, y) has its middle at longitude (x + 1/2) 45 degrees from the left edge, which is +Z.
    struct Seen {
        vec3 w;
        int x, y;
    };
    const float tilt = 0.1f;
    const std::vector<Seen> unturned{
        {vec3(tilt, 0.3f, -1), 4, 1},  // Right of the centre, above the middle.
        {vec3(-tilt, 0.3f, -1), 3, 1}, {vec3(-tilt, -0.3f, -1), 3, 2}, {vec3(1, 0.3f, -tilt), 5, 1},
        {vec3(1, 0.3f, tilt), 6, 1},   {vec3(-1, 0.3f, -tilt), 2, 1},  {vec3(tilt, 0.3f, 1), 7, 1},
        {vec3(-tilt, 0.3f, 1), 0, 1},  {vec3(tilt, 1, -0.01f), 5, 0},  {vec3(tilt, -1, -0.01f), 5, 3},
    };
    std::vector<DirectionItem> directions;
    for (const Seen& s : unturned)
        directions.push_back({normalize(s.w)});
    const std::vector<Texel> texels = look_up(sky, directions);
    for (size_t i = 0; i < unturned.size(); ++i)
        EXPECT_EQ(texels[i].radiance.x, float(unturned[i].y * 8 + unturned[i].x)) << i;

    // A quarter turn, counter-clockwise seen from above: what was ahead, at -Z, is at the left, -X.
    sky.rotation = 0.5f * PI;
    const std::vector<Texel> turned =
        look_up(sky, {{normalize(vec3(-1, 0.3f, -tilt))}, {normalize(vec3(-1, 0.3f, tilt))}});
    EXPECT_EQ(turned[0].radiance.x, 8.0f + 4.0f);
    EXPECT_EQ(turned[1].radiance.x, 8.0f + 3.0f);
}

// All around, on the axes and at the poles. The angle is off by 2^-23 turns, and by the roundings of its
// arguments, 2^-22 in all, over their size; the colatitude, by 2^-22 turns of half a turn.
TEST_F(EnvironmentTest, EveryDirectionHasItsTexel) {
    std::vector<DirectionItem> directions;
    Random random(90);
    for (int i = 0; i < 50000; ++i)
        directions.push_back({random.direction()});
    for (const float sign : {-1.0f, 1.0f}) {
        for (const int axis : {0, 1, 2}) {
            vec3 w(0.0f);
            w[axis] = sign;
            directions.push_back({w});
        }
        directions.push_back({normalize(vec3(1e-7f, sign, 1e-7f))});
        directions.push_back({vec3(1e-30f, sign, 0.0f)});
    }
    for (const uvec2 size : {uvec2(1, 1), uvec2(1, 5), uvec2(7, 1), uvec2(5, 9), uvec2(128, 64)}) {
        const Environment sky = random_sky(size, 0.7f);
        const std::vector<Texel> texels = look_up(sky, directions);
        size_t at_borders = 0;
        for (size_t i = 0; i < directions.size(); ++i) {
            const glm::dvec3 w(directions[i].w);
            const glm::dvec2 place = place_of(sky, w);
            const double margin_x = size.x * (0x1p-22 + 0x1p-22 / std::max(std::hypot(w.x, w.z), 1e-9));
            if (to_border(place.x) < margin_x || to_border(place.y) < size.y * 0x1p-20) {
                ++at_borders;
                ASSERT_TRUE(is_finite(texels[i].radiance));
                continue;
            }
            ASSERT_EQ(texels[i].radiance, sky.radiance[size_t(place.y) * size.x + size_t(place.x)]) << i;
        }
        EXPECT_LT(at_borders, 500u);
    }
}

// Texels by luminance times solid angle; within a texel uniformly over its solid angle.
TEST_F(EnvironmentTest, SamplesFollowTheLightOfTheSky) {
    constexpr uint32_t CELLS = 8;
    const std::vector<uvec2> sizes{uvec2(1, 1), uvec2(1, 5), uvec2(7, 1), uvec2(5, 9), uvec2(32, 16)};
    const double level = sidak_level(CHI_SQUARED_ALPHA, 2 * sizes.size());
    for (const uvec2 size : sizes) {
        SCOPED_TRACE(size.x);
        const Environment sky = random_sky(size, -2.5f);
        std::vector<double> expected, counts(size_t(size.x) * size.y), within(CELLS * CELLS);
        double irradiance = 0.0;
        for (uint32_t i = 0; i < size.x * size.y; ++i) {
            const double top = M_PI * (i / size.x) / size.y, bottom = M_PI * (i / size.x + 1) / size.y;
            expected.push_back(luminance_of(sky.radiance[i]) * 2.0 * M_PI / size.x *
                               (std::cos(top) - std::cos(bottom)));
            irradiance += expected.back();
        }
        size_t at_borders = 0;
        for (const LightSample& s :
             sample(build_gpu_scene(scene_under(sky)), random_items(vec3(0), 200000, 91))) {
            const glm::dvec3 w(s.wi);
            ASSERT_NEAR(length(w), 1.0, 0x1p-20);
            const glm::dvec2 place = place_of(sky, w);
            const double margin_x = size.x * (0x1p-22 + 0x1p-21 / std::max(std::hypot(w.x, w.z), 1e-9));
            const size_t texel = std::min(size_t(place.y), size_t(size.y - 1)) * size.x + size_t(place.x);
            ++counts[texel];
            const double row = std::floor(place.y), step = M_PI / size.y;
            const double top = std::cos(step * row), bottom = std::cos(step * (row + 1.0));
            const auto cell = [](double x) { return uint32_t(std::clamp(x, 0.0, 1.0 - 1e-9) * CELLS); };
            ++within[cell(place.x - std::floor(place.x)) * CELLS +
                     cell((top - std::cos(step * place.y)) / (top - bottom))];
            if (to_border(place.x) < margin_x || to_border(place.y) < size.y * 0x1p-19) {
                // Counted in the neighbour, perhaps.
                ++at_borders;
                continue;
            }
            const double pdf = luminance_of(sky.radiance[texel]) / irradiance;
            ASSERT_NEAR(s.pdf, pdf, pdf * 0x1p-20);
            ASSERT_EQ(s.Li, sky.radiance[texel]);
            ASSERT_EQ(s.Li_met, s.Li);
            ASSERT_EQ(s.pdf_met, s.pdf);
            ASSERT_EQ(s.occluded, 0u);
        }
        EXPECT_LT(at_borders, 200u);
        // A black texel holds none but those from its borders.
        for (size_t i = 0; i < counts.size(); ++i) {
            if (expected[i] > 0.0) continue;
            EXPECT_LT(counts[i], 20.0);
            counts[i] = 0.0;
        }
        EXPECT_GT(pearson_p_value(counts, expected), level);
        EXPECT_GT(pearson_p_value(within, std::vector<double>(within.size(), 1.0)), level);
    }
}

// A panel of one square metre beside a sky of radiance 1: powers over pi of 10 and of (0.71 m)^2 * 4 pi.
TEST_F(EnvironmentTest, TheSkyAndOtherLightsAreChosenByPower) {
    Scene scene = scene_of_mesh({});
    scene.shapes = {{.geometry = parallelogram(vec3(-0.5f, -10, 0.5f), vec3(1, 0, 0), vec3(0, 0, -1)),
                     .material = 0,
                     .emission = Emission{.radiance = vec3(10), .two_sided = false}}};
    scene.environment = Environment{.size = {1, 1}, .radiance = {vec3(1)}};
    const double sky_power = 0.5 * 4.0 * M_PI, pmf = sky_power / (10.0 + sky_power);
    std::vector<double> counts(2);
    for (const LightSample& s : sample(build_gpu_scene(scene), random_items(vec3(0), 100000, 92))) {
        const bool of_the_sky = s.Li == vec3(1);
        ++counts[of_the_sky ? 1 : 0];
        if (of_the_sky) {
            ASSERT_NEAR(s.pdf, pmf / (4.0 * M_PI), 0x1p-22);
        }
    }
    EXPECT_GT(pearson_p_value(counts, std::vector{1.0 - pmf, double(pmf)}), CHI_SQUARED_ALPHA);
}

}  // namespace
}  // namespace candela
