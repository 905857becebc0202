// A scene of instances has the picture of the scene in which every copy is baked.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <glm/gtc/matrix_transform.hpp>

#include "load/load.h"
#include "probe/random.h"
#include "render_fixture.h"
#include "scene/mesh.h"
#include "scene/tangents.h"

namespace candela {
namespace {

constexpr InstancingRule ALL{.min_uses = 1, .min_triangles = 1};
constexpr InstancingRule NONE{.min_uses = ~0u, .min_triangles = ~0u};

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

// Moves every mesh into a space of its own, from which its instance brings it back to where it was. The first
// is mirrored or not, and then every other one.
void cut_into_instances(Scene& scene, bool mirrored = false) {
    Random random(1);
    mirrored = !mirrored;
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
    // Two pictures with samples of their own must have one expectation. `max_error` is the largest standard
    // error of the mean over it.
    void expect_same_picture(const Scene& baked, const Scene& instanced, uint32_t spp,
                             double max_error) const {
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
            EXPECT_LE(mean.error, (test_effort() == Effort::quick ? 4.0 : 1.0) * max_error * mean.mean);
        }
        const Comparison comparison = compare(a, b, {.alpha = TEST_ALPHA});
        ASSERT_TRUE(comparison.tests.has_value());
        EXPECT_TRUE(comparison.passed) << comparison.tests->mean.z << ' ' << comparison.tests->block.z;
    }
};

TEST_P(InstanceTest, CutScenesHaveTheSamePicture) {
    const std::filesystem::path name = std::string(GetParam()) + ".json";
    const std::filesystem::path file = std::filesystem::path(CANDELA_SCENES) / name;
    const Scene scene = load_scene(exists(file) ? file : std::filesystem::path(CANDELA_REFERENCES) / name,
                                   {.reach = {.folders = {CANDELA_SCENES}}});
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

// A square with images of normals and of heights, in spaces that mirror, shear and scale it.
class InstancedNormalsTest : public RenderTest {
  protected:
    // The layers of each pixel's first hit, from the same camera rays.
    std::vector<vec3> normals(const Scene& scene, const InstancingRule& rule) const {
        RenderSettings settings = settings_for(32, 32);
        settings.max_depth = 0;
        settings.aovs = true;
        const GpuScene gpu = build_gpu_scene(scene, choose_frame(scene), rule);
        const Image image =
            make_image(render(gpu, scene.cameras.at(0), settings, samples(1)), {.normal = true}, {});
        std::vector<vec3> result;
        for (size_t i = 0; i < 32 * 32; ++i) {
            result.emplace_back(image.find("N.X")->values[i], image.find("N.Y")->values[i],
                                image.find("N.Z")->values[i]);
        }
        return result;
    }

    // Cut with the first of the transforms that mirror every other time, and with the second.
    void expect_same_normals(const Scene& scene) const {
        const std::vector<vec3> baked = normals(scene, NONE);
        for (const bool mirrored : {false, true}) {
            SCOPED_TRACE(mirrored);
            Scene cut = scene;
            cut_into_instances(cut, mirrored);
            const std::vector<vec3> instanced = normals(cut, ALL);
            size_t bent = 0;
            for (size_t i = 0; i < baked.size(); ++i) {
                ASSERT_LT(length(instanced[i] - baked[i]), 2e-3f) << i;
                bent += std::abs(baked[i].z) < 0.95f;
            }
            EXPECT_GT(bent, baked.size() / 4);
        }
    }

    // Seen from the front; the texture's image slopes.
    static Scene square(Texture& texture, const std::function<vec4(uint32_t, uint32_t)>& texel) {
        Scene scene = scene_with_camera(dvec3(0, 0, 4), dvec3(0), 0.4f);
        const uint32_t material = add_diffuse(scene, vec3(0.5f));
        texture = add_texture(scene, uvec2(8, 8), texel);
        TriangleMesh mesh;
        mesh.positions = {vec3(-1, -1, 0), vec3(1, -1, 0), vec3(1, 1, 0), vec3(-1, 1, 0)};
        mesh.uv0 = {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)};
        mesh.normals.assign(4, vec3(0, 0, 1));
        mesh.triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)};
        add_tangents(mesh);
        add_shape(scene, mesh, material);
        return scene;
    }
};

TEST_F(InstancedNormalsTest, ImagesOfNormals) {
    Texture texture;
    Scene scene = square(texture, [](uint32_t, uint32_t) { return vec4(0.75f, 0.875f, 0.8f, 1); });
    scene.materials[scene.shapes[0].material].normal_map = NormalMap{texture};
    expect_same_normals(scene);
}

TEST_F(InstancedNormalsTest, ImagesOfHeights) {
    Texture texture;
    Scene scene = square(
        texture, [](uint32_t x, uint32_t y) { return vec4(2 + float(x) / 8 - float(y) / 4, 0, 0, 1); });
    scene.materials[scene.shapes[0].material].bump_map = BumpMap{texture, 1.0f};
    expect_same_normals(scene);
}

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
