// Storage images and their limits.
#include "vk/image.h"

#include <cassert>

#include "vk/check.h"

namespace candela::vk {

static void check_limits(const Device& device, uint32_t width, uint32_t height, uint32_t layers,
                         const std::string& name) {
    const DeviceLimits& limits = device.limits();
    device.check_limit(name, "pixels across", width, limits.max_image_dimension_2d, "maxImageDimension2D");
    device.check_limit(name, "pixels down", height, limits.max_image_dimension_2d, "maxImageDimension2D");
    device.check_limit(name, "layers", layers, limits.max_image_array_layers, "maxImageArrayLayers");
    const uint64_t bytes = uint64_t{width} * height * layers * StorageImage::CHANNELS * sizeof(float);
    device.check_limit(name, "bytes", bytes, limits.max_image_bytes, "maxResourceSize");
}

static VkImage create_image(const Device& device, uint32_t width, uint32_t height, uint32_t layers) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = StorageImage::FORMAT;
    info.extent = {width, height, 1};
    info.mipLevels = 1;
    info.arrayLayers = layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage =
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImage image = VK_NULL_HANDLE;
    VK_CHECK(vkCreateImage(device.handle(), &info, nullptr, &image));
    return image;
}

static VkImageView create_view(const Device& device, VkImage image, const VkImageSubresourceRange& range) {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    info.format = StorageImage::FORMAT;
    info.subresourceRange = range;
    VkImageView view = VK_NULL_HANDLE;
    VK_CHECK(vkCreateImageView(device.handle(), &info, nullptr, &view));
    return view;
}

StorageImage::StorageImage(const Device& device, uint32_t width, uint32_t height, uint32_t layers,
                           const std::string& name)
    : device_(&device), width_(width), height_(height), layers_(layers) {
    assert(width > 0 && height > 0 && layers > 0);
    const std::string what = "image \"" + name + "\" (" + std::to_string(width) + "x" +
                             std::to_string(height) + ", " + std::to_string(layers) + " layers)";
    check_limits(device, width, height, layers, what);
    image_ = {create_image(device, width, height, layers), vkDestroyImage, device.handle()};
    device.set_name(VK_OBJECT_TYPE_IMAGE, image_.get(), name);

    VkMemoryRequirements requirements{};
    vkGetImageMemoryRequirements(device.handle(), image_.get(), &requirements);
    size_ = requirements.size;
    memory_ = Memory(device, requirements, MemoryUse::device, what);
    VK_CHECK(vkBindImageMemory(device.handle(), image_.get(), memory_.handle(), 0));
    view_ = {create_view(device, image_.get(), subresources()), vkDestroyImageView, device.handle()};
}

}  // namespace candela::vk
