// One allocation of device memory, mapped into the host's address space where that is useful.
#pragma once

#include <cstddef>
#include <string>

#include <volk.h>

#include "vk/device.h"
#include "vk/handle.h"

namespace candela::vk {

enum class MemoryUse {
    device,    // Device-local, never mapped.
    upload,    // Device-local; mapped if device and host share their memory.
    readback,  // Visible to both and coherent, cached if possible; always mapped.
};

class Memory {
  public:
    Memory() = default;
    // Allocates memory for `requirements`. Messages call the resource `name`, e.g. `buffer "nodes"`. Throws
    // an Error (out_of_memory) with need and limit if the device cannot hold it.
    Memory(const Device& device, const VkMemoryRequirements& requirements, MemoryUse use,
           const std::string& name);

    VkDeviceMemory handle() const { return memory_.get(); }
    // The first byte as mapped for the host, or null if the memory is not mapped. Coherent: no flush is
    // needed.
    std::byte* mapped() const { return mapped_; }

  private:
    Unique<VkDeviceMemory, VkDevice> memory_;
    std::byte* mapped_ = nullptr;
};

}  // namespace candela::vk
