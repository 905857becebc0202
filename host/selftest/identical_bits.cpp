// The guarantee of identical bits: N samples give the same sums however the work is cut into submissions,
// sessions and crops, and however the scene is read.
#include <cstring>
#include <functional>
#include <string>

#include "gpu_scene/gpu_scene.h"
#include "probe/scenes.h"
#include "render/renderer.h"
#include "selftest/images.h"

namespace candela {
namespace {

constexpr uint32_t SPP = 16;

bool keep_going(double) {
    return true;
}

// One scene, and renderings of its picture with any settings.
class Picture {
  public:
    explicit Picture(const vk::Device& device) : device_(&device), scene_(scene_of_everything()) {
        // Not a multiple of the work group in either direction.
        settings_.size = uvec2(37, 23);
        settings_.crop = {0, 0, 37, 23};
        settings_.seed = 77;
        settings_.aovs = true;
        settings_.submission_seconds = 10.0;
    }
    const RenderSettings& settings() const { return settings_; }
    Renderer renderer(const RenderSettings& settings) const {
        return Renderer(*device_, gpu_scene_, scene_.cameras[0], settings);
    }
    Accumulation render(const RenderSettings& settings) const {
        Renderer r = renderer(settings);
        r.render(SPP, keep_going);
        return r.download();
    }

  private:
    const vk::Device* device_;
    Scene scene_;
    GpuScene gpu_scene_ = build_gpu_scene(scene_);
    RenderSettings settings_;
};

// Whether `part` has the same bits as `whole` in its own pixels.
bool same_bits(const Accumulation& part, const Accumulation& whole) {
    const PixelRect& rect = part.rect;
    for (uint32_t layer = 0; layer < whole.layer_count; ++layer) {
        for (uint32_t y = rect.y0; y < rect.y1; ++y) {
            const float* const expected = whole.at(layer, size_t(y) * whole.rect.width() + rect.x0);
            const float* const row = part.at(layer, size_t(y - rect.y0) * rect.width());
            if (std::memcmp(row, expected, size_t{4} * rect.width() * sizeof(float)) != 0) return false;
        }
    }
    return part.layer_count == whole.layer_count;
}

Accumulation in_sixteen_calls(const Picture& picture) {
    Renderer r = picture.renderer(picture.settings());
    for (uint32_t target = 1; target <= SPP; ++target)
        r.render(target, keep_going);
    return r.download();
}

Accumulation in_small_tiles(const Picture& picture) {
    RenderSettings settings = picture.settings();
    settings.submission_seconds = 1e-6;  // A work group at a time, after the first submission.
    return picture.render(settings);
}

Accumulation through_a_second_renderer(const Picture& picture) {
    Renderer first = picture.renderer(picture.settings());
    first.render(SPP / 2, keep_going);
    Renderer second = picture.renderer(picture.settings());
    second.upload(first.download());
    second.render(SPP, keep_going);
    return second.download();
}

Accumulation with_access(const Picture& picture, SceneAccess access) {
    RenderSettings settings = picture.settings();
    settings.scene_access = access;
    return picture.render(settings);
}

Accumulation of_a_crop(const Picture& picture) {
    RenderSettings settings = picture.settings();
    settings.crop = {5, 3, 24, 20};
    return picture.render(settings);
}

}  // namespace

Evidence test_identical_bits(const vk::Device& device) {
    const Picture picture(device);
    const Accumulation whole = picture.render(picture.settings());
    Evidence evidence;
    const auto expect_same = [&](const char* how, const Accumulation& other) {
        evidence.expect(same_bits(other, whole),
                        [&] { return std::string("other bits than in one submission: ") + how; });
    };
    expect_same("the same once more", picture.render(picture.settings()));
    expect_same("sixteen submissions", in_sixteen_calls(picture));
    expect_same("small tiles", in_small_tiles(picture));
    expect_same("a state downloaded and uploaded", through_a_second_renderer(picture));
    expect_same("a crop", of_a_crop(picture));
    expect_same("texel buffers", with_access(picture, SceneAccess::texel_buffers));
    expect_same("storage buffers", with_access(picture, SceneAccess::storage_buffers));
    return evidence;
}

}  // namespace candela
