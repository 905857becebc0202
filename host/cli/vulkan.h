// What commands that use Vulkan share: the environment variables, and the check of the validation layer.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "session/device_slot.h"
#include "vk/instance.h"

namespace candela {

// The options of the instance: validation is on if CANDELA_VALIDATION is set to anything but "" or "0".
// Disables the drivers' own caches if the disk has less than 64 MiB left. Throws Error (out_of_memory) if the
// process has too little address space for drivers.
vk::Instance::Options instance_options();

// Throws Error if the validation layer has reported anything.
void check_validation(const vk::Instance& instance);

// The folder where compiled kernels are kept: candela in $XDG_CACHE_HOME or ~/.cache. None if there is no
// such place or CANDELA_NO_CACHE is set.
std::optional<std::filesystem::path> pipeline_cache_folder();

// A device for commands that may need one, which is opened when they do.
class LazyDevice {
  public:
    // `name`: index or part of the name; by default the best.
    explicit LazyDevice(std::optional<std::string> name = std::nullopt) : name_(std::move(name)) {}

    // Throws Error if there is none.
    const vk::Device& open();
    // See check_validation().
    void check() const;

  private:
    std::optional<std::string> name_;
    std::optional<vk::Instance> instance_;
    std::optional<DeviceSlot> slot_;
};

}  // namespace candela
