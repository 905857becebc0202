// See variance.h.
#include "denoise/variance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "denoise/irradiance.h"
#include "render/kernels.h"
#include "shared/constants.h"
#include "shared/denoise.h"
#include "vk/commands.h"
#include "vk/image.h"
#include "vk/kernel.h"
#include "vk/transfer.h"

namespace candela {
namespace {

// A pass over the working image; its source, guide and target are layers of irradiance.
struct FilterPass {
    uint source, guide, target, step;
    float tolerance, outlier;
};

// The guide of the first step is itself filtered, with so much tolerance that little but edges decides:
// differences of single pixels would follow their noise. After that, each result is the guide of the next.
constexpr std::array FILTER_PASSES{
    FilterPass{DENOISE_LAYER_NOISY, DENOISE_LAYER_NOISY, DENOISE_LAYER_FIRST, 1, 16.0f, 1000.0f},
    FilterPass{DENOISE_LAYER_NOISY, DENOISE_LAYER_FIRST, DENOISE_LAYER_SECOND, 1, 4.0f, 1.0f},
    FilterPass{DENOISE_LAYER_SECOND, DENOISE_LAYER_SECOND, DENOISE_LAYER_FIRST, 2, 4.0f, 1.0f},
    FilterPass{DENOISE_LAYER_FIRST, DENOISE_LAYER_FIRST, DENOISE_LAYER_SECOND, 4, 4.0f, 1.0f},
    FilterPass{DENOISE_LAYER_SECOND, DENOISE_LAYER_SECOND, DENOISE_LAYER_FIRST, 8, 4.0f, 1.0f}};

// Pixels around a tile on which it depends: those of all passes, and of the smoothed variance.
constexpr uint32_t halo() {
    uint32_t pixels = DENOISE_RADIUS;
    for (const FilterPass& pass : FILTER_PASSES)
        pixels += uint32_t(DENOISE_RADIUS) * pass.step;
    return pixels;
}

PixelRect grown(const PixelRect& rect, uint32_t margin, uvec2 size) {
    return {rect.x0 - std::min(rect.x0, margin), rect.y0 - std::min(rect.y0, margin),
            std::min(rect.x1 + margin, size.x), std::min(rect.y1 + margin, size.y)};
}

vk::Kernel make_kernel(const vk::Device& device, uint32_t pass, const vk::StorageImage& image) {
    static constexpr std::array BINDINGS{vk::Binding{DENOISE_BINDING_IMAGE, vk::BindingType::storage_image}};
    const std::array constants{pass};
    static_assert(DENOISE_CONSTANT_PASS == 0 && DENOISE_CONSTANT_COUNT == 1);
    vk::Kernel kernel(device, kernels::denoise, BINDINGS, sizeof(DenoisePush), constants, "denoise");
    kernel.bind(DENOISE_BINDING_IMAGE, image);
    return kernel;
}

// Filters tiles on the device.
class Tiles {
  public:
    Tiles(const vk::Device& device, const NoisyPicture& picture, uvec2 size, uint32_t tile)
        : irradiance_(picture),
          size_(size),
          image_(vk::make_storage_image(device, std::min(tile + 2 * halo(), size.x),
                                        std::min(tile + 2 * halo(), size.y), DENOISE_LAYER_COUNT,
                                        "denoising")),
          smooth_(make_kernel(device, DENOISE_PASS_VARIANCE, image_)),
          filter_(make_kernel(device, DENOISE_PASS_FILTER, image_)),
          commands_(device) {}

    void denoise(const PixelRect& tile, Denoised& result) {
        const PixelRect loaded = grown(tile, halo(), size_);
        upload(loaded);
        uint32_t margin = halo() - DENOISE_RADIUS;
        run(smooth_, {}, loaded, grown(tile, margin, size_));
        for (const FilterPass& pass : FILTER_PASSES) {
            margin -= uint32_t(DENOISE_RADIUS) * pass.step;
            run(filter_, pass, loaded, grown(tile, margin, size_));
        }
        download(loaded, tile, result);
    }

  private:
    void upload(const PixelRect& loaded) {
        irradiance_.load(loaded);
        values_.resize(image_.layer_floats());
        for (uint32_t layer = 0; layer < DENOISE_LAYERS_GIVEN; ++layer) {
            parallel_for(loaded.height(), [&](size_t y) {
                float* texel = &values_[y * image_.width() * vk::StorageImage::CHANNELS];
                const size_t first = (loaded.y0 + y) * size_.x;
                for (size_t i = first + loaded.x0; i < first + loaded.x1;
                     ++i, texel += vk::StorageImage::CHANNELS) {
                    const vec4 value = irradiance_.texel(layer, i);
                    for (int c = 0; c < 4; ++c)
                        texel[c] = value[c];
                }
            });
            vk::upload(image_, layer, values_);
        }
    }

    void run(const vk::Kernel& kernel, const FilterPass& pass, const PixelRect& loaded,
             const PixelRect& target) {
        const DenoisePush push{.size = {loaded.width(), loaded.height()},
                               .origin = {target.x0 - loaded.x0, target.y0 - loaded.y0},
                               .count = {target.width(), target.height()},
                               .source = pass.source,
                               .guide = pass.guide,
                               .target = pass.target,
                               .step = pass.step,
                               .tolerance = pass.tolerance,
                               .outlier = pass.outlier};
        const auto groups = [](uint32_t pixels) { return (pixels + WORKGROUP_SIZE - 1) / WORKGROUP_SIZE; };
        commands_.dispatch(kernel, std::as_bytes(std::span(&push, 1)),
                           {groups(push.count.x), groups(push.count.y), 1});
        commands_.submit_and_wait();
    }

    void download(const PixelRect& loaded, const PixelRect& tile, Denoised& result) {
        const std::vector<float> values = vk::download(image_, FILTER_PASSES.back().target, 2);
        parallel_for(tile.height(), [&](size_t row) {
            const uint32_t y = tile.y0 + uint32_t(row);
            for (uint32_t x = tile.x0; x < tile.x1; ++x) {
                const size_t at = (size_t(y - loaded.y0) * image_.width() + (x - loaded.x0)) * 4;
                const float* value = &values[at];
                const float* variance = &values[image_.layer_floats() + at];
                const size_t i = size_t(y) * size_.x + x;
                irradiance_.put(i, {value[0], value[1], value[2], value[3]}, variance[0] != DENOISE_MISSING,
                                result);
                result.own_weight[i] = variance[3];
            }
        });
    }

    Irradiance irradiance_;
    uvec2 size_;
    vk::StorageImage image_;
    vk::Kernel smooth_, filter_;
    vk::Commands commands_;
    std::vector<float> values_;
};

}  // namespace

Denoised filter_by_variance(const vk::Device& device, const NoisyPicture& picture, uint32_t tile) {
    assert(tile > 0 && picture.rgb[0].size() == size_t(picture.size.x) * picture.size.y);
    const uvec2 size = picture.size;
    const size_t pixels = size_t(size.x) * size.y;
    Denoised result;
    for (std::vector<float>& plane : result.rgb)
        plane.resize(pixels);
    if (!picture.alpha.empty()) result.alpha.resize(pixels);
    result.own_weight.resize(pixels);
    Tiles tiles(device, picture, size, tile);
    for (uint32_t y = 0; y < size.y; y += tile) {
        for (uint32_t x = 0; x < size.x; x += tile)
            tiles.denoise({x, y, std::min(x + tile, size.x), std::min(y + tile, size.y)}, result);
    }
    return result;
}

}  // namespace candela
