// Compiles a kernel and binds its resources.
#include "vk/kernel.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "vk/check.h"

namespace candela::vk {

static constexpr std::array BINDING_TYPES{BindingType::texel_buffer, BindingType::storage_buffer,
                                          BindingType::uniform_buffer, BindingType::storage_image};

static VkDescriptorType descriptor_type(BindingType type) {
    switch (type) {
        case BindingType::texel_buffer:
            return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        case BindingType::storage_buffer:
            return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        case BindingType::uniform_buffer:
            return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        case BindingType::storage_image:
            break;
    }
    return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

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
    create_layouts();
    create_pipeline(spirv, constants);
    create_descriptor_set();
}

void Kernel::create_layouts() {
    std::vector<VkDescriptorSetLayoutBinding> slots;
    for (const Binding& binding : bindings_) {
        slots.push_back({binding.number, descriptor_type(binding.type), binding.count,
                         VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = uint32_t(slots.size());
    set_info.pBindings = slots.data();
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VK_CHECK(vkCreateDescriptorSetLayout(device_->handle(), &set_info, nullptr, &set_layout));
    set_layout_ = {set_layout, vkDestroyDescriptorSetLayout, device_->handle()};

    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, push_constant_size_};
    VkPipelineLayoutCreateInfo layout_info{};
    layout_info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout;
    layout_info.pushConstantRangeCount = push_constant_size_ > 0 ? 1 : 0;
    layout_info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VK_CHECK(vkCreatePipelineLayout(device_->handle(), &layout_info, nullptr, &layout));
    layout_ = {layout, vkDestroyPipelineLayout, device_->handle()};
}

void Kernel::create_pipeline(std::span<const uint32_t> spirv, std::span<const uint32_t> constants) {
    VkShaderModuleCreateInfo module_info{};
    module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module_info.codeSize = spirv.size_bytes();
    module_info.pCode = spirv.data();
    VkShaderModule raw_module = VK_NULL_HANDLE;
    VK_CHECK(vkCreateShaderModule(device_->handle(), &module_info, nullptr, &raw_module));
    const Unique<VkShaderModule, VkDevice> module{raw_module, vkDestroyShaderModule, device_->handle()};

    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t id = 0; id < constants.size(); ++id) {
        entries.push_back({id, id * uint32_t(sizeof(uint32_t)), sizeof(uint32_t)});
    }
    const VkSpecializationInfo specialization{uint32_t(entries.size()), entries.data(),
                                              constants.size_bytes(), constants.data()};
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    if (device_->info().statistics) info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = raw_module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout = layout_.get();
    VkPipeline pipeline = VK_NULL_HANDLE;
    VK_CHECK(
        vkCreateComputePipelines(device_->handle(), device_->pipeline_cache(), 1, &info, nullptr, &pipeline));
    pipeline_ = {pipeline, vkDestroyPipeline, device_->handle()};
    device_->set_name(VK_OBJECT_TYPE_PIPELINE, pipeline, name_);
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

    VkDescriptorSetLayout layout = set_layout_.get();
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
