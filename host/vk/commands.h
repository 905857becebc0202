// Commands: work for the device, recorded, then submitted and waited for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <volk.h>

#include "vk/device.h"
#include "vk/handle.h"

namespace candela::vk {

class Buffer;
class Kernel;

// Submissions run one after the other: each sees all writes of the host and of earlier submissions, and the
// host sees all writes of a submission once submit_and_wait() returns. Dispatches of one submission must not
// depend on each other.
class Commands {
  public:
    explicit Commands(const Device& device);

    // Runs groups[0] * groups[1] * groups[2] work groups of `kernel`, with `push_constants` of exactly the
    // kernel's size. All bindings must be bound. Throws an Error that names the limit if there are too many
    // groups.
    void dispatch(const Kernel& kernel, std::span<const std::byte> push_constants,
                  const std::array<uint32_t, 3>& groups);

    // Fills a buffer with zeros, before the dispatches that follow.
    void clear(const Buffer& buffer);
    // Copies a buffer to another of the same size, after the dispatches recorded so far.
    void copy(const Buffer& from, const Buffer& to);

    // Runs the recorded commands, waits until they are done and returns how long the device worked on them
    // [s]: by the device's clock if it has one, otherwise from submit to finish by the host's. Recording then
    // starts over. Throws an Error (device_lost) if the device was lost.
    double submit_and_wait();

    // The command buffer, for transfers.
    VkCommandBuffer handle() const { return buffer_; }

  private:
    void begin();
    double elapsed_by_timestamps() const;

    const Device* device_;
    Unique<VkCommandPool, VkDevice> pool_;
    Unique<VkFence, VkDevice> fence_;
    Unique<VkQueryPool, VkDevice> timestamps_;  // Empty if the queue writes none.
    VkCommandBuffer buffer_ = VK_NULL_HANDLE;   // Freed with the pool.
};

}  // namespace candela::vk
