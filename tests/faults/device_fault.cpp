// A Vulkan layer that makes devices fail, to test what a program does then. Each of the first FAULT_DEVICES
// devices that are opened runs FAULT_AFTER submissions; it answers all others with the VkResult FAULT_RESULT,
// as a lost device would. With FAULT_WORK=1 submissions count from the first on that dispatches more than one
// work group. After the first device, FAULT_OPENINGS times none can be opened. With FAULT_ENUMERATION, a
// VkResult, no device is found; with FAULT_MEMORY=1 all have memory heaps of 0 bytes.
#include <cstdlib>
#include <cstring>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

PFN_vkGetInstanceProcAddr next_instance_function = nullptr;
PFN_vkGetDeviceProcAddr next_device_function = nullptr;
PFN_vkQueueSubmit next_submit = nullptr;
PFN_vkCmdDispatch next_dispatch = nullptr;
VkInstance the_instance = VK_NULL_HANDLE;
int devices = 0;
int submissions = 0;  // To the newest device.
bool works = false;   // It has had a dispatch of more than one work group.

int number(const char* name) {
    const char* const text = std::getenv(name);
    return text == nullptr ? 0 : std::atoi(text);
}

// The element of a create info's chain that leads to the next layer.
template <class LinkInfo>
LinkInfo* find_link(const void* chain, VkStructureType type) {
    auto* info = static_cast<LinkInfo*>(const_cast<void*>(chain));
    while (info != nullptr && !(info->sType == type && info->function == VK_LAYER_LINK_INFO))
        info = static_cast<LinkInfo*>(const_cast<void*>(info->pNext));
    return info;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkInstance* instance) {
    auto* const link =
        find_link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    next_instance_function = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(next_instance_function(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    the_instance = *instance;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* const link =
        find_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    next_device_function = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(
        link->u.pLayerInfo->pfnNextGetInstanceProcAddr(the_instance, "vkCreateDevice"));
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    static int refused = 0;
    if (devices > 0 && refused < number("FAULT_OPENINGS")) {
        ++refused;
        return VK_ERROR_INITIALIZATION_FAILED;
    }
    ++devices;
    submissions = 0;
    works = false;
    const VkResult result = create(physical, info, allocator, device);
    if (result == VK_SUCCESS)
        next_submit = reinterpret_cast<PFN_vkQueueSubmit>(next_device_function(*device, "vkQueueSubmit"));
    if (result == VK_SUCCESS)
        next_dispatch = reinterpret_cast<PFN_vkCmdDispatch>(next_device_function(*device, "vkCmdDispatch"));
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL queue_submit(VkQueue queue, uint32_t count, const VkSubmitInfo* infos,
                                            VkFence fence) {
    if (devices <= number("FAULT_DEVICES") && (works || number("FAULT_WORK") == 0) &&
        ++submissions > number("FAULT_AFTER"))
        return static_cast<VkResult>(number("FAULT_RESULT"));
    return next_submit(queue, count, infos, fence);
}

VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z) {
    works = works || x * y * z > 1;
    next_dispatch(commands, x, y, z);
}

VKAPI_ATTR VkResult VKAPI_CALL enumerate_devices(VkInstance instance, uint32_t* count,
                                                 VkPhysicalDevice* list) {
    const int result = number("FAULT_ENUMERATION");
    if (result != 0) return static_cast<VkResult>(result);
    return reinterpret_cast<PFN_vkEnumeratePhysicalDevices>(
        next_instance_function(instance, "vkEnumeratePhysicalDevices"))(instance, count, list);
}

VKAPI_ATTR void VKAPI_CALL memory_properties(VkPhysicalDevice device,
                                             VkPhysicalDeviceMemoryProperties* properties) {
    reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
        next_instance_function(the_instance, "vkGetPhysicalDeviceMemoryProperties"))(device, properties);
    if (number("FAULT_MEMORY") == 0) return;
    for (uint32_t i = 0; i < properties->memoryHeapCount; ++i)
        properties->memoryHeaps[i].size = 0;
}

PFN_vkVoidFunction own_function(const char* name) {
    if (std::strcmp(name, "vkCreateInstance") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(create_instance);
    if (std::strcmp(name, "vkCreateDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(create_device);
    if (std::strcmp(name, "vkQueueSubmit") == 0) return reinterpret_cast<PFN_vkVoidFunction>(queue_submit);
    if (std::strcmp(name, "vkCmdDispatch") == 0) return reinterpret_cast<PFN_vkVoidFunction>(dispatch);
    if (std::strcmp(name, "vkEnumeratePhysicalDevices") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(enumerate_devices);
    if (std::strcmp(name, "vkGetPhysicalDeviceMemoryProperties") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(memory_properties);
    return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction own = own_function(name);
    return own != nullptr ? own : next_instance_function(instance, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name) {
    const PFN_vkVoidFunction own = own_function(name);
    return own != nullptr ? own : next_device_function(device, name);
}

}  // namespace

// What the loader asks for.
extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = instance_function;
    interface->pfnGetDeviceProcAddr = device_function;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
