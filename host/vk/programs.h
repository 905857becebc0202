// Compute shaders, compiled for a device. Compiling takes longer than most tests or probes, so a device keeps
// its compiled programs.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <volk.h>

#include "vk/handle.h"

namespace candela::vk {

class Device;

enum class BindingType { texel_buffer, storage_buffer, uniform_buffer, storage_image };

// A declaration of a kernel: layout(set = 0, binding = number), an array if there are several.
struct Binding {
    uint32_t number;
    BindingType type;
    uint32_t count = 1;
};

VkDescriptorType descriptor_type(BindingType type);

struct Program {
    Unique<VkDescriptorSetLayout, VkDevice> set_layout;
    Unique<VkPipelineLayout, VkDevice> layout;
    Unique<VkPipeline, VkDevice> pipeline;
};

// Some megabytes each on a CPU; a session of `candela view` may go through any number of settings.
inline constexpr size_t MAX_PROGRAMS = 64;

class Programs {
  public:
    // The program of these parts, as in Kernel; compiles it if it is not known. `name` is for messages. A
    // program lives while it is in use; when there are MAX_PROGRAMS, all are forgotten.
    std::shared_ptr<const Program> find_or_compile(const Device& device, std::span<const uint32_t> spirv,
                                                   std::span<const Binding> bindings,
                                                   uint32_t push_constant_size,
                                                   std::span<const uint32_t> constants,
                                                   const std::string& name);

    // Makes the next request compile again, so that compile time can be measured.
    void forget() { programs_.clear(); }
    size_t count() const { return programs_.size(); }
    // How many have been compiled so far.
    uint32_t compiled() const { return compiled_; }

  private:
    // The key is all words that the program was made of.
    std::map<std::vector<uint32_t>, std::shared_ptr<const Program>> programs_;
    uint32_t compiled_ = 0;
};

}  // namespace candela::vk
