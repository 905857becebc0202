// Bounds for what compiled kernels may demand of a device: kernel_bounds.json.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "compiled_kernel.h"

namespace candela {

// The statistics with bounds, under RADV's names. Demand is what a kernel needs before the scheduler spends
// registers that are free up to the next step of occupancy: unlike the registers in use, it grows by one
// where the code needs one more.
inline constexpr const char* STATISTIC_VGPRS = "VGPRs";
inline constexpr const char* STATISTIC_VGPR_DEMAND = "Pre-Sched VGPRs";
inline constexpr const char* STATISTIC_SPILLED_VGPRS = "Spilled VGPRs";
inline constexpr const char* STATISTIC_SCRATCH = "Scratch size";

struct KernelBound {
    std::string device;  // Part of the device's name.
    std::string scene;   // As in CompiledKernel, like the two below.
    std::string kernel;
    std::string buffers;
    double vgpr_demand = 0;  // At most.
};

// For one version of one driver only: another allocates registers in its own way.
struct KernelBounds {
    std::string file;    // For messages.
    std::string driver;  // As DeviceInfo has it.
    std::vector<KernelBound> bounds;
};

// Throws Error that names the file if it cannot be read, a key is missing, or a bound does not say why it has
// its value.
KernelBounds load_kernel_bounds(const std::filesystem::path& file);

// What is wrong, a sentence each: scratch, spilled vector registers, demand above its bound, a statistic that
// the driver does not give, a kernel without a bound, a bound of that device without a kernel. Empty if
// nothing is.
std::vector<std::string> find_violations(const KernelBounds& bounds, const std::string& device,
                                         std::span<const CompiledKernel> kernels);

}  // namespace candela
