// StorageImage: an array of 2D layers of RGBA 32-bit floats that kernels read and write.
#pragma once

#include <cstdint>
#include <string>

#include <volk.h>

#include "vk/device.h"
#include "vk/handle.h"
#include "vk/memory.h"

namespace candela::vk {

// In GLSL: layout(rgba32f) image2DArray. make_storage_image() of vk/transfer.h makes one.
class StorageImage {
  public:
    static constexpr VkFormat FORMAT = VK_FORMAT_R32G32B32A32_SFLOAT;
    static constexpr uint32_t CHANNELS = 4;

    const Device& device() const { return *device_; }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint32_t layers() const { return layers_; }
    // Bytes of the image on the device.
    uint64_t size() const { return size_; }

    VkImage handle() const { return image_.get(); }
    // The view of all layers, in layout GENERAL, that a kernel binds.
    VkImageView view() const { return view_.get(); }
    // All layers.
    VkImageSubresourceRange subresources() const { return {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers_}; }
    uint64_t layer_floats() const { return uint64_t{width_} * height_ * CHANNELS; }

  private:
    // The image has no layout yet.
    StorageImage(const Device& device, uint32_t width, uint32_t height, uint32_t layers,
                 const std::string& name);
    friend StorageImage make_storage_image(const Device& device, uint32_t width, uint32_t height,
                                           uint32_t layers, const std::string& name);

    const Device* device_;
    uint32_t width_;
    uint32_t height_;
    uint32_t layers_;
    uint64_t size_ = 0;
    Memory memory_;
    Unique<VkImage, VkDevice> image_;
    Unique<VkImageView, VkDevice> view_;
};

}  // namespace candela::vk
