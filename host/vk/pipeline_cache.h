// The pipeline cache: compiled kernels, kept in a file between runs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <volk.h>

#include "vk/handle.h"

namespace candela::vk {

class PipelineCache {
  public:
    // Creates the cache and fills it from its file in `folder`, if that is given. The file is named by the
    // device's cache UUID, so that each device and driver has its own. A file that is missing, damaged, of
    // another device or of another user is ignored, as is anything that is not a file.
    PipelineCache(VkDevice device, const VkPhysicalDeviceProperties& properties,
                  const std::optional<std::filesystem::path>& folder);
    // Saves the cache to the file if it changed, in a folder for this user alone. Failure is silent: the next
    // run compiles again.
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return cache_.get(); }

  private:
    void save() const;

    VkDevice device_;
    std::optional<std::filesystem::path> folder_;
    std::string name_;
    std::vector<char> loaded_;  // The contents of the file, so that an unchanged cache is not written again.
    Unique<VkPipelineCache, VkDevice> cache_;
};

}  // namespace candela::vk
