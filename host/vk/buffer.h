// Buffer: an array in device memory that kernels read or write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <volk.h>

#include "vk/device.h"
#include "vk/handle.h"
#include "vk/memory.h"

namespace candela::vk {

enum class BufferUsage {
    storage,   // Device-local storage buffer.
    texel,     // Device-local uniform texel buffer of R32G32B32A32_UINT texels (usamplerBuffer).
    uniform,   // Device-local uniform buffer.
    readback,  // Storage buffer in host memory: kernels write it, the host reads it. Copies are staged in it.
};

class Buffer {
  public:
    // Makes a buffer of `size` bytes, rounded up to whole elements (16 bytes, at least one); its contents are
    // undefined. `name` is for messages. Throws an Error that names the buffer, its size and the limit if the
    // device cannot hold or bind it.
    Buffer(const Device& device, uint64_t size, BufferUsage usage, const std::string& name);

    const Device& device() const { return *device_; }
    // The size in bytes, after rounding.
    uint64_t size() const { return size_; }
    BufferUsage usage() const { return usage_; }
    // The contents mapped for the host, or null if they must be copied (vk/transfer.h). Never null for
    // readback.
    std::byte* mapped() const { return memory_.mapped(); }

    VkBuffer handle() const { return buffer_.get(); }
    // The view that a kernel binds; null unless the usage is texel.
    VkBufferView view() const { return view_.get(); }

  private:
    const Device* device_;
    uint64_t size_;
    BufferUsage usage_;
    Memory memory_;
    Unique<VkBuffer, VkDevice> buffer_;
    Unique<VkBufferView, VkDevice> view_;
};

}  // namespace candela::vk
