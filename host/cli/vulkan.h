// What commands that use Vulkan share: the environment variables, and the check that nothing was done wrong.
#pragma once

#include <filesystem>
#include <optional>

#include "vk/instance.h"

namespace candela {

// The options of the instance: validation is on if CANDELA_VALIDATION is set to anything but "" or "0". Has
// the drivers that it will load keep no files of their own where the disk has less than 64 MiB left.
vk::Instance::Options instance_options();

// Throws Error if the validation layer has found fault with anything so far.
void check_validation(const vk::Instance& instance);

// The folder where compiled kernels are kept: candela in $XDG_CACHE_HOME or ~/.cache. None if there is no
// such place or CANDELA_NO_CACHE is set.
std::optional<std::filesystem::path> pipeline_cache_folder();

}  // namespace candela
