// Media within media have closed forms: straight rays through bodies of equal index, and stacks of slabs.
#include <algorithm>
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

constexpr vec3 OTHER_ABSORPTION(1.1f, 0.2f, 0.6f);

// A body that bends no ray.
DielectricMaterial tint(vec3 absorption, uint32_t priority = 0) {
    return {.ior = 1.0f, .fresnel = Fresnel::exact, .inside = {absorption}, .priority = priority};
}

DielectricMaterial glass(float ior, vec3 absorption = vec3(0), uint32_t priority = 0) {
    return {.ior = ior, .fresnel = Fresnel::exact, .inside = {absorption}, .priority = priority};
}

// A closed box whose sides at x and z are so far away that no ray of a test hits them.
void add_slab(Scene& scene, const DielectricMaterial& material, float bottom, float top) {
    constexpr float REACH = 100.0f;
    TriangleMesh box;
    for (const float y : {bottom, top})
        box.positions.insert(box.positions.end(), {vec3(-REACH, y, REACH), vec3(REACH, y, REACH),
                                                   vec3(REACH, y, -REACH), vec3(-REACH, y, -REACH)});
    for (const auto& [a, b, c, d] : std::initializer_list<std::array<uint, 4>>{
             {3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
        box.triangles.emplace_back(a, b, c);
        box.triangles.emplace_back(a, c, d);
    }
    add_shape(scene, box, add_material(scene, material));
}

class NestedMediaTest : public RenderTest {
  protected:
    // Seen along an axis, so narrowly that all rays are as good as one.
    static Scene seen_along(dvec3 position, dvec3 look_at) {
        Scene scene = scene_with_camera(position, look_at, 1e-3f);
        scene.environment = constant_environment(vec3(1));
        return scene;
    }
    void expect_fraction(const Scene& scene, uint32_t spp, glm::dvec3 fraction) const {
        for (const Estimator estimator : {Estimator::bsdf, Estimator::mis}) {
            SCOPED_TRACE(int(estimator));
            expect_mean(image_of(render(scene, independent_settings(32, estimator, 1), samples(spp))),
                        fraction, 2e-6);
        }
    }
    static glm::dvec3 left_after(vec3 absorption, double length) {
        return glm::exp(-length * glm::dvec3(absorption));
    }
};

// On both sides of the bubble there is glass again.
TEST_F(NestedMediaTest, ABubbleInAbsorbingGlass) {
    Scene scene = seen_along(dvec3(0, 0, 3), dvec3(0));
    add_shape(scene, Sphere{dvec3(0), 1.0}, add_material(scene, tint(ABSORPTION)));
    add_shape(scene, Sphere{dvec3(0.0, 0.0, 0.2), 0.5}, add_material(scene, tint(vec3(0))));
    expect_fraction(scene, 8, left_after(ABSORPTION, 1.0));
}

// If priorities are equal, the medium entered last fills the space.
TEST_F(NestedMediaTest, OverlapsBelongToTheHighestPriority) {
    const auto scene_of = [](uint32_t first, uint32_t second) {
        Scene scene = seen_along(dvec3(0, 0, 5), dvec3(0));
        add_shape(scene, Sphere{dvec3(0, 0, 0.5), 1.0}, add_material(scene, tint(ABSORPTION, first)));
        add_shape(scene, Sphere{dvec3(0, 0, -0.5), 1.0}, add_material(scene, tint(OTHER_ABSORPTION, second)));
        return scene;
    };
    const auto fraction = [](double near_length) {
        return left_after(ABSORPTION, near_length) * left_after(OTHER_ABSORPTION, 3.0 - near_length);
    };
    expect_fraction(scene_of(0, 0), 8, fraction(1.0));
    expect_fraction(scene_of(1, 1), 8, fraction(1.0));
    expect_fraction(scene_of(0, 15), 8, fraction(1.0));
    expect_fraction(scene_of(7, 6), 8, fraction(2.0));
}

// A stack of boundaries with slabs between them, each as deep as its medium's share `a` of light says, at
// normal incidence: the shares that it reflects and passes, by adding one boundary after the other. Ref:
// Stokes 1862, On the Intensity of the Light Reflected from or Transmitted through a Pile of Plates.
struct Pile {
    double ior = 1.0, a = 1.0;         // Index and absorption of the last slab.
    double reflected = 0, passed = 1;  // Seen from the front.
    double reflected_back = 0;         // Seen from the back.

    void add(double next_ior, double next_a) {
        const double r = std::pow((ior - next_ior) / (ior + next_ior), 2.0), t = 1.0 - r;
        const double bounces = 1.0 / (1.0 - reflected_back * r * a * a);
        reflected += passed * passed * a * a * r * bounces;
        reflected_back = r + t * t * a * a * reflected_back * bounces;
        passed *= a * t * bounces;
        ior = next_ior;
        a = next_a;
    }
};

// The share of a white sky on both sides that the pile sends to the viewer.
glm::dvec3 sky_seen_through(const std::vector<std::pair<double, glm::dvec3>>& layers) {
    glm::dvec3 fraction(0);
    for (int c = 0; c < 3; ++c) {
        Pile pile;
        for (const auto& [ior, a] : layers)
            pile.add(ior, a[c]);
        pile.add(1.0, 1.0);
        fraction[c] = pile.reflected + pile.passed;
    }
    return fraction;
}

TEST_F(NestedMediaTest, AMediumWithinItselfChangesNothing) {
    Scene scene = seen_along(dvec3(0, 4, 0), dvec3(0));
    add_slab(scene, glass(1.5f, ABSORPTION), -1, 1);
    add_shape(scene, Sphere{dvec3(0, 0.1, 0), 0.3}, add_material(scene, glass(1.5f, ABSORPTION)));
    expect_fraction(scene, 4096, sky_seen_through({{1.5, left_after(ABSORPTION, 2.0)}}));
}

// Two balls that overlap, as one mesh and as two: the same bits.
TEST_F(NestedMediaTest, PartsOfAMeshAreSolidsOfTheirOwn) {
    const auto picture = [&](bool one_mesh) {
        Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.6f);
        scene.environment = constant_environment(vec3(1));
        const uint32_t material = add_material(scene, tint(ABSORPTION));
        TriangleMesh balls = transformed(sphere_mesh(8, 12), [](vec3 p) { return p + vec3(0.4f, 0, 0.1f); });
        const TriangleMesh other =
            transformed(sphere_mesh(8, 12), [](vec3 p) { return p - vec3(0.4f, 0, 0); });
        if (!one_mesh) {
            add_shape(scene, balls, material);
            add_shape(scene, other, material);
        } else {
            const auto first = uint32_t(balls.positions.size());
            balls.positions.insert(balls.positions.end(), other.positions.begin(), other.positions.end());
            for (const uvec3 t : other.triangles)
                balls.triangles.push_back(first + t);
            add_shape(scene, balls, material);
        }
        return image_of(render(scene, independent_settings(16, Estimator::mis, 1), 16));
    };
    const Image one = picture(true), two = picture(false);
    for (size_t c = 0; c < 3; ++c)
        EXPECT_TRUE(std::ranges::equal(plane(one, "", c), plane(two, "", c))) << c;
}

// Where both sides of a pane have the same distance in floats, rays may miss one of them; but no light comes
// from nowhere.
TEST_F(NestedMediaTest, AVeryThinPaneGivesNoLight) {
    for (const float thickness : {1e-6f, 1e-7f, 1e-9f}) {
        Scene scene = scene_with_camera(dvec3(0.013, 5, 0.021), dvec3(0.013, 0, 0.021), 0.02f);
        scene.cameras[0].up = vec3(0, 0, 1);
        scene.environment = constant_environment(vec3(1));
        add_slab(scene, glass(1.5f, -glm::log(vec3(0.6f, 0.7f, 0.8f)) / thickness), 0, thickness);
        const Image picture =
            image_of(render(scene, independent_settings(8, Estimator::mis, 1), samples(64)));
        for (size_t c = 0; c < 3; ++c) {
            for (const float value : plane(picture, "", c))
                EXPECT_LE(value, 1.0f + 1e-5f) << thickness;
        }
    }
}

TEST_F(NestedMediaTest, ASlabOfGlassInWater) {
    Scene scene = seen_along(dvec3(0, 4, 0), dvec3(0));
    add_slab(scene, glass(1.33f, ABSORPTION), -1, 1);
    add_slab(scene, glass(1.9f, OTHER_ABSORPTION), -0.25f, 0.5f);
    expect_fraction(scene, 1024,
                    sky_seen_through({{1.33, left_after(ABSORPTION, 0.5)},
                                      {1.9, left_after(OTHER_ABSORPTION, 0.75)},
                                      {1.33, left_after(ABSORPTION, 0.75)}}));
}

// Water that overlaps the bottom of its glass, as modellers make it, so that no gap can open.
TEST_F(NestedMediaTest, WaterThatOverlapsItsGlass) {
    Scene scene = seen_along(dvec3(0, 4, 0), dvec3(0));
    add_slab(scene, glass(1.33f, ABSORPTION), -0.3f, 1);
    add_slab(scene, glass(1.9f, OTHER_ABSORPTION, 1), -0.5f, 0);
    expect_fraction(
        scene, 1024,
        sky_seen_through({{1.33, left_after(ABSORPTION, 1.0)}, {1.9, left_after(OTHER_ABSORPTION, 0.5)}}));
}

// A stated exterior index is used regardless of the medium there.
TEST_F(NestedMediaTest, AStatedExteriorIndex) {
    Scene scene = seen_along(dvec3(0, 4, 0), dvec3(0));
    add_slab(scene, tint(ABSORPTION), -1, 1);
    DielectricMaterial inner = glass(1.9f);
    inner.exterior_ior = 1.9f;
    add_slab(scene, inner, 0.0f, 0.5f);
    expect_fraction(scene, 8, left_after(ABSORPTION, 1.5));
}

TEST_F(NestedMediaTest, ACameraInTwoMedia) {
    Scene scene = seen_along(dvec3(0), dvec3(0, 0, -1));
    add_shape(scene, Sphere{dvec3(0), 1.0}, add_material(scene, tint(ABSORPTION)));
    expect_fraction(scene, 8, left_after(ABSORPTION, 1.0));
    add_shape(scene, Sphere{dvec3(0), 0.25}, add_material(scene, tint(OTHER_ABSORPTION)));
    expect_fraction(scene, 8, left_after(OTHER_ABSORPTION, 0.25) * left_after(ABSORPTION, 0.75));
}

// A glass ball that holds water that holds a bubble: every ray comes from the white sky.
TEST_F(NestedMediaTest, NestedClearBallsAreInvisible) {
    Scene scene = scene_with_camera(dvec3(0.5, 1, 4), dvec3(0), 0.6f);
    scene.environment = constant_environment(vec3(1));
    for (const auto& [ior, radius] :
         std::initializer_list<std::pair<float, double>>{{1.5f, 1.0}, {1.33f, 0.8}, {1.0f, 0.5}, {2.4f, 0.2}})
        add_shape(scene, Sphere{dvec3(0), radius}, add_material(scene, glass(ior)));
    RenderSettings settings = independent_settings(32, Estimator::mis, 1);
    settings.rr_depth = DEPTH_SAFETY_LIMIT;
    const Image picture = image_of(render(scene, settings, samples(64)));
    for (const float value : plane(picture, "", 0))
        ASSERT_NEAR(value, 1.0f, 1e-3f);
}

// A lake that is only a sheet has no bottom, and no sky below it.
TEST_F(NestedMediaTest, NoLightComesFromAMediumWithoutAnEnd) {
    Scene scene = seen_along(dvec3(0, 1, 0), dvec3(0));
    scene.cameras[0].up = vec3(0, 0, 1);
    add_shape(scene, parallelogram(vec3(-9, 0, 9), vec3(18, 0, 0), vec3(0, 0, -18)),
              add_material(scene, tint(vec3(0.1f, 2, 0))));
    expect_fraction(scene, 8, glm::dvec3(0, 0, 1));
}

}  // namespace
}  // namespace candela
