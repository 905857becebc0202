// Surfaces, the swapchain and the copy into its images. The host waits for every step, which is only a copy,
// so presenting needs neither semaphores nor frames in flight.
#include "vk/presenter.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.h"
#include "vk/check.h"

namespace candela::vk {

// How long the program waits for a window that shows nothing, such as a hidden one.
static constexpr uint64_t ACQUIRE_NANOSECONDS = 100'000'000;

void choose_presenting_queue(DeviceInfo& info, VkSurfaceKHR surface) {
    if (!info.reason.empty()) return;
    if (!has_extension(device_extensions(info.handle), VK_KHR_SWAPCHAIN_EXTENSION_NAME)) {
        info.reason = "it cannot show pictures in a window (no VK_KHR_swapchain)";
        return;
    }
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(info.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(info.handle, &count, families.data());
    for (uint32_t i = 0; i < count; ++i) {
        VkBool32 presents = VK_FALSE;
        VK_CHECK(vkGetPhysicalDeviceSurfaceSupportKHR(info.handle, i, surface, &presents));
        if (presents == VK_FALSE || (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) continue;
        info.queue_family = i;
        info.timestamp_bits = families[i].timestampValidBits;
        info.presents = true;
        return;
    }
    info.reason = "none of its compute queues can show pictures in this window";
}

// Pixels of 32 bits can be copied to images of these formats as they are.
static bool is_blue_first(VkFormat format) {
    return format == VK_FORMAT_B8G8R8A8_UNORM || format == VK_FORMAT_B8G8R8A8_SRGB;
}

static bool is_red_first(VkFormat format) {
    return format == VK_FORMAT_R8G8B8A8_UNORM || format == VK_FORMAT_R8G8B8A8_SRGB;
}

// A copy does not convert, so that formats with and without the sRGB curve show the same.
static VkSurfaceFormatKHR choose_format(const Device& device, VkSurfaceKHR surface) {
    uint32_t count = 0;
    VK_CHECK(vkGetPhysicalDeviceSurfaceFormatsKHR(device.info().handle, surface, &count, nullptr));
    std::vector<VkSurfaceFormatKHR> formats(count);
    VK_CHECK(vkGetPhysicalDeviceSurfaceFormatsKHR(device.info().handle, surface, &count, formats.data()));
    for (const VkSurfaceFormatKHR& format : formats) {
        const bool srgb = format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
        if (srgb && (is_blue_first(format.format) || is_red_first(format.format))) return format;
    }
    throw Error("the window cannot show 8-bit sRGB pictures from device \"" + device.info().name +
                    "\"; choose another device (candela devices lists them), or use candela render",
                ErrorKind::no_device);
}

// A mode that never makes the program wait for the display, if there is one.
static VkPresentModeKHR choose_mode(const Device& device, VkSurfaceKHR surface) {
    uint32_t count = 0;
    VK_CHECK(vkGetPhysicalDeviceSurfacePresentModesKHR(device.info().handle, surface, &count, nullptr));
    std::vector<VkPresentModeKHR> modes(count);
    VK_CHECK(vkGetPhysicalDeviceSurfacePresentModesKHR(device.info().handle, surface, &count, modes.data()));
    const bool mailbox = std::ranges::find(modes, VK_PRESENT_MODE_MAILBOX_KHR) != modes.end();
    return mailbox ? VK_PRESENT_MODE_MAILBOX_KHR : VK_PRESENT_MODE_FIFO_KHR;
}

Presenter::Presenter(const Device& device, Surface surface, std::function<Surface()> make_surface)
    : device_(&device),
      make_surface_(std::move(make_surface)),
      surface_(std::move(surface)),
      format_(choose_format(device, surface_.get())),
      blue_first_(is_blue_first(format_.format)),
      commands_(device) {
    VkFenceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    VK_CHECK(vkCreateFence(device.handle(), &info, nullptr, &fence));
    acquired_ = {fence, vkDestroyFence, device.handle()};
}

bool Presenter::survives(VkResult result, const char* call) {
    switch (result) {
        case VK_ERROR_SURFACE_LOST_KHR:
            drop_swapchain();
            surface_ = {};  // Must be destroyed before the window gets another.
            return false;
        case VK_ERROR_OUT_OF_DATE_KHR:
            drop_swapchain();
            return false;
        case VK_TIMEOUT:
        case VK_NOT_READY:
            return false;
        default:
            check(result, call, __FILE__, __LINE__);
            return true;
    }
}

void Presenter::drop_swapchain() {
    VK_CHECK(vkDeviceWaitIdle(device_->handle()));
    images_.clear();
    swapchain_ = {};
}

// Returns false if the window has no area, has another size than the picture, or has lost its surface.
bool Presenter::make_swapchain(uint32_t width, uint32_t height) {
    if (surface_.get() == VK_NULL_HANDLE) surface_ = make_surface_();
    VkSurfaceCapabilitiesKHR surface{};
    if (!survives(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_->info().handle, surface_.get(), &surface),
                  "vkGetPhysicalDeviceSurfaceCapabilitiesKHR")) {
        return false;
    }
    if ((surface.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT) == 0) {
        throw Error("device \"" + device_->info().name +
                        "\" cannot copy pictures to this window; choose another device (candela devices "
                        "lists them), or use candela render",
                    ErrorKind::no_device);
    }
    VkExtent2D extent = surface.currentExtent;
    if (extent.width == UINT32_MAX) extent = {width, height};  // The window adapts to the picture's size.
    if (extent.width != width || extent.height != height) return false;

    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface_.get();
    info.minImageCount = surface.maxImageCount == 0
                             ? surface.minImageCount + 1
                             : std::min(surface.minImageCount + 1, surface.maxImageCount);
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = surface.currentTransform;
    const bool opaque = (surface.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0;
    info.compositeAlpha = opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = choose_mode(*device_, surface_.get());
    info.clipped = VK_TRUE;
    VkSwapchainKHR swapchain = VK_NULL_HANDLE;
    if (!survives(vkCreateSwapchainKHR(device_->handle(), &info, nullptr, &swapchain),
                  "vkCreateSwapchainKHR")) {
        return false;
    }
    swapchain_ = {swapchain, vkDestroySwapchainKHR, device_->handle()};
    width_ = width;
    height_ = height;

    uint32_t count = 0;
    VK_CHECK(vkGetSwapchainImagesKHR(device_->handle(), swapchain, &count, nullptr));
    images_.resize(count);
    VK_CHECK(vkGetSwapchainImagesKHR(device_->handle(), swapchain, &count, images_.data()));
    return true;
}

// Acquires the next image to fill. Returns false if there is none now.
bool Presenter::acquire(uint32_t& index) {
    VkFence fence = acquired_.get();
    if (!survives(vkAcquireNextImageKHR(device_->handle(), swapchain_.get(), ACQUIRE_NANOSECONDS,
                                        VK_NULL_HANDLE, fence, &index),
                  "vkAcquireNextImageKHR")) {
        return false;
    }
    while (VK_CHECK(vkWaitForFences(device_->handle(), 1, &fence, VK_TRUE, ACQUIRE_NANOSECONDS)) ==
           VK_TIMEOUT) {
    }
    VK_CHECK(vkResetFences(device_->handle(), 1, &fence));
    return true;
}

void Presenter::copy(const Buffer& pixels, VkImage image) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands_.handle(), VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         0, 0, nullptr, 0, nullptr, 1, &barrier);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {width_, height_, 1};
    vkCmdCopyBufferToImage(commands_.handle(), pixels.handle(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           1, &region);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = 0;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    vkCmdPipelineBarrier(commands_.handle(), VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    commands_.submit_and_wait();
}

bool Presenter::show(const Buffer& pixels, uint32_t width, uint32_t height) {
    if (width == 0 || height == 0) return false;
    if (swapchain_.get() != VK_NULL_HANDLE && (width != width_ || height != height_)) drop_swapchain();
    if (swapchain_.get() == VK_NULL_HANDLE && !make_swapchain(width, height)) return false;
    uint32_t index = 0;
    if (!acquire(index)) return false;
    copy(pixels, images_[index]);

    VkSwapchainKHR swapchain = swapchain_.get();
    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &index;
    return survives(vkQueuePresentKHR(device_->queue(), &info), "vkQueuePresentKHR");
}

}  // namespace candela::vk
