// Display: develops the accumulation image on the device into pixels for a window.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/math.h"
#include "image/image.h"
#include "image/tonemap.h"
#include "vk/buffer.h"
#include "vk/commands.h"
#include "vk/device.h"
#include "vk/image.h"
#include "vk/kernel.h"

namespace candela {

// A picture over a part of the window: sRGB codes premultiplied by alpha, one word per pixel with red in the
// lowest byte and alpha in the highest, row-major.
struct Overlay {
    PixelRect rect;  // In the window; may be empty.
    std::vector<uint32_t> pixels;
};

// The kernel that develops, compiled for a tone curve, with nothing bound. `blue_first`: the order of the
// bytes on the screen, see vk::Presenter.
vk::Kernel make_display_kernel(const vk::Device& device, Tonemap curve, bool blue_first);

class Display {
  public:
    // `blue_first` as for the kernel. `device` must outlive the display.
    Display(const vk::Device& device, bool blue_first);

    // Develops the mean of the samples in `image` (layers LAYER_*, of any size: it is stretched over the
    // window), multiplied by 2^exposure_ev, into size.x * size.y pixels, as develop() does up to rounding,
    // and blends `overlay` over them. A pixel without samples keeps its previous colour, or is black if the
    // window's size has changed.
    void draw(const vk::StorageImage& image, uvec2 size, Tonemap curve, float exposure_ev,
              const Overlay& overlay);

    // The pixels drawn last: words of four bytes, row-major.
    const vk::Buffer& screen() const { return *screen_; }

  private:
    void resize(uvec2 size);

    const vk::Device* device_;
    bool blue_first_;
    uvec2 size_{0, 0};
    Tonemap curve_ = Tonemap::linear;
    std::unique_ptr<vk::Buffer> overlay_;  // As large as the window.
    std::unique_ptr<vk::Buffer> picture_;
    std::unique_ptr<vk::Buffer> screen_;
    std::unique_ptr<vk::Kernel> kernel_;
    vk::Commands commands_;
};

}  // namespace candela
