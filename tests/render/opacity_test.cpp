// Surfaces that rays pass: fractions of light have closed forms, for any shapes and any order in which they
// are hit.
#include <cmath>

#include "estimator_fixture.h"

namespace candela {
namespace {

class OpacityTest : public EstimatorTest {
  protected:
    // A camera at z = 5 that looks along -z through a small window at a sky of radiance 1.
    static Scene sky_seen() {
        Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.05f);
        scene.environment = constant_environment(vec3(1));
        return scene;
    }
    static uint32_t add_veil(Scene& scene, float opacity) {
        const uint32_t material = add_diffuse(scene, vec3(0));
        scene.materials[material].opacity.value = opacity;
        return material;
    }
    void expect_fraction(const Scene& scene, Estimator estimator, double fraction) const {
        expect_mean(image_of(render(scene, independent_settings(32, estimator, 3), samples(2048))),
                    glm::dvec3(fraction), 1e-6);
    }
    // A quad at that depth that fills the view.
    static Quad pane(float z) { return parallelogram(vec3(-1, -1, z), vec3(2, 0, 0), vec3(0, 2, 0)); }
};

TEST_F(OpacityTest, NLayersPassTheNthPower) {
    constexpr float A = 0.2f;
    for (const int layers : {1, 2, 5, 9}) {
        Scene scene = sky_seen();
        const uint32_t veil = add_veil(scene, A);
        for (int i = 0; i < layers; ++i)
            add_shape(scene, pane(-0.1f * float(i)), veil);
        expect_fraction(scene, Estimator::mis, std::pow(1.0 - double(A), layers));
    }
}

// A sphere is two layers, a disk one; a soup of triangles in one plane as many as lie over each other: here
// two.
TEST_F(OpacityTest, EveryKindOfShapeHasItsLayers) {
    constexpr float A = 0.4f;
    Scene sphere = sky_seen();
    add_shape(sphere, Sphere{dvec3(0), 2.0}, add_veil(sphere, A));
    expect_fraction(sphere, Estimator::mis, std::pow(1.0 - double(A), 2));
    Scene within = sky_seen();
    add_shape(within, Sphere{dvec3(0), 8.0}, add_veil(within, A));
    expect_fraction(within, Estimator::mis, 1.0 - double(A));
    Scene disk = sky_seen();
    add_shape(disk, Disk{dvec3(0), dvec3(2, 0, 0), dvec3(0, 2, 0)}, add_veil(disk, A));
    expect_fraction(disk, Estimator::mis, 1.0 - double(A));
    Scene mesh = sky_seen();
    TriangleMesh triangles;
    add_triangle(triangles, vec3(-2, -2, 0), vec3(2, -2, 0), vec3(0, 3, 0));
    add_triangle(triangles, vec3(-2, -2, 0), vec3(2, -2, 0), vec3(0, 3, 0));
    add_shape(mesh, triangles, add_veil(mesh, A));
    expect_fraction(mesh, Estimator::mis, std::pow(1.0 - double(A), 2));
}

// The colours of vertices have an opacity, too.
TEST_F(OpacityTest, VerticesLetRaysPass) {
    Scene scene = sky_seen();
    const uint32_t painted = add_diffuse(scene, vec3(0));
    scene.materials[painted].vertex_colors = true;
    TriangleMesh mesh;
    add_triangle(mesh, vec3(-2, -2, 0), vec3(2, -2, 0), vec3(0, 3, 0));
    mesh.colors = {vec4(1, 1, 1, 0.25f), vec4(1, 1, 1, 0.25f), vec4(1, 1, 1, 0.25f)};
    add_shape(scene, mesh, painted);
    expect_fraction(scene, Estimator::mis, 0.75);
}

// Shadow rays pass, too: a lamp through n panes.
TEST_F(OpacityTest, ALampShinesThroughTheNthPower) {
    constexpr float A = 0.3f;
    for (const int layers : {0, 1, 3}) {
        for (const Estimator estimator : ESTIMATORS) {
            SCOPED_TRACE(testing::Message() << layers << ' ' << int(estimator));
            Scene scene = floor_seen_closely(vec3(1));
            const uint32_t veil = add_veil(scene, A);
            for (int i = 0; i < layers; ++i)
                add_shape(
                    scene,
                    parallelogram(vec3(-3, 0.5f + 0.1f * float(i), -3), vec3(0, 0, 4.2f), vec3(6, 0, 0)),
                    veil);
            // The radiance that the floor reflects is sin^2 of half the angle that the lamp fills around its
            // zenith.
            constexpr double RADIUS = 1.0, HEIGHT = 2.0;
            add_shape(scene, Sphere{dvec3(0, HEIGHT, 0), RADIUS}, 1, Emission{vec3(1), false});
            const double expected = RADIUS * RADIUS / (HEIGHT * HEIGHT) * std::pow(1.0 - double(A), layers);
            const uint32_t spp = estimator == Estimator::bsdf ? 4096 : 2048;
            expect_mean(image_of(render(scene, independent_settings(32, estimator, 4), samples(spp))),
                        glm::dvec3(expected), 5e-5);
        }
    }
}

// A shadow ray is dimmed and never stopped by chance: a point of light makes the same picture through panes,
// darker, sample by sample. Its bits are independent of the order of the panes.
TEST_F(OpacityTest, AShadowRayIsDimmedWithoutNoise) {
    const float opacities[] = {0.3f, 0.001f, 0.9f, 0.62f};
    Scene open = floor_seen_closely(vec3(1));
    open.lights = {{"", PointLight{dvec3(0.3, 4, 0), vec3(30)}}};
    Scene panes = open, reversed = open;
    double fraction = 1.0;
    for (int i = 0; i < 4; ++i) {
        const auto pane_above = [&](Scene& scene, int number) {
            const float y = 0.5f + 0.1f * float(number);
            add_shape(scene, parallelogram(vec3(-3, y, -3), vec3(0, 0, 4.2f), vec3(6, 0, 0)),
                      add_veil(scene, opacities[number]));
        };
        pane_above(panes, i);
        pane_above(reversed, 3 - i);
        fraction *= 1.0 - double(opacities[i]);
    }
    const RenderSettings settings = independent_settings(16, Estimator::light, 4);
    const Image lit = image_of(render(open, settings, 8)), dim = image_of(render(panes, settings, 8));
    for (size_t i = 0; i < lit.pixel_count(); ++i)
        ASSERT_NEAR(plane(dim, "", 0)[i], fraction * plane(lit, "", 0)[i], 1e-6 * plane(lit, "", 0)[i]) << i;
    EXPECT_TRUE(std::ranges::equal(plane(image_of(render(reversed, settings, 8)), "", 0), plane(dim, "", 0)));
}

TEST_F(OpacityTest, TheCameraSeesNothingOfWhatIsHiddenFromIt) {
    const auto expect_hidden = [&](const auto& geometry) {
        Scene scene = sky_seen();
        const uint32_t wall = add_diffuse(scene, vec3(0));
        add_shape(scene, geometry, wall);
        expect_fraction(scene, Estimator::mis, 0.0);
        scene.materials[wall].hidden = true;
        expect_fraction(scene, Estimator::mis, 1.0);
    };
    expect_hidden(pane(0));
    expect_hidden(Sphere{dvec3(0), 2.0});
    expect_hidden(Sphere{dvec3(0), 8.0});
    expect_hidden(Disk{dvec3(0), dvec3(2, 0, 0), dvec3(0, 2, 0)});
    TriangleMesh triangles;
    add_triangle(triangles, vec3(-2, -2, 0), vec3(2, -2, 0), vec3(0, 3, 0));
    expect_hidden(triangles);
}

// A lamp above the floor and below the camera, and a ball in the way of a point of light: they light and
// shade as if they were seen.
TEST_F(OpacityTest, WhatIsHiddenFromTheCameraLightsAndShades) {
    constexpr double RADIUS = 0.8, HEIGHT = 0.15;
    for (const Estimator estimator : ESTIMATORS) {
        SCOPED_TRACE(int(estimator));
        Scene scene = floor_seen_closely(vec3(1));
        const uint32_t black = add_diffuse(scene, vec3(0));
        scene.materials[black].hidden = true;
        add_shape(scene, Disk{dvec3(0, HEIGHT, 0), dvec3(RADIUS, 0, 0), dvec3(0, 0, RADIUS)}, black,
                  Emission{vec3(1), false});
        const double expected = RADIUS * RADIUS / (RADIUS * RADIUS + HEIGHT * HEIGHT);
        expect_mean(image_of(render(scene, independent_settings(32, estimator, 4), samples(4096))),
                    glm::dvec3(expected), 1e-4);
    }
    Scene shaded = floor_seen_closely(vec3(1));
    shaded.lights = {{"", PointLight{dvec3(0, 1, 5), vec3(30)}}};  // At the camera.
    const Image lit = image_of(render(shaded, independent_settings(16, Estimator::mis, 4), samples(8)));
    EXPECT_GT(image_mean(lit, 0).mean, 0.01);
    const uint32_t hidden = add_diffuse(shaded, vec3(0));
    shaded.materials[hidden].hidden = true;
    add_shape(shaded, Sphere{dvec3(0, 0.2, 1), 0.15}, hidden);  // On the line to the floor.
    const Image dark = image_of(render(shaded, independent_settings(16, Estimator::mis, 4), samples(8)));
    EXPECT_EQ(image_mean(dark, 0).mean, 0.0);
}

// Two triangles that share an edge and are folded onto each other are one primitive. Where a ray hits both,
// either may be transparent.
TEST_F(OpacityTest, BothTrianglesOfAFoldedPairAreTested) {
    for (const bool near_is_mask : {false, true}) {
        for (const bool far_is_mask : {false, true}) {
            Scene scene = sky_seen();
            // Opaque where u < 1/2.
            Texture mask = add_texture(scene, {2, 1},
                                       [](uint32_t x, uint32_t) { return vec4(0, 0, 0, x == 0 ? 1 : 0); });
            mask.filter = TextureFilter::nearest;
            mask.wrap_u = Wrap::clamp;
            mask.channel = 3;
            const uint32_t leaf = add_diffuse(scene, vec3(0));
            scene.materials[leaf].opacity = {.value = {1.0f, mask}, .cutoff = 0.5f};
            TriangleMesh mesh;
            mesh.positions = {vec3(-3, -2, 0), vec3(3, -2, 0), vec3(0, 4, 0.2f), vec3(0, 4, -0.2f)};
            mesh.triangles = {uvec3(0, 1, 2), uvec3(1, 0, 3)};
            // Each triangle needs texture coordinates of its own.
            const float near_u = near_is_mask ? 0.9f : 0.1f, far_u = far_is_mask ? 0.9f : 0.1f;
            mesh.positions.insert(mesh.positions.end(), {mesh.positions[1], mesh.positions[0]});
            mesh.uv0 = {vec2(near_u, 0), vec2(near_u, 0), vec2(near_u, 0),
                        vec2(far_u, 0),  vec2(far_u, 0),  vec2(far_u, 0)};
            mesh.triangles[1] = uvec3(4, 5, 3);
            add_shape(scene, mesh, leaf);
            expect_fraction(scene, Estimator::mis, near_is_mask && far_is_mask ? 1.0 : 0.0);
            // The same as one primitive, the value changing across the common edge.
            scene.shapes.pop_back();
            mesh.positions.resize(4);
            mesh.uv0 = {vec2(0.5f, 0), vec2(0.5f, 0), vec2(near_is_mask ? 1.0f : 0.0f, 0),
                        vec2(far_is_mask ? 1.0f : 0.0f, 0)};
            mesh.triangles[1] = uvec3(1, 0, 3);
            add_shape(scene, mesh, leaf);
            expect_fraction(scene, Estimator::mis, near_is_mask && far_is_mask ? 1.0 : 0.0);
        }
    }
}

// A leaf with a hole before a lamp: its shadow has the hole.
TEST_F(OpacityTest, ALeafCastsALeafsShadow) {
    for (const double x : {0.0, 0.6}) {  // Under the hole, under the rest.
        Scene scene = floor_seen_closely(vec3(1));
        Texture mask = add_texture(scene, {32, 32}, [](uint32_t i, uint32_t j) {
            const vec2 p = (vec2(i, j) + 0.5f) / 32.0f - 0.5f;
            return vec4(0, 0, 0, length(p) < 0.1f ? 0 : 1);
        });
        mask.channel = 3;
        const uint32_t leaf = add_diffuse(scene, vec3(0));
        scene.materials[leaf].opacity = {.value = {1.0f, mask}, .cutoff = 0.5f};
        add_shape(scene, Disk{dvec3(-x, 0.5, 0), dvec3(1, 0, 0), dvec3(0, 0, -1)}, leaf);
        constexpr double RADIUS = 0.1, HEIGHT = 4.0;
        add_shape(scene, Sphere{dvec3(0, HEIGHT, 0), RADIUS}, 1, Emission{vec3(1000), false});
        const double lit = 1000.0 * RADIUS * RADIUS / (HEIGHT * HEIGHT);
        for (const Estimator estimator : {Estimator::light, Estimator::mis}) {
            expect_mean(image_of(render(scene, independent_settings(16, estimator, 4), 256)),
                        glm::dvec3(x == 0.0 ? lit : 0.0), 5e-5);
        }
    }
}

// Other seeds pass other rays: no pixel is all or nothing.
TEST_F(OpacityTest, EverySampleDecidesForItself) {
    Scene scene = sky_seen();
    add_shape(scene, pane(0), add_veil(scene, 0.5f));
    const Image picture = image_of(render(scene, independent_settings(32, Estimator::mis, 9), 256));
    for (const float value : plane(picture, "", 0)) {
        ASSERT_GT(value, 0.25f);  // 8 standard deviations.
        ASSERT_LT(value, 0.75f);
    }
}

}  // namespace
}  // namespace candela
