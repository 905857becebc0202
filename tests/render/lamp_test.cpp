// A scene of lamps has the picture of the scene in which each of their triangles is a light of its own.
#include <glm/gtc/matrix_transform.hpp>

#include "render_fixture.h"
#include "scene/names.h"

namespace candela {
namespace {

// Lamps of a folded sheet over a floor, turned, of several sizes, every other one mirrored: five glow in the
// colours of an image under a coat, four from both sides, and three only at the front, which is turned to the
// floor, in a beam.
Scene lamps() {
    Scene scene = scene_with_camera(dvec3(0, 3, 7), dvec3(0, 0.8, 0), 0.9f);
    const uint32_t grey = add_diffuse(scene, vec3(0.6f));
    const uint32_t coated = add_material(
        scene, PrincipledMaterial{.base_color = vec3(0.3f), .coat = 1.0f, .coat_roughness = 0.2f});
    const Texture image = add_texture(scene, {4, 2}, [](uint32_t x, uint32_t y) {
        return vec4(x < 2 ? 1.5f : 0.1f, y == 0 ? 1.5f : 0.1f, x % 2 == 0 ? 0.2f : 1.5f, 1.0f);
    });
    add_shape(scene, parallelogram(vec3(-5, 0, 5), vec3(10, 0, 0), vec3(0, 0, -10)), grey);
    TriangleMesh sheet;  // Its front is below.
    sheet.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 0.2f}, {-1, 0.3f, 0.2f}, {0, 0.8f, 1}};
    sheet.uv0 = {{0, 0}, {1, 0}, {1, 0.7f}, {0, 0.7f}, {0.5f, 1}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}};
    scene.meshes.push_back(sheet);
    for (int i = 0; i < 12; ++i) {
        Transform transform;
        const double size = 0.2 + 0.1 * (i % 4);
        transform.append(glm::scale(glm::dmat4(1.0), size * dvec3(i % 2 == 0 ? 1.0 : -1.0, 1.0, 1.0)));
        transform.append(
            glm::rotate(glm::dmat4(1.0), 0.5 * i - 2.0, normalize(dvec3(0.4, 1, 0.2 * (i % 3)))));
        transform.append(glm::translate(glm::dmat4(1.0),
                                        dvec3(-2.5 + i % 4 * 1.6, 0.7 + 0.3 * (i % 3), -2 + i / 4 * 1.5)));
        Emission emission{vec3(1, 2, 3), false};
        if (i < 9) emission = {vec3(2, 1, 1), true};
        if (i < 5) emission = {{vec3(4), image}, false};
        scene.shapes.push_back({.geometry = MeshInstance{0, transform},
                                .material = i < 5 ? coated : grey,
                                .emission = emission,
                                .beam = {.spread = i < 9 ? PI : 2.0f}});
    }
    return scene;
}

class LampTest : public RenderTest {
  protected:
    Image image(const GpuScene& gpu, const Scene& scene, Estimator estimator, LightSampler sampler,
                uint32_t seed, uint32_t spp) const {
        RenderSettings settings = independent_settings(48, estimator, seed);
        settings.light_sampler = sampler;
        settings.max_depth = 3;
        return image_of(render(gpu, scene.cameras.at(0), settings, samples(spp)));
    }
};

// Means and blocks of pixels agree within their noise, which is small.
void expect_same_picture(const Image& a, const Image& b) {
    for (size_t c = 0; c < 3; ++c) {
        const ImageMean mean = image_mean(a, c);
        EXPECT_LE(mean.error, 5.0 * largest_error() * mean.mean);
    }
    const Comparison comparison = compare(a, b, {.alpha = TEST_ALPHA});
    ASSERT_TRUE(comparison.tests.has_value());
    EXPECT_TRUE(comparison.tests->mean.passed()) << comparison.tests->mean.z;
    EXPECT_TRUE(comparison.tests->block.passed()) << comparison.tests->block.z;
}

TEST_F(LampTest, HaveThePictureOfBakedLights) {
    const Scene scene = lamps();
    const GpuScene baked =
        build_gpu_scene(scene, choose_frame(scene), {.min_uses = ~0u, .min_triangles = ~0u});
    const GpuScene with = build_gpu_scene(scene, choose_frame(scene), {.min_uses = 2, .min_triangles = 1});
    EXPECT_EQ(with.instances.size(), 12u);
    EXPECT_EQ(with.primitive_count,
              1u + 3u * 3u);  // The floor, and the sheet for each way in which it glows.
    const Image reference = image(baked, scene, Estimator::mis, LightSampler::tree, 1, 256);
    {
        SCOPED_TRACE("BSDF samples only");
        expect_same_picture(image(with, scene, Estimator::bsdf, LightSampler::tree, 2, 256), reference);
    }
    {
        SCOPED_TRACE("light samples only");
        expect_same_picture(image(with, scene, Estimator::light, LightSampler::tree, 3, 256), reference);
    }
    uint32_t seed = 4;
    for (const LightSampler sampler : {LightSampler::tree, LightSampler::power, LightSampler::uniform}) {
        SCOPED_TRACE(name_of(sampler, LIGHT_SAMPLER_NAMES));
        expect_same_picture(image(with, scene, Estimator::mis, sampler, seed++, 256), reference);
    }
}

// Close over a floor, which shows where a lamp is bright: along one of its two edges.
TEST_F(LampTest, LightSamplesFindTheImageOnAMirroredLamp) {
    Scene scene = scene_with_camera(dvec3(0, 3, 4), dvec3(0), 0.9f);
    add_shape(scene, parallelogram(vec3(-5, 0, 5), vec3(10, 0, 0), vec3(0, 0, -10)),
              add_diffuse(scene, vec3(0.6f)));
    const Texture image_on_it =
        add_texture(scene, {8, 1}, [](uint32_t x, uint32_t) { return vec4(vec3(x < 3 ? 4.0f : 0.1f), 1); });
    TriangleMesh sheet;  // Its front is below.
    sheet.positions = {{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}};
    sheet.uv0 = {{0, 0}, {1, 0}, {0, 1}};
    sheet.triangles = {{0, 1, 2}};
    scene.meshes.push_back(sheet);
    for (const double x : {-1.3, 1.3}) {
        Transform transform;
        transform.append(glm::scale(glm::dmat4(1.0), dvec3(-1.0, 1.0, 1.0)));
        transform.append(glm::translate(glm::dmat4(1.0), dvec3(x, 0.4, 0)));
        scene.shapes.push_back({.geometry = MeshInstance{0, transform},
                                .material = 0,
                                .emission = Emission{{vec3(1), image_on_it}, false}});
    }
    const GpuScene with = build_gpu_scene(scene, choose_frame(scene), {.min_uses = 2, .min_triangles = 1});
    const GpuScene baked =
        build_gpu_scene(scene, choose_frame(scene), {.min_uses = ~0u, .min_triangles = ~0u});
    ASSERT_EQ(with.instances.size(), 2u);
    expect_same_picture(image(with, scene, Estimator::light, LightSampler::tree, 1, 256),
                        image(baked, scene, Estimator::light, LightSampler::tree, 2, 256));
}

}  // namespace
}  // namespace candela
