// Kernel: a compute shader, compiled for the device, with the resources that it is bound to.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <volk.h>

#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/handle.h"
#include "vk/image.h"
#include "vk/programs.h"

namespace candela::vk {

class Kernel {
  public:
    // Compiles `spirv` (entry point "main"), unless the device has compiled the same before. `bindings` lists
    // what the shader declares in set 0, at least one; `push_constant_size` is in bytes, a multiple of 4, or
    // 0; `constants` are the values of specialization constants 0, 1, 2, … (32 bits each); `name` is for
    // messages. Throws an Error that names the kernel and the limit if the device has too few bindings or
    // push constants.
    Kernel(const Device& device, std::span<const uint32_t> spirv, std::span<const Binding> bindings,
           uint32_t push_constant_size, std::span<const uint32_t> constants, const std::string& name);

    // Binds a resource to (an element of) a binding of the matching type. It stays bound, and must live,
    // until another replaces it. Must not be called between a dispatch and the submission that runs it.
    void bind(uint32_t number, const Buffer& buffer, uint32_t element = 0);
    void bind(uint32_t number, const StorageImage& image);

    const std::string& name() const { return name_; }
    uint32_t push_constant_size() const { return push_constant_size_; }

    VkPipeline pipeline() const { return program_->pipeline.get(); }
    VkPipelineLayout layout() const { return program_->layout.get(); }
    VkDescriptorSet descriptor_set() const { return set_; }

  private:
    void create_descriptor_set();
    // The write for the binding of that number, without its resource yet.
    VkWriteDescriptorSet descriptor(uint32_t number) const;

    const Device* device_;
    std::string name_;
    std::vector<Binding> bindings_;
    uint32_t push_constant_size_;
    std::shared_ptr<const Program> program_;
    Unique<VkDescriptorPool, VkDevice> pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;  // Freed with the pool.
};

}  // namespace candela::vk
