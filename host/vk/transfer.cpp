// Transfers: through host memory that the device sees, in pieces.
#include "vk/transfer.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "vk/commands.h"

namespace candela::vk {

static void copy(Commands& commands, VkBuffer from, uint64_t from_offset, VkBuffer to, uint64_t to_offset,
                 uint64_t size) {
    const VkBufferCopy region{from_offset, to_offset, size};
    vkCmdCopyBuffer(commands.handle(), from, to, 1, &region);
    commands.submit_and_wait();
}

void upload(const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset) {
    assert(offset <= buffer.size() && bytes.size() <= buffer.size() - offset);
    if (bytes.empty()) return;
    if (buffer.mapped() != nullptr) {
        std::memcpy(buffer.mapped() + offset, bytes.data(), bytes.size());
        return;
    }
    const uint64_t chunk = std::min<uint64_t>(bytes.size(), STAGING_BYTES);
    const Buffer staging(buffer.device(), chunk, BufferUsage::readback, "upload staging");
    Commands commands(buffer.device());
    for (uint64_t done = 0; done < bytes.size(); done += chunk) {
        const uint64_t count = std::min(chunk, bytes.size() - done);
        std::memcpy(staging.mapped(), bytes.data() + done, count);
        copy(commands, staging.handle(), 0, buffer.handle(), offset + done, count);
    }
}

void download(const Buffer& buffer, std::span<std::byte> bytes, uint64_t offset) {
    assert(offset <= buffer.size() && bytes.size() <= buffer.size() - offset);
    if (bytes.empty()) return;
    if (buffer.mapped() != nullptr) {
        std::memcpy(bytes.data(), buffer.mapped() + offset, bytes.size());
        return;
    }
    const uint64_t chunk = std::min<uint64_t>(bytes.size(), STAGING_BYTES);
    const Buffer staging(buffer.device(), chunk, BufferUsage::readback, "download staging");
    Commands commands(buffer.device());
    for (uint64_t done = 0; done < bytes.size(); done += chunk) {
        const uint64_t count = std::min(chunk, bytes.size() - done);
        copy(commands, buffer.handle(), offset + done, staging.handle(), 0, count);
        std::memcpy(bytes.data() + done, staging.mapped(), count);
    }
}

// Changes the layout from UNDEFINED, which has no contents, to GENERAL, permanently.
static void set_layout(const StorageImage& image) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = image.subresources();
    Commands commands(image.device());
    vkCmdPipelineBarrier(commands.handle(), VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    commands.submit_and_wait();
}

StorageImage make_storage_image(const Device& device, uint32_t width, uint32_t height, uint32_t layers,
                                const std::string& name) {
    StorageImage image(device, width, height, layers, name);
    set_layout(image);
    clear(image);
    return image;
}

void clear(const StorageImage& image) {
    Commands commands(image.device());
    const VkClearColorValue zero{};
    const VkImageSubresourceRange range = image.subresources();
    vkCmdClearColorImage(commands.handle(), image.handle(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &range);
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

void upload(const StorageImage& image, uint32_t first_layer, std::span<const float> values) {
    assert(values.size() % image.layer_floats() == 0);
    const auto layer_count = uint32_t(values.size() / image.layer_floats());
    assert(first_layer <= image.layers() && layer_count <= image.layers() - first_layer);
    if (layer_count == 0) return;
    const std::vector<Block> parts = blocks(image, first_layer, layer_count);
    const Buffer staging(image.device(), parts.front().count * sizeof(float), BufferUsage::readback,
                         "upload staging");
    Commands commands(image.device());
    for (const Block& part : parts) {
        std::memcpy(staging.mapped(), values.data() + part.offset, part.count * sizeof(float));
        vkCmdCopyBufferToImage(commands.handle(), staging.handle(), image.handle(), VK_IMAGE_LAYOUT_GENERAL,
                               1, &part.region);
        commands.submit_and_wait();
    }
}

std::vector<float> download(const StorageImage& image, uint32_t first_layer, uint32_t layer_count) {
    assert(first_layer <= image.layers() && layer_count <= image.layers() - first_layer);
    if (layer_count == 0) return {};
    std::vector<float> values;
    values.reserve(image.layer_floats() * layer_count);
    const std::vector<Block> parts = blocks(image, first_layer, layer_count);
    const Buffer staging(image.device(), parts.front().count * sizeof(float), BufferUsage::readback,
                         "download staging");
    Commands commands(image.device());
    for (const Block& part : parts) {
        vkCmdCopyImageToBuffer(commands.handle(), image.handle(), VK_IMAGE_LAYOUT_GENERAL, staging.handle(),
                               1, &part.region);
        commands.submit_and_wait();
        const auto* const floats = reinterpret_cast<const float*>(staging.mapped());
        values.insert(values.end(), floats, floats + part.count);
    }
    return values;
}

}  // namespace candela::vk
