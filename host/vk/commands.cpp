// Records, submits and times work for the device.
#include "vk/commands.h"

#include <cassert>
#include <chrono>
#include <string>

#include "vk/buffer.h"
#include "vk/check.h"
#include "vk/kernel.h"

namespace candela::vk {

static constexpr uint64_t WAIT_NANOSECONDS = 1'000'000'000;

static void memory_barrier(VkCommandBuffer buffer, VkPipelineStageFlags from, VkAccessFlags written,
                           VkPipelineStageFlags to, VkAccessFlags accessed) {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = written;
    barrier.dstAccessMask = accessed;
    vkCmdPipelineBarrier(buffer, from, to, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

Commands::Commands(const Device& device) : device_(&device) {
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool_info.queueFamilyIndex = device.info().queue_family;
    VkCommandPool pool = VK_NULL_HANDLE;
    VK_CHECK(vkCreateCommandPool(device.handle(), &pool_info, nullptr, &pool));
    pool_ = {pool, vkDestroyCommandPool, device.handle()};

    VkCommandBufferAllocateInfo buffer_info{};
    buffer_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer_info.commandPool = pool;
    buffer_info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer_info.commandBufferCount = 1;
    VK_CHECK(vkAllocateCommandBuffers(device.handle(), &buffer_info, &buffer_));

    VkFenceCreateInfo fence_info{};
    fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    VK_CHECK(vkCreateFence(device.handle(), &fence_info, nullptr, &fence));
    fence_ = {fence, vkDestroyFence, device.handle()};

    if (device.info().timestamp_bits > 0 && device.info().timestamp_period > 0) {
        VkQueryPoolCreateInfo query_info{};
        query_info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        query_info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        query_info.queryCount = 2;
        VkQueryPool queries = VK_NULL_HANDLE;
        VK_CHECK(vkCreateQueryPool(device.handle(), &query_info, nullptr, &queries));
        timestamps_ = {queries, vkDestroyQueryPool, device.handle()};
    }
    begin();
}

void Commands::begin() {
    VK_CHECK(vkResetCommandPool(device_->handle(), pool_.get(), 0));
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VK_CHECK(vkBeginCommandBuffer(buffer_, &info));
    if (timestamps_.get() != VK_NULL_HANDLE) {
        vkCmdResetQueryPool(buffer_, timestamps_.get(), 0, 2);
        vkCmdWriteTimestamp(buffer_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps_.get(), 0);
    }
    // A fence makes writes available, but does not make them visible to the host.
    memory_barrier(buffer_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                   VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                   VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
}

void Commands::dispatch(const Kernel& kernel, std::span<const std::byte> push_constants,
                        const std::array<uint32_t, 3>& groups) {
    assert(push_constants.size() == kernel.push_constant_size());
    for (size_t axis = 0; axis < groups.size(); ++axis) {
        device_->check_limit("a dispatch of kernel \"" + kernel.name() + "\"", "work groups along one axis",
                             groups[axis], device_->limits().max_compute_work_group_count[axis],
                             "maxComputeWorkGroupCount");
    }
    VkDescriptorSet set = kernel.descriptor_set();
    vkCmdBindPipeline(buffer_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
    vkCmdBindDescriptorSets(buffer_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 0, 1, &set, 0, nullptr);
    if (!push_constants.empty()) {
        vkCmdPushConstants(buffer_, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           uint32_t(push_constants.size()), push_constants.data());
    }
    vkCmdDispatch(buffer_, groups[0], groups[1], groups[2]);
}

void Commands::clear(const Buffer& buffer) {
    vkCmdFillBuffer(buffer_, buffer.handle(), 0, VK_WHOLE_SIZE, 0);
    memory_barrier(buffer_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                   VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

void Commands::copy(const Buffer& from, const Buffer& to) {
    assert(from.size() == to.size());
    memory_barrier(buffer_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy region{0, 0, from.size()};
    vkCmdCopyBuffer(buffer_, from.handle(), to.handle(), 1, &region);
}

double Commands::submit_and_wait() {
    memory_barrier(buffer_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                   VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    if (timestamps_.get() != VK_NULL_HANDLE) {
        vkCmdWriteTimestamp(buffer_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_.get(), 1);
    }
    VK_CHECK(vkEndCommandBuffer(buffer_));

    VkFence fence = fence_.get();
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &buffer_;
    const auto start = std::chrono::steady_clock::now();
    VK_CHECK(vkQueueSubmit(device_->queue(), 1, &info, fence));
    // Short waits, since some drivers report a lost device only when a wait begins or ends.
    while (VK_CHECK(vkWaitForFences(device_->handle(), 1, &fence, VK_TRUE, WAIT_NANOSECONDS)) == VK_TIMEOUT) {
    }
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
    VK_CHECK(vkResetFences(device_->handle(), 1, &fence));
    const double seconds = timestamps_.get() != VK_NULL_HANDLE ? elapsed_by_timestamps() : waited.count();
    begin();
    return seconds;
}

double Commands::elapsed_by_timestamps() const {
    std::array<uint64_t, 2> ticks{};
    VK_CHECK(vkGetQueryPoolResults(device_->handle(), timestamps_.get(), 0, 2, sizeof ticks, ticks.data(),
                                   sizeof ticks[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    // The counter wraps around after that many bits.
    const uint32_t bits = device_->info().timestamp_bits;
    const uint64_t mask = bits < 64 ? (uint64_t{1} << bits) - 1 : ~uint64_t{0};
    return double((ticks[1] - ticks[0]) & mask) * device_->info().timestamp_period * 1e-9;
}

}  // namespace candela::vk
