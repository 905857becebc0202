// Presenter: shows pictures in a window, by copying them from a buffer into the images of a swapchain. Needs
// only the queue that computes, and no graphics.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <volk.h>

#include "vk/buffer.h"
#include "vk/commands.h"
#include "vk/device.h"
#include "vk/handle.h"
#include "vk/instance.h"

namespace candela::vk {

using Surface = Unique<VkSurfaceKHR, VkInstance>;

// Chooses the first queue family of `info` that computes and can present to `surface`, and lets a Device
// opened from it do so; if there is none, `reason` says why the device is unsuitable.
void choose_presenting_queue(DeviceInfo& info, VkSurfaceKHR surface);

class Presenter {
  public:
    // `surface` is the window's, and `make_surface` makes another one if it is lost; `device` was opened
    // after choose_presenting_queue() and outlives the presenter. Throws Error (no_device) if the surface
    // cannot show 8-bit RGB pictures.
    Presenter(const Device& device, Surface surface, std::function<Surface()> make_surface);

    // Shows width * height pixels, row-major from the top, that `pixels` (usage storage or readback) holds as
    // 32-bit words: four bytes of alpha, which is ignored, and of sRGB codes in the order that blue_first()
    // says. Returns false if nothing was shown because the window is minimised, has another size by now, or
    // has lost its surface: the next call tries again with the window as it is then.
    bool show(const Buffer& pixels, uint32_t width, uint32_t height);

    // Whether the lowest byte of a pixel is blue and the third red; else the reverse.
    bool blue_first() const { return blue_first_; }

  private:
    bool make_swapchain(uint32_t width, uint32_t height);
    bool acquire(uint32_t& index);
    void copy(const Buffer& pixels, VkImage image);
    void drop_swapchain();
    // Whether the call of that name succeeded well enough to continue; if not, the next show() recreates what
    // was lost. Throws an Error if that is impossible.
    bool survives(VkResult result, const char* call);

    const Device* device_;
    std::function<Surface()> make_surface_;
    Surface surface_;
    VkSurfaceFormatKHR format_;
    bool blue_first_;
    Commands commands_;
    Unique<VkFence, VkDevice> acquired_;
    Unique<VkSwapchainKHR, VkDevice> swapchain_;
    std::vector<VkImage> images_;  // Owned by the swapchain.
    uint32_t width_ = 0;           // Width of the swapchain [pixels].
    uint32_t height_ = 0;
};

}  // namespace candela::vk
