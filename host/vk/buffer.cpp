// Buffers: their limits, and the ways that bytes take between host and device.
#include "vk/buffer.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "vk/check.h"
#include "vk/commands.h"

namespace candela::vk {

static constexpr uint64_t ELEMENT_BYTES = 16;  // One texel, or one uvec4 of a record.

static VkBufferUsageFlags usage_flags(BufferUsage usage) {
    constexpr VkBufferUsageFlags COPIES = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    switch (usage) {
        case BufferUsage::texel:
            return VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | COPIES;
        case BufferUsage::uniform:
            return VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | COPIES;
        case BufferUsage::storage:
        case BufferUsage::readback:
            break;
    }
    return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | COPIES;
}

static void check_limits(const Device& device, uint64_t size, BufferUsage usage, const std::string& name) {
    const DeviceLimits& limits = device.limits();
    switch (usage) {
        case BufferUsage::texel:
            return device.check_limit(name, "texels", size / ELEMENT_BYTES, limits.max_texel_buffer_elements,
                                      "maxTexelBufferElements");
        case BufferUsage::uniform:
            return device.check_limit(name, "bytes", size, limits.max_uniform_buffer_range,
                                      "maxUniformBufferRange");
        case BufferUsage::storage:
        case BufferUsage::readback:
            return device.check_limit(name, "bytes", size, limits.max_storage_buffer_range,
                                      "maxStorageBufferRange");
    }
}

Buffer::Buffer(const Device& device, uint64_t size, BufferUsage usage, const std::string& name)
    : device_(&device),
      size_((std::max(size, uint64_t{1}) + ELEMENT_BYTES - 1) / ELEMENT_BYTES * ELEMENT_BYTES),
      usage_(usage) {
    const std::string what = "buffer \"" + name + "\"";
    check_limits(device, size_, usage, what);

    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size_;
    info.usage = usage_flags(usage);
    VkBuffer buffer = VK_NULL_HANDLE;
    VK_CHECK(vkCreateBuffer(device.handle(), &info, nullptr, &buffer));
    buffer_ = {buffer, vkDestroyBuffer, device.handle()};
    device.set_name(VK_OBJECT_TYPE_BUFFER, buffer, name);

    VkMemoryRequirements requirements{};
    vkGetBufferMemoryRequirements(device.handle(), buffer, &requirements);
    memory_ = Memory(device, requirements,
                     usage == BufferUsage::readback ? MemoryUse::readback : MemoryUse::upload, what);
    VK_CHECK(vkBindBufferMemory(device.handle(), buffer, memory_.handle(), 0));

    if (usage == BufferUsage::texel) {
        VkBufferViewCreateInfo view_info{};
        view_info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
        view_info.buffer = buffer;
        view_info.format = VK_FORMAT_R32G32B32A32_UINT;
        view_info.range = VK_WHOLE_SIZE;
        VkBufferView view = VK_NULL_HANDLE;
        VK_CHECK(vkCreateBufferView(device.handle(), &view_info, nullptr, &view));
        view_ = {view, vkDestroyBufferView, device.handle()};
    }
}

static void copy(Commands& commands, VkBuffer from, uint64_t from_offset, VkBuffer to, uint64_t to_offset,
                 uint64_t size) {
    const VkBufferCopy region{from_offset, to_offset, size};
    vkCmdCopyBuffer(commands.handle(), from, to, 1, &region);
    commands.submit_and_wait();
}

void Buffer::upload(std::span<const std::byte> bytes, uint64_t offset) {
    assert(offset <= size_ && bytes.size() <= size_ - offset);
    if (bytes.empty()) return;
    if (mapped() != nullptr) {
        std::memcpy(mapped() + offset, bytes.data(), bytes.size());
        return;
    }
    const uint64_t chunk = std::min<uint64_t>(bytes.size(), STAGING_BYTES);
    const Buffer staging(*device_, chunk, BufferUsage::readback, "upload staging");
    Commands commands(*device_);
    for (uint64_t done = 0; done < bytes.size(); done += chunk) {
        const uint64_t count = std::min(chunk, bytes.size() - done);
        std::memcpy(staging.mapped(), bytes.data() + done, count);
        copy(commands, staging.handle(), 0, handle(), offset + done, count);
    }
}

void Buffer::download(std::span<std::byte> bytes, uint64_t offset) const {
    assert(offset <= size_ && bytes.size() <= size_ - offset);
    if (bytes.empty()) return;
    if (mapped() != nullptr) {
        std::memcpy(bytes.data(), mapped() + offset, bytes.size());
        return;
    }
    const uint64_t chunk = std::min<uint64_t>(bytes.size(), STAGING_BYTES);
    const Buffer staging(*device_, chunk, BufferUsage::readback, "download staging");
    Commands commands(*device_);
    for (uint64_t done = 0; done < bytes.size(); done += chunk) {
        const uint64_t count = std::min(chunk, bytes.size() - done);
        copy(commands, handle(), offset + done, staging.handle(), 0, count);
        std::memcpy(bytes.data() + done, staging.mapped(), count);
    }
}

}  // namespace candela::vk
