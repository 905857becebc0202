// Equirectangular cameras and fisheyes: what they see where, and how much of it.
#include <cmath>
#include <cstring>
#include <functional>

#include "render_fixture.h"
#include "scene/camera_axes.h"

namespace candela {
namespace {

constexpr double SPHERE_RADIUS = 3.0;
constexpr float FULL_TURN = 2.0f * PI;

// A camera somewhere, turned in all ways.
Scene scene_seen_around(Panorama panorama) {
    Scene scene = scene_with_camera(dvec3(1, -2, 0.5), dvec3(3, -1, 4), 0.0f);
    scene.cameras[0].up = vec3(0.3f, 1, -0.2f);
    scene.cameras[0].panorama = panorama;
    return scene;
}

// The same within a sphere.
Scene scene_in_sphere(Panorama panorama) {
    Scene scene = scene_seen_around(panorama);
    add_diffuse(scene, vec3(0.5f));
    add_shape(scene, Sphere{.center = scene.cameras[0].position, .radius = SPHERE_RADIUS}, 0);
    return scene;
}

// The angle to the axis at a distance from the centre of a fisheye's picture, in radii of its circle.
double fisheye_angle(Panorama panorama, double r) {
    const double edge = 0.5 * double(panorama.fisheye_fov);
    return panorama.mapping == Mapping::fisheye ? r * edge : 2.0 * std::asin(r * std::sin(0.5 * edge));
}

// The direction that a picture shows at (x, y) from its middle to the right and upwards, in halves of its
// shorter side; none outside of a fisheye's circle.
std::optional<dvec3> direction_shown(const Camera& camera, double x, double y, glm::dvec2 halves) {
    const auto [right, up, forward] = axes_of(camera);
    if (camera.panorama->mapping == Mapping::equirectangular) {
        const double longitude = M_PI * x / halves.x, latitude = M_PI / 2 * y / halves.y;
        return std::cos(latitude) * (std::cos(longitude) * forward + std::sin(longitude) * right) +
               std::sin(latitude) * up;
    }
    const double r = std::hypot(x, y), azimuth = std::atan2(y, x);
    if (r > 1.0) return std::nullopt;
    const double angle = fisheye_angle(*camera.panorama, r);
    return std::cos(angle) * forward + std::sin(angle) * (std::cos(azimuth) * right + std::sin(azimuth) * up);
}

class PanoramaTest : public RenderTest {
  protected:
    // What each pixel's centre shows within the sphere, for a camera whose centre is shifted.
    void expect_positions(Panorama panorama, uvec2 size, vec2 principal_offset = vec2(0)) const {
        SCOPED_TRACE(panorama.fisheye_fov);
        Scene scene = scene_in_sphere(panorama);
        Camera& camera = scene.cameras[0];
        camera.principal_offset = principal_offset;
        RenderSettings settings = settings_for(size.x, size.y);
        settings.crop = {1, 2, size.x, size.y};
        Renderer renderer(device(), build_gpu_scene(scene), camera, settings);
        const std::vector<float> positions = renderer.positions();
        const double half = 0.5 * std::min(size.x, size.y);
        const glm::dvec2 middle =
            0.5 * glm::dvec2(size) + double(size.y) * glm::dvec2(camera.principal_offset);
        for (uint32_t y = settings.crop.y0; y < size.y; ++y) {
            for (uint32_t x = settings.crop.x0; x < size.x; ++x) {
                const float* at = &positions[4 * (size_t(y - 2) * settings.crop.width() + x - 1)];
                const auto direction =
                    direction_shown(camera, (x + 0.5 - middle.x) / half, -(y + 0.5 - middle.y) / half,
                                    0.5 / half * glm::dvec2(size));
                if (!direction) {
                    ASSERT_EQ(vec4(at[0], at[1], at[2], at[3]), vec4(0, 0, 0, INFINITE)) << x << ' ' << y;
                    continue;
                }
                // Positions are rounded at 2^-24 of some units, a few times over, and so are places in the
                // picture, which an equisolid fisheye stretches towards the opposite of its axis.
                const double cos_half = std::sqrt(0.5 * (1.0 + dot(*direction, axes_of(camera).forward)));
                const double stretched = panorama.mapping == Mapping::equisolid ? 1.0 / cos_half : 1.0;
                const dvec3 expected = camera.position + SPHERE_RADIUS * *direction;
                ASSERT_LE(length(dvec3(at[0], at[1], at[2]) - expected), 1e-5 * stretched) << x << ' ' << y;
                ASSERT_NEAR(at[3], SPHERE_RADIUS, 1e-5) << x << ' ' << y;
            }
        }
    }
    Image image(const Scene& scene, uvec2 size, uint32_t spp) const {
        RenderSettings settings = settings_for(size.x, size.y);
        settings.sampler = SamplerKind::independent;
        return image_of(render(scene, settings, samples(spp)));
    }
};

// So its centre and its edges show what they must, at the distance from the camera.
TEST_F(PanoramaTest, EachPixelLooksWhereItsProjectionSays) {
    expect_positions({.mapping = Mapping::equirectangular}, uvec2(40, 20));
    expect_positions({.mapping = Mapping::equirectangular}, uvec2(17, 23));
    for (const Mapping mapping : {Mapping::fisheye, Mapping::equisolid}) {
        for (const float degrees : {1.0f, 100.0f, 180.0f, 230.0f, 360.0f}) {
            const Panorama fisheye{mapping, glm::radians(degrees)};
            expect_positions(fisheye, uvec2(30, 30));
            expect_positions(fisheye, uvec2(33, 20));
        }
        expect_positions({mapping, PI}, uvec2(20, 33));
        expect_positions({mapping, PI}, uvec2(33, 20), vec2(0.25f, -0.4f));
    }
}

// The picture of a sky is its map again: each sample of a pixel lies in the pixel's texel, unless the
// rounding of its place, some 2^-22 of the picture's width, moves it over an edge of its pixel: that is 4 *
// 32 * 2^-22 for each of 2048 samples, 0.06 in all; more than 4 happen with a probability of 1e-8.
TEST_F(PanoramaTest, ASkyComesBackAsItsMap) {
    constexpr uint32_t WIDTH = 32, HEIGHT = 16;
    Environment sky{.size = {WIDTH, HEIGHT}, .radiance = {}};
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i)
        sky.radiance.emplace_back(1 + i % WIDTH, 1 + i / WIDTH, 7);
    // Counter-clockwise, seen from above, -Z turns to -X.
    for (const auto& [turn, towards] :
         {std::pair(0.0f, dvec3(0, 0, -1)), std::pair(PI / 2, dvec3(-1, 0, 0))}) {
        Scene scene = scene_with_camera(dvec3(1, 2, 3), dvec3(1, 2, 3) + towards, 0.0f);
        scene.cameras[0].panorama.emplace();
        scene.environment = sky;
        scene.environment->rotation = turn;
        const Image picture = image_of(render(scene, settings_for(WIDTH, HEIGHT), 4));
        size_t others = 0;
        for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
            const vec3 seen(plane(picture, "", 0)[i], plane(picture, "", 1)[i], plane(picture, "", 2)[i]);
            others += seen != sky.radiance[i] ? 1 : 0;
        }
        EXPECT_LE(others, 4u) << turn;
    }
}

// Equal solid angles have equal areas, wherever they are, in a fisheye that is equisolid: a cap of half the
// angle a covers (sin(a/2) / sin(fov/4))^2 of the circle. In an equidistant one, that is (2 a / fov)^2 around
// the axis; in an equirectangular picture, a cap around a pole covers a / pi of the rows.
TEST_F(PanoramaTest, CapsOfTheSkyCoverTheirShareOfThePicture) {
    const auto expect_share = [&](Panorama panorama, dvec3 place, double angle, uvec2 size, double share) {
        Scene scene = scene_seen_around(panorama);
        const auto [right, up, forward] = axes_of(scene.cameras[0]);
        const dvec3 axis = place.x * right + place.y * up + place.z * forward;
        const dvec3 e1 = std::tan(angle) * normalize(cross(axis, dvec3(0.1, 0.2, 0.9)));
        add_diffuse(scene, vec3(0));
        add_shape(scene, Disk{.center = scene.cameras[0].position + axis, .e1 = e1, .e2 = cross(axis, e1)}, 0,
                  Emission{.radiance = vec3(1), .two_sided = true});
        expect_mean(image(scene, size, 256), glm::dvec3(share), 0.0);
    };
    const double angle = 0.5, circle = M_PI / 4;
    for (const uint32_t width : {64u, 96u}) {
        const uvec2 size(width, 64);
        const double part = circle * 64 / width;
        expect_share({Mapping::fisheye, 4.0f}, dvec3(0, 0, 1), angle, size, part * std::pow(angle / 2, 2.0));
        for (const float fov : {4.0f, FULL_TURN}) {
            const double share = std::pow(std::sin(angle / 2) / std::sin(double(fov) / 4), 2.0);
            expect_share({Mapping::equisolid, fov}, dvec3(0, 0, 1), angle, size, part * share);
            expect_share({Mapping::equisolid, fov}, dvec3(0.6, -0.64, 0.48), angle, size, part * share);
        }
    }
    expect_share({Mapping::equisolid, FULL_TURN}, dvec3(-0.48, 0.6, -0.64), angle, uvec2(64, 64),
                 circle * std::pow(std::sin(angle / 2), 2.0));
    expect_share({}, dvec3(0, 1, 0), angle, uvec2(64, 32), angle / M_PI);
    expect_share({}, dvec3(0, -1, 0), angle, uvec2(64, 32), angle / M_PI);
}

// Neither the sky nor a surface, and nothing that hides a background. Pixels across the edge have a part of
// it, all others 1 or 0.
TEST_F(PanoramaTest, NothingIsOutsideOfAFisheyesCircle) {
    constexpr uint32_t WIDTH = 32;
    const auto expect_circle = [&](const Scene& scene, Backdrop backdrop, bool covers) {
        RenderSettings settings = settings_for(WIDTH, WIDTH);
        settings.backdrop = backdrop;
        settings.aovs = true;
        const Image picture = make_image(
            render(scene, settings, 16),
            {.albedo = true, .normal = true, .transmission = backdrop == Backdrop::transmitted}, {});
        for (uint32_t i = 0; i < WIDTH * WIDTH; ++i) {
            const double r =
                std::hypot(i % WIDTH + 0.5 - WIDTH / 2.0, i / WIDTH + 0.5 - WIDTH / 2.0) / (WIDTH / 2.0);
            const double across = std::sqrt(0.5) / (WIDTH / 2.0);
            const float alpha = picture.find("A")->values[i], light = plane(picture, "", 0)[i];
            if (r > 1.0 + across || !covers) {
                ASSERT_EQ(alpha, 0.0f) << i;
                ASSERT_EQ(light, 0.0f) << i;
                ASSERT_EQ(plane(picture, "Albedo", 0)[i], 0.0f) << i;
                ASSERT_EQ(picture.find("N.X")->values[i], 0.0f) << i;
            } else if (r < 1.0 - across) {
                ASSERT_EQ(alpha, 1.0f) << i;
                ASSERT_GT(light, 0.0f) << i;
            }
        }
    };
    for (const Mapping mapping : {Mapping::fisheye, Mapping::equisolid}) {
        const Panorama fisheye{mapping, 4.0f};
        Scene inside = scene_in_sphere(fisheye), sky = scene_seen_around(fisheye);
        inside.shapes[0].emission = Emission{.radiance = vec3(1), .two_sided = true};
        sky.environment = constant_environment(vec3(1));
        for (const Backdrop backdrop : {Backdrop::environment, Backdrop::background, Backdrop::transmitted})
            expect_circle(inside, backdrop, true);
        expect_circle(sky, Backdrop::environment, true);
        expect_circle(sky, Backdrop::background, false);
        expect_circle(sky, Backdrop::transmitted, false);
    }
}

// Also with a filter that reaches beyond poles and edges.
TEST_F(PanoramaTest, APartHasTheBitsOfTheWhole) {
    for (const Mapping mapping : {Mapping::equirectangular, Mapping::fisheye, Mapping::equisolid}) {
        Scene scene = scene_in_sphere({mapping, 4.0f});
        scene.lights = {{"", PointLight{scene.cameras[0].position + 0.5, vec3(1, 2, 3)}}};
        const GpuScene gpu_scene = build_gpu_scene(scene);
        RenderSettings settings = settings_for(24, 16);
        settings.filter = {FilterShape::gaussian, 6.0f};
        const Accumulation whole = render(gpu_scene, scene.cameras[0], settings, 4);
        settings.crop = {5, 0, 17, 9};
        const Accumulation part = render(gpu_scene, scene.cameras[0], settings, 4);
        const Image a = image_of(whole), b = image_of(part);
        for (size_t c = 0; c < 3; ++c) {
            for (uint32_t i = 0; i < 12 * 9; ++i)
                ASSERT_EQ(plane(b, "", c)[i], plane(a, "", c)[size_t(i / 12) * 24 + 5 + i % 12]) << i;
        }
    }
}

}  // namespace
}  // namespace candela
