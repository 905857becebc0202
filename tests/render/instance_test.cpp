// A scene of instances has the picture of the scene in which every copy is baked.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <glm/gtc/matrix_transform.hpp>

#include "load/load.h"
#include "probe/random.h"
#include "render_fixture.h"
#include "scene/mesh.h"

namespace candela {
namespace {

constexpr InstancingRule ALL{.least_uses = 1, .least_triangles = 1};
constexpr InstancingRule NONE{.least_uses = ~0u, .least_triangles = ~0u};

// A transform that turns, shears, mirrors every other time, and scales by 10^-3 to 10^3.
Transform random_transform(Random& random, bool mirrored) {
    const auto signed_unit = [&] { return 2.0 * double(random.unit()) - 1.0; };
    Transform transform;
    transform.append(glm::rotate(glm::dmat4(1.0), 3.0 * signed_unit(), dvec3(random.direction())));
    glm::dmat4 shear(1.0);
    shear[1][0] = signed_unit();
    transform.append(shear);
    const double size = std::pow(10.0, 3.0 * signed_unit());
    transform.append(glm::scale(glm::dmat4(1.0), size * dvec3(mirrored ? -1.0 : 1.0, 1.3, 0.8)));
    transform.append(glm::translate(glm::dmat4(1.0), size * dvec3(random.cube())));
    return transform;
}

// Moves every mesh into a space of its own, from which its instance brings it back to where it was.
void cut_into_instances(Scene& scene) {
    Random random(1);
    bool mirrored = true;
    for (Shape& shape : scene.shapes) {
        auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance == nullptr) continue;
        const Transform there = random_transform(random, mirrored = !mirrored);
        Transform back;
        ASSERT_TRUE(back.append(inverse(there.matrix())));
        TriangleMesh mesh = placed(scene.meshes[instance->mesh], there);
        ASSERT_TRUE(back.append(instance->transform.matrix()));
        instance->transform = back;
        instance->mesh = uint32_t(scene.meshes.size());
        scene.meshes.push_back(std::move(mesh));
    }
}

class InstanceTest : public RenderTest, public testing::WithParamInterface<const char*> {
  protected:
    // Two pictures with samples of their own must have one expectation. `most_error` is the largest standard
    // error of the mean over it.
    void expect_same_picture(const Scene& baked, const Scene& instanced, uint32_t spp,
                             double most_error) const {
        const GpuScene with = build_gpu_scene(instanced, choose_frame(instanced), ALL);
        EXPECT_FALSE(with.instances.empty());
        const GpuScene without = build_gpu_scene(baked, choose_frame(baked), NONE);
        EXPECT_TRUE(without.instances.empty());
        RenderSettings settings = independent_settings(48, Estimator::mis, 1);
        settings.max_depth = baked.integrator.max_depth.value_or(16);
        const Image a = image_of(render(with, instanced.cameras.at(0), settings, samples(spp)));
        settings.seed = 2;
        const Image b = image_of(render(without, baked.cameras.at(0), settings, samples(spp)));
        for (size_t c = 0; c < 3; ++c) {
            const ImageMean mean = image_mean(a, c);
            EXPECT_LE(mean.error, (test_effort() == Effort::quick ? 4.0 : 1.0) * most_error * mean.mean);
        }
        const Comparison comparison = compare(a, b, {.alpha = TEST_ALPHA});
        ASSERT_TRUE(comparison.tests.has_value());
        EXPECT_TRUE(comparison.passed) << comparison.tests->mean.z << ' ' << comparison.tests->block.z;
    }
};

TEST_P(InstanceTest, CutScenesHaveTheSamePicture) {
    const std::filesystem::path name = std::string(GetParam()) + ".json";
    const std::filesystem::path file = std::filesystem::path(CANDELA_SCENES) / name;
    const Scene scene = load_scene(exists(file) ? file : std::filesystem::path(CANDELA_REFERENCES) / name);
    Scene cut = scene;
    cut_into_instances(cut);
    expect_same_picture(scene, cut, 256, 0.01);
}

// Glass and absorption, an image of normals, smooth normals, alpha and layers.
INSTANTIATE_TEST_SUITE_P(Gallery, InstanceTest,
                         testing::Values("absorbing-glass", "normal-map", "smooth-normals", "lemons"),
                         [](const auto& scene) {
                             std::string name = scene.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

using SlowInstanceTest = InstanceTest;

TEST_P(SlowInstanceTest, CutScenesHaveTheSamePicture) {
    const Scene scene =
        load_scene(std::filesystem::path(CANDELA_SCENES) / (std::string(GetParam()) + ".json"));
    Scene cut = scene;
    cut_into_instances(cut);
    expect_same_picture(scene, cut, 1024, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Gallery, SlowInstanceTest,
                         testing::Values("cornell-box", "cornell-glass", "cornell-glossy", "environment",
                                         "materials", "mesh", "showcase"),
                         [](const auto& scene) {
                             std::string name = scene.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace candela
