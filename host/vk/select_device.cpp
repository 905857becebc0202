// The choice of one device among several.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <string>
#include <vector>

#include "base/error.h"
#include "vk/device_info.h"

namespace candela::vk {

static std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// `0: "llvmpipe" (CPU), 1: "old" (other; unsuitable: it has no compute queue)`
static std::string list(std::span<const DeviceInfo> devices) {
    std::string text;
    for (const DeviceInfo& device : devices) {
        if (!text.empty()) text += ", ";
        text += std::to_string(device.index) + ": \"" + device.name + "\" (" + to_string(device.type);
        if (!device.reason.empty()) text += "; unsuitable: " + device.reason;
        text += ")";
    }
    return text;
}

// True if `a` suits a renderer better than `b`, regardless of their places in the list.
static bool is_better(const DeviceInfo& a, const DeviceInfo& b) {
    // Mesa's Dozen speaks to Direct3D 12, which knows less than Vulkan, for a GPU or CPU that others may
    // drive.
    const bool a_is_dozen = a.driver_id == VK_DRIVER_ID_MESA_DOZEN;
    const bool b_is_dozen = b.driver_id == VK_DRIVER_ID_MESA_DOZEN;
    if (a_is_dozen != b_is_dozen) return b_is_dozen;
    if (a.type != b.type) return a.type < b.type;
    return a.type == DeviceType::cpu && a.is_lavapipe() && !b.is_lavapipe();
}

static const DeviceInfo& select_default(std::span<const DeviceInfo> devices) {
    const DeviceInfo* best = nullptr;
    for (const DeviceInfo& device : devices) {
        if (device.reason.empty() && (best == nullptr || is_better(device, *best))) best = &device;
    }
    if (best == nullptr) {
        throw Error("no suitable Vulkan device:  " + list(devices) +
                        "; install a newer driver, or mesa-vulkan-drivers to render on the CPU",
                    ErrorKind::no_device);
    }
    return *best;
}

// The devices that match a request, an index or a part of a name.
static std::vector<const DeviceInfo*> find_matches(std::span<const DeviceInfo> devices,
                                                   const std::string& request) {
    uint32_t index = 0;
    const char* const end = request.data() + request.size();
    const auto number = std::from_chars(request.data(), end, index);
    const bool is_index = number.ec == std::errc{} && number.ptr == end;
    std::vector<const DeviceInfo*> matches;
    for (const DeviceInfo& device : devices) {
        const bool matches_name = lower(device.name).find(lower(request)) != std::string::npos;
        if (is_index ? device.index == index : matches_name) matches.push_back(&device);
    }
    return matches;
}

const DeviceInfo& select_device(std::span<const DeviceInfo> devices,
                                const std::optional<std::string>& request) {
    if (devices.empty()) {
        throw Error(
            "Vulkan finds no device; install the driver of your GPU, or mesa-vulkan-drivers to render on the "
            "CPU",
            ErrorKind::no_device);
    }
    if (!request) return select_default(devices);

    const std::vector<const DeviceInfo*> matches = find_matches(devices, *request);
    if (matches.size() != 1) {
        throw Error((matches.empty() ? "no device matches \"" : "more than one device matches \"") +
                        *request + "\"; give the index or a part of the name of one of: " + list(devices),
                    ErrorKind::no_device);
    }
    const DeviceInfo& device = *matches.front();
    if (!device.reason.empty()) {
        throw Error("device " + std::to_string(device.index) + " \"" + device.name + "\" is unsuitable: " +
                        device.reason + "; choose another device or install a newer driver",
                    ErrorKind::no_device);
    }
    return device;
}

}  // namespace candela::vk
