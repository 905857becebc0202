// Binds the resources of a kernel.
#include "vk/kernel.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "vk/check.h"

namespace candela::vk {

static constexpr std::array BINDING_TYPES{BindingType::texel_buffer, BindingType::storage_buffer,
                                          BindingType::uniform_buffer, BindingType::storage_image};

static uint32_t count(std::span<const Binding> bindings, BindingType type) {
    uint32_t sum = 0;
    for (const Binding& binding : bindings)
        sum += binding.type == type ? binding.count : 0;
    return sum;
}

static void check_limits(const Device& device, std::span<const Binding> bindings, uint32_t push_constant_size,
                         const std::string& name) {
    const DeviceLimits& limits = device.limits();
    device.check_limit(name, "bytes of push constants", push_constant_size, limits.max_push_constants_size,
                       "maxPushConstantsSize");
    device.check_limit(name, "texel buffers", count(bindings, BindingType::texel_buffer),
                       limits.max_per_stage_descriptor_sampled_images, "maxPerStageDescriptorSampledImages");
    device.check_limit(name, "storage buffers", count(bindings, BindingType::storage_buffer),
                       limits.max_per_stage_descriptor_storage_buffers,
                       "maxPerStageDescriptorStorageBuffers");
    device.check_limit(name, "uniform buffers", count(bindings, BindingType::uniform_buffer),
                       limits.max_per_stage_descriptor_uniform_buffers,
                       "maxPerStageDescriptorUniformBuffers");
    device.check_limit(name, "storage images", count(bindings, BindingType::storage_image),
                       limits.max_per_stage_descriptor_storage_images, "maxPerStageDescriptorStorageImages");
    uint32_t all = 0;
    for (const BindingType type : BINDING_TYPES)
        all += count(bindings, type);
    device.check_limit(name, "resources", all, limits.max_per_stage_resources, "maxPerStageResources");
}

Kernel::Kernel(const Device& device, std::span<const uint32_t> spirv, std::span<const Binding> bindings,
               uint32_t push_constant_size, std::span<const uint32_t> constants, const std::string& name)
    : device_(&device),
      name_(name),
      bindings_(bindings.begin(), bindings.end()),
      push_constant_size_(push_constant_size) {
    assert(!bindings.empty());
    check_limits(device, bindings, push_constant_size, "kernel \"" + name + "\"");
    program_ =
        device.programs().find_or_compile(device, spirv, bindings, push_constant_size, constants, name);
    create_descriptor_set();
}

void Kernel::create_descriptor_set() {
    std::vector<VkDescriptorPoolSize> sizes;
    for (const BindingType type : BINDING_TYPES) {
        if (const uint32_t n = count(bindings_, type); n > 0) sizes.push_back({descriptor_type(type), n});
    }
    VkDescriptorPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = uint32_t(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    VK_CHECK(vkCreateDescriptorPool(device_->handle(), &pool_info, nullptr, &pool));
    pool_ = {pool, vkDestroyDescriptorPool, device_->handle()};

    VkDescriptorSetLayout layout = program_->set_layout.get();
    VkDescriptorSetAllocateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    set_info.descriptorPool = pool;
    set_info.descriptorSetCount = 1;
    set_info.pSetLayouts = &layout;
    VK_CHECK(vkAllocateDescriptorSets(device_->handle(), &set_info, &set_));
    device_->set_name(VK_OBJECT_TYPE_DESCRIPTOR_SET, set_, name_);
}

void Kernel::bind(uint32_t number, const Buffer& buffer, uint32_t element) {
    const VkDescriptorBufferInfo info{buffer.handle(), 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = descriptor(number);
    VkBufferView view = buffer.view();
    assert((write.descriptorType == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) == (view != VK_NULL_HANDLE));
    write.dstArrayElement = element;
    write.pBufferInfo = &info;
    write.pTexelBufferView = &view;
    vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
}

void Kernel::bind(uint32_t number, const StorageImage& image) {
    const VkDescriptorImageInfo info{VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write = descriptor(number);
    assert(write.descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    write.pImageInfo = &info;
    vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
}

VkWriteDescriptorSet Kernel::descriptor(uint32_t number) const {
    const auto binding = std::find_if(bindings_.begin(), bindings_.end(),
                                      [number](const Binding& b) { return b.number == number; });
    assert(binding != bindings_.end());
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set_;
    write.dstBinding = number;
    write.descriptorCount = 1;
    write.descriptorType = descriptor_type(binding->type);
    return write;
}

}  // namespace candela::vk
