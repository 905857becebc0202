// Allocates device memory and checks first that the device can hold it.
#include "vk/memory.h"

#include "base/error.h"
#include "vk/check.h"

namespace candela::vk {

static constexpr VkMemoryPropertyFlags HOST =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

Memory::Memory(const Device& device, const VkMemoryRequirements& requirements, MemoryUse use,
               const std::string& name) {
    device.check_limit(name, "bytes", requirements.size, device.limits().max_memory_allocation_size,
                       "maxMemoryAllocationSize");
    device.check_limit(name, "bytes", requirements.size, device.available_memory(), "available memory");

    // On a discrete GPU, device-local memory that the host can write is small or slow, and is not requested.
    const bool to_map =
        use == MemoryUse::readback || (use == MemoryUse::upload && device.info().shares_host_memory());
    const uint32_t type =
        use == MemoryUse::readback
            ? device.memory_type(requirements.memoryTypeBits, HOST, VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
            : device.memory_type(requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                 to_map ? HOST : 0);

    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = requirements.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    const VkResult result = vkAllocateMemory(device.handle(), &info, nullptr, &memory);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        throw Error(name + " needs " + std::to_string(requirements.size) + " bytes, more than \"" +
                        device.info().name + "\" has left; use less or choose another device",
                    ErrorKind::out_of_memory);
    }
    VK_CHECK(result);
    memory_ = {memory, vkFreeMemory, device.handle()};

    if (to_map && (device.memory_properties(type) & HOST) == HOST) {
        void* mapped = nullptr;
        VK_CHECK(vkMapMemory(device.handle(), memory, 0, VK_WHOLE_SIZE, 0, &mapped));
        mapped_ = static_cast<std::byte*>(mapped);
    }
}

}  // namespace candela::vk
