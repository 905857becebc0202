// The properties of a Vulkan device, and the choice of one device among several.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <volk.h>

namespace candela::vk {

// In the order of preference.
enum class DeviceType { discrete, integrated, virtual_gpu, cpu, other };

// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other".
const char* to_string(DeviceType type);

// The limits that a renderer can exceed, under their names in the Vulkan specification.
struct DeviceLimits {
    uint32_t max_compute_work_group_invocations = 0;
    uint32_t max_compute_work_group_count[3] = {};
    uint32_t max_texel_buffer_elements = 0;
    uint32_t max_storage_buffer_range = 0;  // [bytes]
    uint32_t max_uniform_buffer_range = 0;  // [bytes]
    uint32_t max_push_constants_size = 0;   // [bytes]
    uint32_t max_per_stage_descriptor_storage_buffers = 0;
    uint32_t max_per_stage_descriptor_uniform_buffers = 0;
    uint32_t max_per_stage_descriptor_sampled_images = 0;  // Includes texel buffers.
    uint32_t max_per_stage_descriptor_storage_images = 0;
    uint32_t max_per_stage_resources = 0;  // All four together.
    uint32_t max_image_dimension_2d = 0;   // [pixels]
    uint32_t max_image_array_layers = 0;
    uint64_t max_image_bytes = 0;             // maxResourceSize of an rgba32f storage image.
    uint64_t max_memory_allocation_size = 0;  // [bytes]
};

// One physical device as Instance::devices() found it. If `reason` is not empty, the device is unsuitable,
// and the members below `reason` may be missing.
struct DeviceInfo {
    uint32_t index = 0;  // Its place in the instance's list, for `--device`.
    std::string name;
    DeviceType type = DeviceType::other;
    uint32_t api_version = 0;  // As VK_MAKE_API_VERSION packs it.
    std::string reason;        // Why the device is unsuitable; empty if it is suitable.

    std::string driver;           // Name and version, e.g. "llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)".
    VkDriverId driver_id{};       // The driver, by Vulkan's registry.
    uint32_t queue_family = 0;    // The first family that computes.
    uint32_t timestamp_bits = 0;  // Valid bits of a timestamp; 0: the queue writes none.
    double timestamp_period = 0;  // [ns] per tick.
    uint32_t subgroup_size = 0;   // Invocations.
    uint64_t device_heap = 0;     // The largest device-local heap [bytes]; meaningless on a CPU.
    bool ray_query = false;       // Offers VK_KHR_ray_query; for information only.
    DeviceLimits limits;
    bool presents = false;    // To be opened for a window: see presenter.h.
    bool statistics = false;  // To be opened for statistics of compiled kernels, which it must offer.

    VkPhysicalDevice handle = VK_NULL_HANDLE;

    // True on Mesa's software driver, which compiles kernels to vector instructions of the CPU: it needs
    // other loops than GPUs and other software drivers do.
    bool is_lavapipe() const { return driver_id == VK_DRIVER_ID_MESA_LLVMPIPE; }
    // True if device and host use the same memory, so that the host can write device memory directly.
    bool shares_host_memory() const { return type == DeviceType::cpu || type == DeviceType::integrated; }
};

// "1.3.230" for a packed version.
std::string version_text(uint32_t version);

// The extensions that a device offers, and whether one is among them.
std::vector<VkExtensionProperties> device_extensions(VkPhysicalDevice physical_device);
bool has_extension(std::span<const VkExtensionProperties> extensions, std::string_view name);

// Asks the driver for everything above. `index` is the device's place in the instance's list.
DeviceInfo query_device(VkPhysicalDevice physical_device, uint32_t index);

// Picks a device. Without a request: the first suitable one, in the order discrete, integrated, virtual, CPU
// (lavapipe before others), other; one of Microsoft's Direct3D 12 (Dozen) only if there is no other. A
// request is an index, or a part of a name in any case. Throws an Error (no_device) that lists the devices if
// none or more than one matches, and one that gives the reason if the requested device is unsuitable.
const DeviceInfo& select_device(std::span<const DeviceInfo> devices,
                                const std::optional<std::string>& request);

}  // namespace candela::vk
