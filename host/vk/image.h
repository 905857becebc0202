// StorageImage: an array of 2D layers of RGBA 32-bit floats that kernels read and write.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <volk.h>

#include "vk/device.h"
#include "vk/handle.h"
#include "vk/memory.h"

namespace candela::vk {

// In GLSL: layout(rgba32f) image2DArray. Host arrays hold whole layers in the order layer, row (top first),
// column, channel; so layer * height * width * 4 floats.
class StorageImage {
  public:
    static constexpr VkFormat FORMAT = VK_FORMAT_R32G32B32A32_SFLOAT;
    static constexpr uint32_t CHANNELS = 4;

    // Makes an image of width * height pixels and `layers` layers, each at least 1, filled with zeros. `name`
    // is for messages. Throws an Error that names the image, what it needs and what the device allows if it
    // cannot be had.
    StorageImage(const Device& device, uint32_t width, uint32_t height, uint32_t layers,
                 const std::string& name);

    // Sets all layers to zero.
    void clear();
    // Replaces layers from `first_layer` on by `values`, which must be a whole number of layers that exist.
    void upload(uint32_t first_layer, std::span<const float> values);
    // Returns `layer_count` layers from `first_layer` on; they must exist.
    std::vector<float> download(uint32_t first_layer, uint32_t layer_count) const;

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint32_t layers() const { return layers_; }
    // Bytes that the image takes on the device.
    uint64_t size() const { return size_; }

    VkImage handle() const { return image_.get(); }
    // The view of all layers, in layout GENERAL, that a kernel binds.
    VkImageView view() const { return view_.get(); }

  private:
    uint64_t layer_floats() const { return uint64_t{width_} * height_ * CHANNELS; }

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
