// Compute shaders, compiled for a device. Compiling takes longer than most of what a test or a probe asks, so
// a device keeps what it has compiled.
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

// What a kernel declares: layout(set = 0, binding = number), an array if there are several.
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
inline constexpr size_t MOST_PROGRAMS = 64;

class Programs {
  public:
    // The program of these parts, which are those of Kernel; compiles it if there is none. `name` is for
    // messages. A program lives while somebody uses it; when there are MOST_PROGRAMS, all are forgotten.
    std::shared_ptr<const Program> find_or_compile(const Device& device, std::span<const uint32_t> spirv,
                                                   std::span<const Binding> bindings,
                                                   uint32_t push_constant_size,
                                                   std::span<const uint32_t> constants,
                                                   const std::string& name);

    // So that what is asked for next is compiled again: for whoever measures how long that takes.
    void forget() { programs_.clear(); }
    size_t count() const { return programs_.size(); }

  private:
    // By all words that it was made of.
    std::map<std::vector<uint32_t>, std::shared_ptr<const Program>> programs_;
};

}  // namespace candela::vk
