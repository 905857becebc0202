// Queries a physical device.
#include "vk/device_info.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "vk/check.h"

namespace candela::vk {

const char* to_string(DeviceType type) {
    switch (type) {
        case DeviceType::discrete:
            return "discrete GPU";
        case DeviceType::integrated:
            return "integrated GPU";
        case DeviceType::virtual_gpu:
            return "virtual GPU";
        case DeviceType::cpu:
            return "CPU";
        case DeviceType::other:
            break;
    }
    return "other";
}

std::string version_text(uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
           std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

std::vector<VkExtensionProperties> device_extensions(VkPhysicalDevice physical_device) {
    uint32_t count = 0;
    VK_CHECK(vkEnumerateDeviceExtensionProperties(physical_device, nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    VK_CHECK(vkEnumerateDeviceExtensionProperties(physical_device, nullptr, &count, extensions.data()));
    return extensions;
}

bool has_extension(std::span<const VkExtensionProperties> extensions, std::string_view name) {
    return std::any_of(extensions.begin(), extensions.end(), [name](const VkExtensionProperties& extension) {
        return extension.extensionName == name;
    });
}

static DeviceType device_type(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return DeviceType::discrete;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return DeviceType::integrated;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return DeviceType::virtual_gpu;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return DeviceType::cpu;
        default:
            return DeviceType::other;
    }
}

static DeviceLimits device_limits(const VkPhysicalDeviceLimits& limits) {
    DeviceLimits result;
    result.max_compute_work_group_invocations = limits.maxComputeWorkGroupInvocations;
    std::copy(std::begin(limits.maxComputeWorkGroupCount), std::end(limits.maxComputeWorkGroupCount),
              std::begin(result.max_compute_work_group_count));
    result.max_texel_buffer_elements = limits.maxTexelBufferElements;
    result.max_storage_buffer_range = limits.maxStorageBufferRange;
    result.max_uniform_buffer_range = limits.maxUniformBufferRange;
    result.max_push_constants_size = limits.maxPushConstantsSize;
    result.max_per_stage_descriptor_storage_buffers = limits.maxPerStageDescriptorStorageBuffers;
    result.max_per_stage_descriptor_uniform_buffers = limits.maxPerStageDescriptorUniformBuffers;
    result.max_per_stage_descriptor_sampled_images = limits.maxPerStageDescriptorSampledImages;
    result.max_per_stage_descriptor_storage_images = limits.maxPerStageDescriptorStorageImages;
    result.max_per_stage_resources = limits.maxPerStageResources;
    result.max_image_dimension_2d = limits.maxImageDimension2D;
    result.max_image_array_layers = limits.maxImageArrayLayers;
    return result;
}

// Name, driver, subgroups and limits. The device must offer Vulkan 1.2.
static void query_properties(DeviceInfo& info) {
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceSubgroupProperties subgroup{};
    subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    subgroup.pNext = &driver;
    VkPhysicalDeviceMaintenance3Properties maintenance{};
    maintenance.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
    maintenance.pNext = &subgroup;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &maintenance;
    vkGetPhysicalDeviceProperties2(info.handle, &properties);

    info.driver = std::string(driver.driverName) + ", " + driver.driverInfo;
    info.driver_id = driver.driverID;
    info.subgroup_size = subgroup.subgroupSize;
    info.timestamp_period = properties.properties.limits.timestampPeriod;
    info.limits = device_limits(properties.properties.limits);
    info.limits.max_memory_allocation_size = maintenance.maxMemoryAllocationSize;
}

// The first queue family that computes; sets `reason` if there is none.
static void query_queues(DeviceInfo& info) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(info.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(info.handle, &count, families.data());
    const auto family = std::find_if(families.begin(), families.end(), [](const VkQueueFamilyProperties& f) {
        return (f.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0;
    });
    if (family == families.end()) {
        info.reason = "it has no compute queue";
        return;
    }
    info.queue_family = uint32_t(family - families.begin());
    info.timestamp_bits = family->timestampValidBits;
}

// The formats that kernels use, which Vulkan promises; sets `reason` if one is missing.
static void query_formats(DeviceInfo& info) {
    VkFormatProperties texel{};
    vkGetPhysicalDeviceFormatProperties(info.handle, VK_FORMAT_R32G32B32A32_UINT, &texel);
    if ((texel.bufferFeatures & VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT) == 0) {
        info.reason = "it has no uniform texel buffers of format R32G32B32A32_UINT";
        return;
    }
    VkImageFormatProperties image{};
    const VkResult result = vkGetPhysicalDeviceImageFormatProperties(
        info.handle, VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, 0,
        &image);
    if (result == VK_ERROR_FORMAT_NOT_SUPPORTED) {
        info.reason = "it has no storage images of format R32G32B32A32_SFLOAT";
        return;
    }
    VK_CHECK(result);
    info.limits.max_image_bytes = image.maxResourceSize;
}

// The largest device-local heap; sets `reason` if there is none, as with a driver that compiles for absent
// hardware.
static void query_memory(DeviceInfo& info) {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(info.handle, &memory);
    for (const VkMemoryHeap& heap : std::span(memory.memoryHeaps, memory.memoryHeapCount)) {
        if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) {
            info.device_heap = std::max(info.device_heap, heap.size);
        }
    }
    if (info.device_heap == 0) info.reason = "it has no memory (its device-local heaps have 0 bytes)";
}

DeviceInfo query_device(VkPhysicalDevice physical_device, uint32_t index) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physical_device, &properties);
    DeviceInfo info;
    info.handle = physical_device;
    info.index = index;
    info.name = properties.deviceName;
    info.type = device_type(properties.deviceType);
    info.api_version = properties.apiVersion;
    if (info.api_version < VK_API_VERSION_1_2) {
        info.reason = "it offers Vulkan " + version_text(info.api_version) + ", and 1.2 is needed";
        return info;
    }
    query_properties(info);
    info.ray_query = has_extension(device_extensions(physical_device), "VK_KHR_ray_query");
    query_queues(info);
    if (info.reason.empty()) query_memory(info);
    if (info.reason.empty()) query_formats(info);
    return info;
}

}  // namespace candela::vk
