// Results of Vulkan calls as names and errors.
#include "vk/check.h"

#include <string>
#include <string_view>

#include "base/error.h"

namespace candela::vk {

const char* result_name(VkResult result) {
    switch (result) {
#define NAME(code) \
    case code:     \
        return #code
        NAME(VK_SUCCESS);
        NAME(VK_NOT_READY);
        NAME(VK_TIMEOUT);
        NAME(VK_INCOMPLETE);
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY);
        NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY);
        NAME(VK_ERROR_INITIALIZATION_FAILED);
        NAME(VK_ERROR_DEVICE_LOST);
        NAME(VK_ERROR_MEMORY_MAP_FAILED);
        NAME(VK_ERROR_LAYER_NOT_PRESENT);
        NAME(VK_ERROR_EXTENSION_NOT_PRESENT);
        NAME(VK_ERROR_FEATURE_NOT_PRESENT);
        NAME(VK_ERROR_INCOMPATIBLE_DRIVER);
        NAME(VK_ERROR_TOO_MANY_OBJECTS);
        NAME(VK_ERROR_FORMAT_NOT_SUPPORTED);
        NAME(VK_ERROR_FRAGMENTED_POOL);
        NAME(VK_ERROR_UNKNOWN);
        NAME(VK_ERROR_OUT_OF_POOL_MEMORY);
        NAME(VK_ERROR_FRAGMENTATION);
        NAME(VK_ERROR_INVALID_SHADER_NV);
#undef NAME
        default:
            return "an unknown VkResult";
    }
}

static ErrorKind kind_of(VkResult result) {
    switch (result) {
        case VK_ERROR_DEVICE_LOST:
            return ErrorKind::device_lost;
        case VK_ERROR_OUT_OF_HOST_MEMORY:
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        case VK_ERROR_OUT_OF_POOL_MEMORY:
            return ErrorKind::out_of_memory;
        default:
            return ErrorKind::other;
    }
}

static const char* remedy(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::device_lost:
            return "the driver stopped the device, see the system's log; try another device or a newer "
                   "driver";
        case ErrorKind::out_of_memory:
            return "use less data, free memory, or choose another device";
        default:
            return "try another device or a newer driver";
    }
}

VkResult check(VkResult result, const char* text, const char* file, int line) {
    if (result >= 0) return result;
    const std::string_view path = file;
    const std::string_view name = path.substr(path.find_last_of("/\\") + 1);
    const ErrorKind kind = kind_of(result);
    throw Error(std::string(text) + " failed at " + std::string(name) + ":" + std::to_string(line) + ": " +
                    result_name(result) + " (" + std::to_string(result) + "); " + remedy(kind),
                kind);
}

}  // namespace candela::vk
