// The Vulkan instance: loads Vulkan, turns on the validation layer if asked, lists the devices.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <volk.h>

#include "vk/device_info.h"
#include "vk/handle.h"

namespace candela::vk {

class MessageLog;

// One instance at a time: the entry points that volk loads are global and belong to the newest.
class Instance {
  public:
    struct Options {
        bool validation = false;  // Turn on VK_LAYER_KHRONOS_validation, synchronization checks included.
        std::vector<std::string> extensions{};  // Required extensions, for windows.
    };

    // Throws an Error: kind no_device if there is no Vulkan loader or no driver, other if validation is
    // asked for and the layer is missing. Both name the packages to install.
    explicit Instance(const Options& options);
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    // Every device that Vulkan shows, usable or not, in Vulkan's order; empty if there is none.
    std::vector<DeviceInfo> devices() const;

    // Every warning and error of the validation layer so far, oldest first; each was printed to stderr too.
    // Safe to call from any thread. Empty without validation.
    std::vector<std::string> validation_messages() const;

    // True if the validation layer is on; objects then carry debug names.
    bool validation() const { return log_ != nullptr; }

    VkInstance handle() const { return instance_.get(); }

  private:
    std::unique_ptr<MessageLog> log_;  // Outlives the messenger, which writes into it.
    Unique<VkInstance> instance_;
    Unique<VkDebugUtilsMessengerEXT, VkInstance> messenger_;
};

}  // namespace candela::vk
