// Bump maps: the normals that they give, at any scale, on any shape.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "render_fixture.h"
#include "scene/mesh.h"

namespace candela {
namespace {

class BumpTest : public RenderTest {
  protected:
    // The shading normal in the middle of the picture, of which all of the picture is a tiny part.
    vec3 normal_seen(Scene scene) const {
        constexpr float TINY = 1e-5f;
        scene.cameras.at(0).vertical_fov = TINY;
        RenderSettings settings = settings_for(8, 8);
        settings.aovs = true;
        settings.max_depth = 0;
        const Image image = make_image(render(scene, settings, 1), {.normal = true}, {});
        const auto at = [&](size_t i) {
            return vec3(image.find("N.X")->values[i], image.find("N.Y")->values[i],
                        image.find("N.Z")->values[i]);
        };
        EXPECT_LT(length(at(0) - at(63)), 1e-3f);
        return at(27);
    }

    // A material whose heights in metres are `scale` times height(x, y) at the texels.
    static uint32_t add_bumpy(Scene& scene, uvec2 size, float scale,
                              const std::function<float(uint32_t, uint32_t)>& height,
                              const std::function<void(Texture&)>& change = {}) {
        Texture texture =
            add_texture(scene, size, [&](uint32_t x, uint32_t y) { return vec4(0, height(x, y), 0, 1); });
        texture.channel = 1;
        if (change) change(texture);
        const uint32_t material = add_diffuse(scene, vec3(0.5f));
        scene.materials[material].bump_map = BumpMap{texture, scale};
        return material;
    }

    static Scene seen_from(dvec3 position, dvec3 look_at) {
        return scene_with_camera(position, look_at, 0.1f);
    }
};

// Heights that grow linearly with u and v, not negative and exact in half floats. Between texels 1 and 6 no
// other is near.
float ramp(uint32_t x, uint32_t y) {
    return 2.0f + float(x) / 8.0f - float(y) / 4.0f;
}
constexpr double RAMP_U = 1.0, RAMP_V = 2.0;  // Rows run from the top, v upwards.
constexpr uvec2 RAMP_SIZE(8, 8);

// The normal of the plane with the edges e1 and e2, along which u and v change by uv1 and uv2, if it is
// displaced by heights with that derivative along (u, v).
vec3 displaced(dvec3 e1, dvec3 e2, glm::dvec2 uv1, glm::dvec2 uv2, glm::dvec2 slope) {
    const dvec3 n = normalize(cross(e1, e2));
    return vec3(normalize(cross(e1 + dot(slope, uv1) * n, e2 + dot(slope, uv2) * n)));
}

// Rounding: coordinates of 1e-7, in differences over a texel of 1/8, and a few operations more.
constexpr float ROUNDING = 1e-5f;

TEST_F(BumpTest, ARampTurnsAQuadByItsAngle) {
    for (const bool behind : {false, true}) {
        Scene scene = seen_from(dvec3(0.1, 0.2, behind ? -9 : 9), dvec3(0.1, 0.2, 0));
        const float scale = -0.5f;
        add_shape(scene, parallelogram(dvec3(-1, -2, 0), dvec3(3, 0, 0), dvec3(0.5, 4, 0)),
                  add_bumpy(scene, RAMP_SIZE, scale, ramp));
        const vec3 expected = displaced(dvec3(3, 0, 0), dvec3(0.5, 4, 0), {1, 0}, {0, 1},
                                        double(scale) * glm::dvec2(RAMP_U, RAMP_V));
        EXPECT_LT(length(normal_seen(scene) - (behind ? -expected : expected)), ROUNDING) << behind;
    }
}

TEST_F(BumpTest, ARampTurnsEachTriangleByItsCoordinates) {
    const dvec3 a(-1, -1, 0), b(1, -1, 0.5), c(1, 1, 0), d(-1, 1, -0.5);
    const glm::dvec2 uv[4] = {{0.2, 0.3}, {0.7, 0.2}, {0.8, 0.8}, {0.4, 0.6}};
    // The coordinates are turned by 90 degrees, and scaled.
    const auto turn = [](Texture& texture) {
        texture.rows[0] = vec3(0, -0.5, 0.75);
        texture.rows[1] = vec3(0.5, 0, 0.25);
        texture.uv_set = 1;
    };
    const glm::dvec2 slope(0.5 * RAMP_V, -0.5 * RAMP_U);
    for (const bool second : {false, true}) {
        const dvec3 seen = second ? (a + c + d) / 3.0 : (a + b + c) / 3.0;
        Scene scene = seen_from(seen + dvec3(0, 0, 9), seen);
        TriangleMesh mesh;
        for (const dvec3 p : {a, b, c, d})
            mesh.positions.emplace_back(p);
        for (const glm::dvec2 p : uv) {
            mesh.uv0.emplace_back(0.5f);
            mesh.uv1.emplace_back(p);
        }
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        add_shape(scene, mesh, add_bumpy(scene, RAMP_SIZE, 1.0f, ramp, turn));
        const vec3 expected = second ? displaced(c - a, d - a, uv[2] - uv[0], uv[3] - uv[0], slope)
                                     : displaced(b - a, c - a, uv[1] - uv[0], uv[2] - uv[0], slope);
        EXPECT_LT(length(normal_seen(scene) - expected), ROUNDING) << second;
    }
}

TEST_F(BumpTest, ARampTurnsAnEllipse) {
    const dvec3 e1(2, 0.5, 0), e2(-0.5, 1, 0.5);
    Scene scene = seen_from(dvec3(0.1, 0.1, 9), dvec3(0.1, 0.1, 0));
    add_shape(scene, Disk{dvec3(0), e1, e2}, add_bumpy(scene, RAMP_SIZE, 0.75f, ramp));
    const vec3 expected = displaced(e1, e2, {0.5, 0}, {0, 0.5}, 0.75 * glm::dvec2(RAMP_U, RAMP_V));
    EXPECT_LT(length(normal_seen(scene) - expected), ROUNDING);
}

// Waves all around a sphere, k of them along u and v. A quadratic B-spline makes the slope of a sine that has
// L texels a wave less by a factor of sinc(1 / L)^3.
TEST_F(BumpTest, WavesOnASphereHaveTheirNormals) {
    constexpr double RADIUS = 2.0, SCALE = 0.3;
    constexpr uint32_t SIDE = 128;
    constexpr double K = 2.0, TURN = 2.0 * M_PI;
    const auto height = [&](uint32_t x, uint32_t y) {
        const double u = (x + 0.5) / SIDE, v = 1.0 - (y + 0.5) / SIDE;
        return float(0.5 + 0.25 * std::sin(TURN * K * u) + 0.125 * std::cos(TURN * K * v));
    };
    const double step = M_PI * K / SIDE, factor = std::pow(std::sin(step) / step, 3);
    for (const glm::dvec2 place : {glm::dvec2(0, 0.5), glm::dvec2(0.3, 0.7), glm::dvec2(0.55, 0.2)}) {
        const double u = TURN * place.x, v = M_PI * (place.y - 0.5);
        const dvec3 n(std::cos(v) * std::cos(u), std::sin(v), -std::cos(v) * std::sin(u));
        const dvec3 along_u(-std::sin(u), 0, -std::cos(u));
        const dvec3 along_v = cross(n, along_u);
        Scene scene = seen_from(5.0 * RADIUS * n, RADIUS * n);
        add_shape(scene, Sphere{dvec3(0), RADIUS}, add_bumpy(scene, uvec2(SIDE), float(SCALE), height));
        const double by_u = SCALE * factor * 0.25 * TURN * K * std::cos(TURN * K * place.x);
        const double by_v = -SCALE * factor * 0.125 * TURN * K * std::sin(TURN * K * place.y);
        const dvec3 gradient =
            by_u / (TURN * RADIUS * std::cos(v)) * along_u + by_v / (M_PI * RADIUS) * along_v;
        // Half floats below 1 are off by 2^-12, differences over a texel by twice that; u and v each.
        const double error =
            SCALE * SIDE * 0x1p-11 * (1 / (TURN * RADIUS * std::cos(v)) + 1 / (M_PI * RADIUS));
        EXPECT_LT(length(dvec3(normal_seen(scene)) - normalize(n - gradient)), error) << place.x;
        EXPECT_GT(length(gradient), 10 * error);
    }
}

// Beyond an image's edge the ramp begins anew, runs back, or ends.
TEST_F(BumpTest, HeightsGoOnBeyondTheImage) {
    for (const auto& [wrap, expected] :
         {std::pair(Wrap::repeat, 1.0), std::pair(Wrap::mirror, -1.0), std::pair(Wrap::clamp, 0.0)}) {
        Scene scene = seen_from(dvec3(0.5, 0.5, 9), dvec3(0.5, 0.5, 0));
        add_shape(scene, parallelogram(dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)),
                  add_bumpy(scene, RAMP_SIZE, 1.0f, ramp, [&, wrapped = wrap](Texture& texture) {
                      texture.wrap_u = wrapped;
                      texture.rows[0].z = 1.0f;
                  }));
        const vec3 normal = displaced({1, 0, 0}, {0, 1, 0}, {1, 0}, {0, 1}, {expected * RAMP_U, RAMP_V});
        EXPECT_LT(length(normal_seen(scene) - normal), ROUNDING) << int(wrap);
    }
}

TEST_F(BumpTest, APowerOfTwoChangesNoBit) {
    const auto scene_at = [](double scale) {
        Scene scene = scene_with_camera(scale * dvec3(0.5, 1, 3), scale * dvec3(0, 0.5, 0), 0.6f);
        scene.environment = constant_environment(vec3(1));
        const auto height = [](uint32_t x, uint32_t y) { return 0.5f + 0.5f * std::sin(float(x + 2 * y)); };
        const uint32_t bumpy = add_bumpy(scene, uvec2(16), float(scale * 0.1), height);
        add_shape(scene, Sphere{scale * dvec3(0, 0.5, 0), 0.5 * scale}, bumpy);
        add_shape(scene,
                  parallelogram(scale * dvec3(-1, 0, 1), scale * dvec3(2, 0, 0), scale * dvec3(0, 0, -2)),
                  bumpy);
        return scene;
    };
    const auto values = [&](double scale) {
        return render(scene_at(scale), independent_settings(32, Estimator::mis, 1), 2).values;
    };
    const auto first = values(1.0);
    for (const int exponent : {-30, -3, 1, 30})
        EXPECT_TRUE(values(std::ldexp(1.0, exponent)) == first) << "at 2^" << exponent;
}

// A bump map and a normal map of the same plane tilted by 30 degrees are one surface.
TEST_F(BumpTest, AreShadedAsNormalMapsAre) {
    const auto scene_with = [](bool heights) {
        Scene scene = open_room();
        uint32_t material = 0;
        const auto clamp = [](Texture& texture) {
            texture.rows[0] = vec3(0.5f, 0, 0.25f);
            texture.rows[1] = vec3(0, 0.5f, 0.25f);
        };
        if (heights) {
            material = add_bumpy(
                scene, RAMP_SIZE, 1.0f, [](uint32_t x, uint32_t) { return float(x) / 8.0f; }, clamp);
        } else {
            const vec3 n = normalize(vec3(-0.5f, 0, 1));
            const Texture map =
                add_texture(scene, {1, 1}, [&](uint32_t, uint32_t) { return vec4(0.5f * n + 0.5f, 1); });
            material = add_diffuse(scene, vec3(0.5f));
            scene.materials[material].normal_map = NormalMap{map, 1.0f};
        }
        add_shape(scene, parallelogram(vec3(-0.5f, 0.3f, 0.5f), vec3(1, 0, 0), vec3(0, 0, -1)), material);
        add_shape(scene, parallelogram(vec3(-0.5f, 1.5f, -0.2f), vec3(1, 0, 0), vec3(0, 0, 0.4f)),
                  add_diffuse(scene, vec3(0)), Emission{vec3(5), false});
        return scene;
    };
    const RenderSettings settings = independent_settings(64, Estimator::mis, 1);
    const Image a = image_of(render(scene_with(true), settings, 16));
    const Image b = image_of(render(scene_with(false), settings, 16));
    // Half floats of 2^-12 in a normal, and frames around normals: the same paths but for few.
    EXPECT_NEAR(image_mean(a, 0).mean / image_mean(b, 0).mean, 1.0, 1e-3);
}

// A mirror's facet that slopes away by 45 degrees from a viewer 30 degrees above it would mirror the ground.
// It is turned until it mirrors the foot of a wall, 0.01 rad above the ground.
TEST_F(BumpTest, AFacetThatSlopesAwayMirrorsTheHorizon) {
    Scene scene = seen_from(dvec3(-2 * std::cos(M_PI / 6), 2 * std::sin(M_PI / 6), 0), dvec3(0));
    scene.cameras[0].vertical_fov = 1e-5f;
    const uint32_t mirror =
        add_bumpy(scene, RAMP_SIZE, -1.0f, [](uint32_t x, uint32_t) { return float(x) / 8.0f; });
    scene.materials[mirror].model = MirrorMaterial{};
    add_shape(scene, parallelogram(dvec3(-0.5, 0, 0.5), dvec3(1, 0, 0), dvec3(0, 0, -1)), mirror);
    add_shape(scene, parallelogram(dvec3(3, 0.02, -1), dvec3(0, 0, 2), dvec3(0, 0.02, 0)),
              add_diffuse(scene, vec3(0)), Emission{vec3(5), false});
    expect_pixels(image_of(render(scene, independent_settings(8, Estimator::mis, 1), 1)), vec3(5));
}

}  // namespace
}  // namespace candela
