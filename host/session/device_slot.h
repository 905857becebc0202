// DeviceSlot: a device that is opened when it is needed, and again after it has been closed. Renderings share
// one, so that each finds the kernels of those before it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "vk/device.h"
#include "vk/instance.h"

namespace candela {

class DeviceSlot {
  public:
    // `info` is from instance.devices(); the instance must outlive this object. Compiled kernels are kept in
    // a file in `pipeline_cache_folder`, if given.
    DeviceSlot(const vk::Instance& instance, vk::DeviceInfo info,
               std::optional<std::filesystem::path> pipeline_cache_folder)
        : instance_(&instance),
          info_(std::move(info)),
          pipeline_cache_folder_(std::move(pipeline_cache_folder)) {}

    // The device, which this opens if it is closed. Throws what vk::Device throws.
    const vk::Device& open() {
        if (!device_) device_ = std::make_unique<vk::Device>(*instance_, info_, pipeline_cache_folder_);
        return *device_;
    }
    // Everything made from the device must be gone.
    void close() { device_.reset(); }

    const vk::DeviceInfo& info() const { return info_; }

  private:
    const vk::Instance* instance_;
    vk::DeviceInfo info_;
    std::optional<std::filesystem::path> pipeline_cache_folder_;
    std::unique_ptr<vk::Device> device_;
};

}  // namespace candela
