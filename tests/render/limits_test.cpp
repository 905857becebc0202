// What happens at the edges: devices too small for a scene, and samples too bright for a float.
#include <gtest/gtest.h>

#include "base/error.h"
#include "render/render_fixture.h"

namespace candela {
namespace {

class LimitsTest : public vk::Vk {
  protected:
    // Builds a renderer of the Cornell box on a device that claims the limits of info_.
    std::string message(ErrorKind kind) const {
        const vk::Device device(instance_, info_);
        const Scene scene = cornell_box();
        return vk::error_of(kind, [&] {
            const Renderer renderer(device, build_gpu_scene(scene), scene.cameras.at(0), settings_for(8, 8));
        });
    }
};

// Texels of the longest array of the Cornell box, that of its primitives.
uint32_t longest_array() {
    const GpuScene gpu = build_gpu_scene(cornell_box());
    for (const auto& array : gpu.arrays)
        EXPECT_LE(array.size(), gpu.arrays[ARRAY_PRIMITIVES].size());
    return uint32_t(gpu.arrays[ARRAY_PRIMITIVES].size());
}

TEST_F(LimitsTest, ASceneForTexelBuffersAloneIsStillRead) {
    info_.limits.max_storage_buffer_range = 16 * longest_array() - 1;
    EXPECT_EQ(message(ErrorKind::other), "no error");
}

TEST_F(LimitsTest, ASceneForStorageBuffersAloneIsStillRead) {
    info_.limits.max_texel_buffer_elements = longest_array() - 1;
    EXPECT_EQ(message(ErrorKind::other), "no error");
}

TEST_F(LimitsTest, ASceneForNeitherSaysWhatItNeeds) {
    const uint32_t texels = longest_array();
    info_.limits.max_texel_buffer_elements = texels - 1;
    info_.limits.max_storage_buffer_range = 16 * texels - 1;
    EXPECT_EQ(message(ErrorKind::out_of_memory),
              "the scene's array primitives needs " + std::to_string(texels) + " texels (" +
                  std::to_string(16 * texels) + " bytes), but " + info_.name +
                  " allows maxTexelBufferElements = " + std::to_string(texels - 1) +
                  " and maxStorageBufferRange = " + std::to_string(16 * texels - 1) +
                  " bytes; use a smaller scene, or another device (candela devices lists them)");
}

// The part that the message names fits, and with another row of tiles it does not.
TEST_F(LimitsTest, APictureThatIsTooLargeForOneImageSaysWhichPartFits) {
    const uint64_t allowed = uint64_t{256} * 128 * LAYER_COUNT_COLOUR * sizeof(vec4);
    info_.limits.max_image_bytes = info_.limits.max_memory_allocation_size = allowed;
    info_.limits.max_image_dimension_2d = 500;
    const vk::Device device(instance_, info_);
    const Scene scene = cornell_box();
    const GpuScene gpu_scene = build_gpu_scene(scene);
    const auto message_of = [&](const PixelRect& crop) {
        RenderSettings settings = settings_for(600, 600);
        settings.crop = crop;
        settings.aovs = false;
        return vk::error_of(ErrorKind::out_of_memory, [&] {
            const Renderer renderer(device, gpu_scene, scene.cameras.at(0), settings);
        });
    };
    const std::string allows = ", but \"" + info_.name + "\" allows ";
    const std::string remedy =
        "; use less or choose another device; or render the picture in parts of at most ";
    EXPECT_EQ(message_of({10, 20, 210, 420}),
              "image \"accumulation\" (200x400, 4 layers) needs 5120000 bytes" + allows +
                  std::to_string(allowed) + " (maxResourceSize)" + remedy +
                  "200x128 (the first one by --crop 10,20,210,148)");
    EXPECT_EQ(message_of({10, 20, 210, 148}), "no error");
    EXPECT_NE(message_of({10, 20, 210, 212}), "no error");
    EXPECT_EQ(message_of({0, 0, 600, 10}),
              "image \"accumulation\" (600x10, 4 layers) needs 600 pixels across" + allows +
                  "500 (maxImageDimension2D)" + remedy + "448x10 (the first one by --crop 0,0,448,10)");
    EXPECT_EQ(message_of({0, 0, 448, 10}), "no error");
}

// Lavapipe of Mesa 22 ends an invocation's loops after 65 535 iterations in sum; then the error says what
// there may be too much of. Other drivers go on until all shapes are tested.
TEST_F(LimitsTest, MoreShapesInOnePlaceThanADriverLoopsOverAreNamed) {
    Scene scene = floor_seen_closely(vec3(0.5f));
    scene.shapes.assign(200'000, scene.shapes.front());
    const vk::Device device(instance_, info_);
    uint32_t samples = 0;
    const std::string error = vk::error_of(ErrorKind::other, [&] {
        Renderer renderer(device, build_gpu_scene(scene), scene.cameras.at(0), settings_for(8, 8));
        renderer.render(1, [](double) { return true; });
        samples = renderer.download().min_samples();
    });
    if (samples == 1) return;
    EXPECT_EQ(
        error,
        "the driver of " + info_.name +
            " ends loops before a single path is finished: paths are too long, or rays meet too many "
            "shapes in the same place; allow fewer bounces (--max-depth), remove shapes that lie on each "
            "other, or use another device (candela devices lists them)");
}

using FiniteTest = RenderTest;

// The square of 1e30 is not a float, that of 1e15 is. Four work groups count, as those of lavapipe and as
// those of other devices.
TEST_F(FiniteTest, SamplesThatAreNotFiniteAddNothingAndAreCounted) {
    vk::DeviceInfo info = info_;
    info.driver_id = info_.is_lavapipe() ? VkDriverId{} : VK_DRIVER_ID_MESA_LLVMPIPE;
    const vk::Device other(instance_, info);
    for (const float radiance : {1e15f, 1e30f}) {
        Scene scene = cornell_box();
        scene.cameras[0].position = dvec3(0.278, 0.4, 0.28);  // Under the light, which fills the view.
        scene.cameras[0].look_at = dvec3(0.278, 0.5485, 0.28);
        scene.cameras[0].up = vec3(0, 0, 1);
        scene.cameras[0].vertical_fov = 0.1f;
        for (Shape& shape : scene.shapes) {
            if (shape.emission) shape.emission->radiance = vec3(radiance);
        }
        RenderSettings settings = settings_for(16, 16);
        settings.max_depth = 0;
        for (const vk::Device* const on : {&device(), &other}) {
            Renderer renderer(*on, build_gpu_scene(scene), scene.cameras[0], settings);
            renderer.render(3, [](double) { return true; });
            const bool finite = radiance < 1e19f;
            EXPECT_EQ(renderer.counters().nonfinite_samples, finite ? 0u : 3u * 256u);
            const Image image = image_of(renderer.download());
            for (const float value : plane(image, "", 1))
                ASSERT_EQ(value, finite ? radiance : 0.0f);
        }
    }
}

}  // namespace
}  // namespace candela
