// Opens a device and answers questions about its memory.
#include "vk/device.h"

#include <vector>

#include "base/error.h"
#include "os/memory.h"
#include "vk/check.h"

namespace candela::vk {

static VkDevice create_device(const DeviceInfo& info) {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = info.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;

    // A device that offers this extension (MoltenVK) must be opened with it. Its name is in Vulkan's beta
    // header.
    const char* const portability = "VK_KHR_portability_subset";
    std::vector<const char*> extensions;
    if (has_extension(device_extensions(info.handle), portability)) extensions.push_back(portability);
    if (info.presents) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{};
    statistics.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
    statistics.pipelineExecutableInfo = VK_TRUE;
    if (info.statistics) extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);

    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = info.statistics ? &statistics : nullptr;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    create.enabledExtensionCount = uint32_t(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    VkDevice device = VK_NULL_HANDLE;
    VK_CHECK(vkCreateDevice(info.handle, &create, nullptr, &device));
    return device;
}

Device::Device(const Instance& instance, const DeviceInfo& info,
               const std::optional<std::filesystem::path>& pipeline_cache_folder)
    : info_(info), debug_names_(instance.validation()) {
    if (!info.reason.empty()) {
        throw Error("device \"" + info.name + "\" is unsuitable: " + info.reason, ErrorKind::no_device);
    }
    vkGetPhysicalDeviceMemoryProperties(info.handle, &memory_);
    device_ = {create_device(info), vkDestroyDevice};
    vkGetDeviceQueue(device_.get(), info.queue_family, 0, &queue_);
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(info.handle, &properties);
    pipeline_cache_.emplace(device_.get(), properties, pipeline_cache_folder);
}

uint64_t Device::available_memory() const {
    return info_.type == DeviceType::cpu ? os::free_memory() : info_.device_heap;
}

uint32_t Device::memory_type(uint32_t allowed, VkMemoryPropertyFlags required,
                             VkMemoryPropertyFlags preferred) const {
    for (const VkMemoryPropertyFlags wanted : {required | preferred, required}) {
        for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
            const bool is_allowed = (allowed & (1u << i)) != 0;
            if (is_allowed && (memory_properties(i) & wanted) == wanted) return i;
        }
    }
    throw Error("device \"" + info_.name + "\" has no memory of the kind that is needed (properties " +
                std::to_string(required) + "); choose another device");
}

VkMemoryPropertyFlags Device::memory_properties(uint32_t memory_type) const {
    return memory_.memoryTypes[memory_type].propertyFlags;
}

void Device::check_limit(const std::string& what, const char* unit, uint64_t needed, uint64_t allowed,
                         const char* limit) const {
    if (needed <= allowed) return;
    throw Error(what + " needs " + std::to_string(needed) + " " + unit + ", but \"" + info_.name +
                    "\" allows " + std::to_string(allowed) + " (" + limit +
                    "); use less or choose another device",
                ErrorKind::out_of_memory);
}

void Device::set_object_name(VkObjectType type, uint64_t handle, const std::string& name) const {
    if (!debug_names_) return;
    VkDebugUtilsObjectNameInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    VK_CHECK(vkSetDebugUtilsObjectNameEXT(device_.get(), &info));
}

}  // namespace candela::vk
