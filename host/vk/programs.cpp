// See programs.h.
#include "vk/programs.h"

#include "vk/check.h"
#include "vk/device.h"
#include "vk/live_code.h"
#include "vk/ways_around.h"

namespace candela::vk {
namespace {

// Functions of fewer blocks get no way around them: see ways_around.h.
constexpr uint32_t LEAST_BLOCKS = 10;

void append(std::vector<uint32_t>& words, std::span<const uint32_t> more) {
    words.push_back(uint32_t(more.size()));
    words.insert(words.end(), more.begin(), more.end());
}

std::vector<uint32_t> key_of(std::span<const uint32_t> spirv, std::span<const Binding> bindings,
                             uint32_t push_constant_size, std::span<const uint32_t> constants) {
    std::vector<uint32_t> words{push_constant_size};
    append(words, constants);
    append(words, spirv);
    for (const Binding& binding : bindings)
        append(words, {{binding.number, uint32_t(binding.type), binding.count}});
    return words;
}

void create_layouts(const Device& device, std::span<const Binding> bindings, uint32_t push_constant_size,
                    Program& program) {
    std::vector<VkDescriptorSetLayoutBinding> slots;
    for (const Binding& binding : bindings) {
        slots.push_back({binding.number, descriptor_type(binding.type), binding.count,
                         VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = uint32_t(slots.size());
    set_info.pBindings = slots.data();
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VK_CHECK(vkCreateDescriptorSetLayout(device.handle(), &set_info, nullptr, &set_layout));
    program.set_layout = {set_layout, vkDestroyDescriptorSetLayout, device.handle()};

    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, push_constant_size};
    VkPipelineLayoutCreateInfo layout_info{};
    layout_info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout;
    layout_info.pushConstantRangeCount = push_constant_size > 0 ? 1 : 0;
    layout_info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VK_CHECK(vkCreatePipelineLayout(device.handle(), &layout_info, nullptr, &layout));
    program.layout = {layout, vkDestroyPipelineLayout, device.handle()};
}

void create_pipeline(const Device& device, std::span<const uint32_t> spirv,
                     std::span<const uint32_t> constants, Program& program) {
    VkShaderModuleCreateInfo module_info{};
    module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module_info.codeSize = spirv.size_bytes();
    module_info.pCode = spirv.data();
    VkShaderModule raw_module = VK_NULL_HANDLE;
    VK_CHECK(vkCreateShaderModule(device.handle(), &module_info, nullptr, &raw_module));
    const Unique<VkShaderModule, VkDevice> module{raw_module, vkDestroyShaderModule, device.handle()};

    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t id = 0; id < constants.size(); ++id) {
        entries.push_back({id, id * uint32_t(sizeof(uint32_t)), sizeof(uint32_t)});
    }
    const VkSpecializationInfo specialization{uint32_t(entries.size()), entries.data(),
                                              constants.size_bytes(), constants.data()};
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    if (device.info().statistics) info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = raw_module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout = program.layout.get();
    VkPipeline pipeline = VK_NULL_HANDLE;
    VK_CHECK(
        vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline));
    program.pipeline = {pipeline, vkDestroyPipeline, device.handle()};
}

}  // namespace

VkDescriptorType descriptor_type(BindingType type) {
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

std::shared_ptr<const Program> Programs::find_or_compile(
    const Device& device, std::span<const uint32_t> spirv, std::span<const Binding> bindings,
    uint32_t push_constant_size, std::span<const uint32_t> constants, const std::string& name) {
    std::vector<uint32_t> key = key_of(spirv, bindings, push_constant_size, constants);
    if (const auto found = programs_.find(key); found != programs_.end()) return found->second;
    const auto program = std::make_shared<Program>();
    create_layouts(device, bindings, push_constant_size, *program);
    std::vector<uint32_t> code = live_code(spirv, constants);
    if (device.info().driver_id == VK_DRIVER_ID_GOOGLE_SWIFTSHADER)
        code = with_ways_around(code, LEAST_BLOCKS);
    create_pipeline(device, code, constants, *program);
    device.set_name(VK_OBJECT_TYPE_PIPELINE, program->pipeline.get(), name);
    ++compiled_;
    if (programs_.size() == MAX_PROGRAMS) forget();
    programs_.emplace(std::move(key), program);
    return program;
}

}  // namespace candela::vk
