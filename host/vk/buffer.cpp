// Buffers and their limits.
#include "vk/buffer.h"

#include <algorithm>

#include "vk/check.h"

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

}  // namespace candela::vk
