// Storage images: their limits, and copies to and from the host in blocks of rows.
#include "vk/image.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "vk/buffer.h"
#include "vk/check.h"
#include "vk/commands.h"

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

static VkImageSubresourceRange all_layers(uint32_t layers) {
    return {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers};
}

// From layout UNDEFINED, which holds nothing, to GENERAL, for good.
static void set_layout(const Device& device, VkImage image, const VkImageSubresourceRange& range) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = range;
    Commands commands(device);
    vkCmdPipelineBarrier(commands.handle(), VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    commands.submit_and_wait();
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
    view_ = {create_view(device, image_.get(), all_layers(layers)), vkDestroyImageView, device.handle()};

    set_layout(device, image_.get(), all_layers(layers));
    clear();
}

void StorageImage::clear() {
    Commands commands(*device_);
    const VkClearColorValue zero{};
    const VkImageSubresourceRange range = all_layers(layers_);
    vkCmdClearColorImage(commands.handle(), image_.get(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &range);
    commands.submit_and_wait();
}

// Some rows of one layer, small enough for a staging buffer, and where they are in the host's array of
// floats.
struct Block {
    VkBufferImageCopy region{};
    uint64_t offset = 0;
    uint64_t count = 0;
};

// The blocks of `layer_count` layers from `first_layer` on, in the order of the host's array; the first is
// the largest.
static std::vector<Block> blocks(const StorageImage& image, uint32_t first_layer, uint32_t layer_count) {
    const uint64_t row_floats = uint64_t{image.width()} * StorageImage::CHANNELS;
    const uint64_t rows_that_fit = STAGING_BYTES / (row_floats * sizeof(float));
    const uint32_t step = uint32_t(std::clamp<uint64_t>(rows_that_fit, 1, image.height()));
    std::vector<Block> result;
    uint64_t offset = 0;
    for (uint32_t layer = first_layer; layer < first_layer + layer_count; ++layer) {
        for (uint32_t row = 0; row < image.height(); row += step) {
            Block block;
            const uint32_t rows = std::min(step, image.height() - row);
            block.region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
            block.region.imageOffset = {0, int32_t(row), 0};
            block.region.imageExtent = {image.width(), rows, 1};
            block.offset = offset;
            block.count = rows * row_floats;
            offset += block.count;
            result.push_back(block);
        }
    }
    return result;
}

void StorageImage::upload(uint32_t first_layer, std::span<const float> values) {
    assert(values.size() % layer_floats() == 0);
    const auto layer_count = uint32_t(values.size() / layer_floats());
    assert(first_layer <= layers_ && layer_count <= layers_ - first_layer);
    if (layer_count == 0) return;
    const std::vector<Block> parts = blocks(*this, first_layer, layer_count);
    const Buffer staging(*device_, parts.front().count * sizeof(float), BufferUsage::readback,
                         "upload staging");
    Commands commands(*device_);
    for (const Block& part : parts) {
        std::memcpy(staging.mapped(), values.data() + part.offset, part.count * sizeof(float));
        vkCmdCopyBufferToImage(commands.handle(), staging.handle(), image_.get(), VK_IMAGE_LAYOUT_GENERAL, 1,
                               &part.region);
        commands.submit_and_wait();
    }
}

std::vector<float> StorageImage::download(uint32_t first_layer, uint32_t layer_count) const {
    assert(first_layer <= layers_ && layer_count <= layers_ - first_layer);
    if (layer_count == 0) return {};
    std::vector<float> values(layer_floats() * layer_count);
    const std::vector<Block> parts = blocks(*this, first_layer, layer_count);
    const Buffer staging(*device_, parts.front().count * sizeof(float), BufferUsage::readback,
                         "download staging");
    Commands commands(*device_);
    for (const Block& part : parts) {
        vkCmdCopyImageToBuffer(commands.handle(), image_.get(), VK_IMAGE_LAYOUT_GENERAL, staging.handle(), 1,
                               &part.region);
        commands.submit_and_wait();
        std::memcpy(values.data() + part.offset, staging.mapped(), part.count * sizeof(float));
    }
    return values;
}

}  // namespace candela::vk
