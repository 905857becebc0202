// The logical device: one compute queue, the programs compiled for it, and the device's memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <volk.h>

#include "vk/device_info.h"
#include "vk/handle.h"
#include "vk/instance.h"
#include "vk/pipeline_cache.h"
#include "vk/programs.h"

namespace candela::vk {

// Everything made from a device refers to it: it must not move, and must outlive them all. For one thread at
// a time.
class Device {
  public:
    // Opens the device that `info` (from instance.devices()) describes. Compiled kernels are kept in a
    // file in `pipeline_cache_folder`, if given. Throws an Error if the device is unsuitable or cannot be
    // opened.
    Device(const Instance& instance, const DeviceInfo& info,
           const std::optional<std::filesystem::path>& pipeline_cache_folder = std::nullopt);
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    const DeviceLimits& limits() const { return info_.limits; }

    // Bytes that can be allocated: on a CPU the RAM that is free now, otherwise the size of the largest
    // device-local heap, regardless of how much of it is in use.
    uint64_t available_memory() const;

    // The index of a memory type among `allowed` (one bit per type) that has all `required` properties, and
    // all `preferred` ones too if there is such a type. Throws an Error if none has the required ones.
    uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags required,
                         VkMemoryPropertyFlags preferred) const;
    // The properties of the memory type of that index.
    VkMemoryPropertyFlags memory_properties(uint32_t memory_type) const;

    // Throws an Error (out_of_memory) if `needed` is more than `allowed`: `what` (e.g. `buffer "nodes"`)
    // needs that many `unit`, but the device allows fewer, by the limit of that name in the Vulkan
    // specification.
    void check_limit(const std::string& what, const char* unit, uint64_t needed, uint64_t allowed,
                     const char* limit) const;

    // Gives a Vulkan object the name that validation messages and debuggers show; does nothing without
    // validation.
    template <class Handle>
    void set_name(VkObjectType type, Handle handle, const std::string& name) const {
        set_object_name(type, (uint64_t)handle, name);
    }

    VkDevice handle() const { return device_.get(); }
    VkQueue queue() const { return queue_; }
    VkPipelineCache pipeline_cache() const { return pipeline_cache_->handle(); }
    Programs& programs() const { return programs_; }

  private:
    void set_object_name(VkObjectType type, uint64_t handle, const std::string& name) const;

    DeviceInfo info_;
    bool debug_names_;
    VkPhysicalDeviceMemoryProperties memory_{};
    Unique<VkDevice> device_;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::optional<PipelineCache> pipeline_cache_;
    mutable Programs programs_;
};

}  // namespace candela::vk
