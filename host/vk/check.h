// VK_CHECK: turns a failed Vulkan call into an Error.
#pragma once

#include <volk.h>

namespace candela::vk {

// The name of a result as the specification writes it, e.g. "VK_ERROR_DEVICE_LOST".
const char* result_name(VkResult result);

// Returns `result` if it is a success code (VK_TIMEOUT and VK_INCOMPLETE are), else throws an Error that says
// which call (`text`) at which place failed and why: kind device_lost, out_of_memory or other.
VkResult check(VkResult result, const char* text, const char* file, int line);

}  // namespace candela::vk

#define VK_CHECK(call) ::candela::vk::check((call), #call, __FILE__, __LINE__)
