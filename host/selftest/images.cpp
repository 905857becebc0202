// Statistics of whole images. All use the independent sampler, since they assume that samples are
// independent.
#include "selftest/images.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/statistics.h"
#include "base/text.h"
#include "gpu_scene/gpu_scene.h"
#include "image/compare.h"
#include "image/image_io.h"
#include "probe/embedded.h"
#include "probe/scenes.h"
#include "render/renderer.h"

namespace candela {
namespace {

constexpr uint32_t SIZE = 64;  // Pixels along either side of all pictures.

// Renders with the variance of each pixel. All samples must be finite, and no path may be cut off.
Image render(const vk::Device& device, const Scene& scene, Estimator estimator, uint32_t seed, uint32_t spp,
             Evidence& evidence) {
    RenderSettings settings;
    settings.size = uvec2(SIZE);
    settings.crop = {0, 0, SIZE, SIZE};
    settings.estimator = estimator;
    settings.sampler = SamplerKind::independent;
    settings.seed = seed;
    settings.max_depth = scene.integrator.max_depth.value_or(DEPTH_SAFETY_LIMIT);
    Renderer renderer(device, build_gpu_scene(scene), scene.cameras[0], settings);
    renderer.render(spp, [](double) { return true; });
    const RenderCounters& counters = renderer.counters();
    evidence.expect(counters.nonfinite_samples == 0 && counters.depth_limit_hits == 0, [&] {
        return concat(counters.nonfinite_samples, " samples are not finite, ", counters.depth_limit_hits,
                      " paths were cut off");
    });
    return make_image(renderer.download(), {.variance = true}, {});
}

// Student's test of the mean of independent pixels. Each vertex of a path rounds its radiance and throughput
// some ten times, at worst always the same way: 2^-20 of the sum.
double p_value_of_mean(std::span<const float> pixels, double expected) {
    RunningMoments moments;
    for (const float value : pixels)
        moments.add(value);
    const double beyond = std::abs(moments.mean() - expected) - 0x1p-20 * expected;
    if (beyond <= 0.0) return 1.0;
    const double t = beyond / std::sqrt(moments.variance_of_mean());
    return student_t_p_value(t, double(moments.count() - 1));
}

// Tests whether two images have the same expectation: the means of blocks and of the image must agree within
// their noise. A single pixel has too few samples for its mean to be normal.
void test_same_expectation(const std::string& name, const Image& a, const Image& b, Evidence& evidence) {
    const Comparison comparison = compare(a, b);
    const ZTests& z = comparison.tests.value();
    const PixelRect& place = z.block.place;
    const uint64_t along = SIZE / COMPARE_BLOCK;
    evidence.add_p_value(concat(name, ": block at ", place.x0, ',', place.y0, ", z ", z.block.z),
                         normal_p_value(z.block.z), 3 * along * along);
    evidence.add_p_value(concat(name, ": mean of the image, z ", z.mean.z), normal_p_value(z.mean.z), 3);
}

// Lights and lobes are large enough that each estimator alone has a small variance.
Scene room_of_lights() {
    Scene scene = open_room();
    scene.integrator.max_depth = 8;
    scene.environment = one_bright_texel({8, 4}, {4, 1}, vec3(5, 4, 3));
    for (vec3& texel : scene.environment->radiance)
        texel += vec3(0.2f, 0.3f, 0.4f);
    const uint32_t grey = 0;
    const vec3 warm(4, 3, 2), cool(1, 2, 3);
    add_shape(scene, parallelogram(vec3(-1, 1.99f, -1), vec3(0.8f, 0, 0), vec3(0, 0, 0.8f)), grey,
              Emission{warm, false});
    add_shape(scene, Sphere{dvec3(-1.2, 1.2, -1), 0.4}, grey, Emission{warm, false});
    add_shape(scene, Disk{dvec3(0.9, 1.4, -0.9), dvec3(0.6, 0, 0), dvec3(0, 0, 0.4)}, grey,
              Emission{cool, true});
    const auto ball = [&](float x, const decltype(Material::model)& model) {
        add_shape(scene, Sphere{dvec3(x, 0.4, 0.2), 0.35}, add_material(scene, model));
    };
    ball(-1.2f, PhongMaterial{vec3(0.3f, 0.2f, 0.1f), vec3(0.6f, 0.5f, 0.4f), 10.0f});
    ball(-0.4f, ConductorMaterial{vec3(0.9f, 0.7f, 0.4f), 0.3f});
    ball(0.4f, MirrorMaterial{vec3(0.9f, 0.8f, 0.7f)});
    ball(1.2f, DielectricMaterial{.fresnel = Fresnel::exact, .inside = {vec3(2, 1, 0.5f)}});
    return scene;
}

}  // namespace

Evidence test_furnace(const vk::Device& device, Effort effort) {
    Evidence evidence;
    uint32_t seed = 0;
    for (const float albedo : {0.0f, 0.5f, 0.8f, 0.95f}) {
        const Scene scene = furnace(albedo);
        for (const Estimator estimator : {Estimator::bsdf, Estimator::mis}) {
            const Image image = render(device, scene, estimator, seed++, sized(effort, 64), evidence);
            const RgbPlanes planes = image.find_rgb().value();
            for (const std::span<const float> pixels : planes) {
                evidence.add_p_value(
                    concat("albedo ", albedo, estimator == Estimator::bsdf ? ", bsdf" : ", mis"),
                    p_value_of_mean(pixels, 1.0 / (1.0 - double(albedo))));
            }
        }
    }
    return evidence;
}

Evidence test_estimators(const vk::Device& device, Effort effort) {
    const uint32_t spp = sized(effort, 256);
    const Scene scene = room_of_lights();
    Evidence evidence;
    const Image mis = render(device, scene, Estimator::mis, 1, spp, evidence);
    test_same_expectation("light", render(device, scene, Estimator::light, 2, spp, evidence), mis, evidence);
    test_same_expectation("bsdf", render(device, scene, Estimator::bsdf, 3, spp, evidence), mis, evidence);
    return evidence;
}

Evidence test_cornell_box(const vk::Device& device, Effort effort) {
    const uint32_t spp = sized(effort, 512);
    Evidence evidence;
    const Image reference = decode_exr(embedded::cornell_box_exr, "cornell-box.exr");
    test_same_expectation("Cornell box", render(device, cornell_box(), Estimator::mis, 1, spp, evidence),
                          reference, evidence);
    return evidence;
}

}  // namespace candela
