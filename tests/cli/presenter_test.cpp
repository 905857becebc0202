// Presenting in a window when the window system gives up the surface or the swapchain. Such results replace
// those of the driver, through the pointers by which Vulkan is called.
#ifdef CANDELA_VIEW

#include "vk/presenter.h"

#include <cstdlib>

#include "cli/view_fixture.h"
#include "vk/device.h"
#include "vk/instance.h"
#include "vk/transfer.h"
#include "window/window.h"

namespace candela {
namespace {

constexpr uvec2 SIZE{120, 80};

// While this lives, the next call of `function` returns `result` and does nothing else; later ones are the
// driver's. One at a time for each type of function.
template <class... Arguments>
class NextCall {
  public:
    using Function = VkResult(VKAPI_PTR*)(Arguments...);

    NextCall(VkResult(VKAPI_PTR*& function)(Arguments...), VkResult result) : function_(function) {
        real = function;
        instead = result;
        function = [](Arguments... arguments) {
            if (instead == VK_SUCCESS) return real(arguments...);
            return std::exchange(instead, VK_SUCCESS);
        };
    }
    ~NextCall() { function_ = real; }
    NextCall(const NextCall&) = delete;
    NextCall& operator=(const NextCall&) = delete;

  private:
    inline static Function real;
    inline static VkResult instead;
    Function& function_;
};

class PresenterTest : public ViewTest {
  protected:
    void SetUp() override {
        ViewTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        for (const auto& [name, value] : environment())
            ::setenv(name.c_str(), value.c_str(), 1);
        window_.emplace(SIZE, true, "presenter");
        instance_.emplace(vk::Instance::Options{true, window_->instance_extensions()});
        vk::Surface surface = make_surface();
        std::vector<vk::DeviceInfo> devices = instance_->devices();
        for (vk::DeviceInfo& info : devices)
            vk::choose_presenting_queue(info, surface.get());
        device_.emplace(*instance_, vk::select_device(devices, {}));
        presenter_.emplace(*device_, std::move(surface), [this] { return make_surface(); });
        // However long the window system takes, it is not what makes show() return false here.
        acquire_ = vkAcquireNextImageKHR;
        vkAcquireNextImageKHR = [](VkDevice device, VkSwapchainKHR swapchain, uint64_t, VkSemaphore semaphore,
                                   VkFence fence, uint32_t* index) {
            return acquire_(device, swapchain, UINT64_MAX, semaphore, fence, index);
        };
        pixels_.emplace(*device_, uint64_t{SIZE.x} * SIZE.y * 4, vk::BufferUsage::storage, "pixels");
    }
    void TearDown() override {
        pixels_.reset();
        presenter_.reset();
        device_.reset();
        if (instance_) {
            EXPECT_EQ(instance_->validation_messages(), std::vector<std::string>{});
        }
        instance_.reset();
        window_.reset();
    }

    vk::Surface make_surface() {
        ++surfaces_;
        return window_->make_surface(instance_->handle());
    }
    // Fills the window with a colour, and returns what show() does.
    bool show(uint32_t colour) {
        const std::vector<uint32_t> words(size_t{SIZE.x} * SIZE.y, colour);
        vk::upload(*pixels_, std::as_bytes(std::span(words)));
        return presenter_->show(*pixels_, SIZE.x, SIZE.y);
    }
    // The colour must be on all of the screen that the window covers.
    void expect_on_screen(uint32_t colour) const {
        wait_until("the window is of one colour", [&] {
            const std::vector<uint32_t> pixels = screen();
            for (uint32_t y = 0; y < SIZE.y; ++y) {
                for (uint32_t x = 0; x < SIZE.x; ++x) {
                    if ((pixels[y * SCREEN.x + x] & 0xFFFFFFu) != colour) return false;
                }
            }
            return true;
        });
    }

    static inline PFN_vkAcquireNextImageKHR acquire_ = nullptr;  // The driver's.
    int surfaces_ = 0;
    std::optional<Window> window_;
    std::optional<vk::Instance> instance_;
    std::optional<vk::Device> device_;
    std::optional<vk::Presenter> presenter_;
    std::optional<vk::Buffer> pixels_;
};

// Green and grey read the same in both orders of bytes.
TEST_F(PresenterTest, WhatIsShownIsOnTheScreen) {
    for (const uint32_t colour : {0x00FF00u, 0x808080u, 0x104010u}) {
        EXPECT_TRUE(show(colour));
        expect_on_screen(colour);
    }
    const uint32_t red = presenter_->blue_first() ? 0xFF0000u : 0x0000FFu;
    EXPECT_TRUE(show(red));
    expect_on_screen(0xFF0000u);
    EXPECT_EQ(surfaces_, 1);
}

TEST_F(PresenterTest, ALostSurfaceIsMadeAnew) {
    ASSERT_TRUE(show(0x00FF00u));
    int surfaces = 1;
    const auto recovers = [&](uint32_t colour) {
        EXPECT_FALSE(show(0u));
        EXPECT_TRUE(show(colour));
        expect_on_screen(colour);
        EXPECT_EQ(surfaces_, ++surfaces);
    };
    {
        const NextCall lost(vkAcquireNextImageKHR, VK_ERROR_SURFACE_LOST_KHR);
        recovers(0x808080u);
    }
    {
        const NextCall lost(vkQueuePresentKHR, VK_ERROR_SURFACE_LOST_KHR);
        recovers(0x104010u);
    }
    // The surface is lost once more while it is being recreated.
    const NextCall out_of_date(vkAcquireNextImageKHR, VK_ERROR_OUT_OF_DATE_KHR);
    const NextCall lost(vkGetPhysicalDeviceSurfaceCapabilitiesKHR, VK_ERROR_SURFACE_LOST_KHR);
    EXPECT_FALSE(show(0u));
    recovers(0x00FF00u);
}

TEST_F(PresenterTest, ASwapchainThatIsOutOfDateIsMadeAnewOnTheSameSurface) {
    ASSERT_TRUE(show(0x00FF00u));
    {
        const NextCall out_of_date(vkAcquireNextImageKHR, VK_ERROR_OUT_OF_DATE_KHR);
        EXPECT_FALSE(show(0u));
    }
    {
        const NextCall out_of_date(vkQueuePresentKHR, VK_ERROR_OUT_OF_DATE_KHR);
        EXPECT_FALSE(show(0u));
    }
    EXPECT_TRUE(show(0x808080u));
    expect_on_screen(0x808080u);
    EXPECT_EQ(surfaces_, 1);
}

TEST_F(PresenterTest, APictureThatDoesNotFitTheWindowWaits) {
    EXPECT_FALSE(presenter_->show(*pixels_, 0, 0));
    EXPECT_FALSE(presenter_->show(*pixels_, SIZE.x, SIZE.y / 2));
    EXPECT_TRUE(show(0x00FF00u));
    EXPECT_FALSE(presenter_->show(*pixels_, SIZE.x / 2, SIZE.y));
    EXPECT_TRUE(show(0x808080u));
    expect_on_screen(0x808080u);
}

TEST_F(PresenterTest, OtherFailuresAreErrorsThatNameTheCall) {
    ASSERT_TRUE(show(0x00FF00u));
    const NextCall lost(vkQueuePresentKHR, VK_ERROR_DEVICE_LOST);
    try {
        show(0u);
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::device_lost);
        EXPECT_CONTAINS(std::string(error.what()), "vkQueuePresentKHR failed at presenter.cpp");
    }
}

// Vulkan only promises that pictures can be drawn to a window.
TEST_F(PresenterTest, AWindowThatTakesNoCopiesIsAnError) {
    static PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR real;
    real = vkGetPhysicalDeviceSurfaceCapabilitiesKHR;
    vkGetPhysicalDeviceSurfaceCapabilitiesKHR = [](VkPhysicalDevice device, VkSurfaceKHR surface,
                                                   VkSurfaceCapabilitiesKHR* capabilities) {
        const VkResult result = real(device, surface, capabilities);
        capabilities->supportedUsageFlags = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        return result;
    };
    try {
        show(0u);
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::no_device);
        EXPECT_CONTAINS(std::string(error.what()),
                        "cannot copy pictures to this window; choose another device");
    }
    vkGetPhysicalDeviceSurfaceCapabilitiesKHR = real;
}

}  // namespace
}  // namespace candela

#endif
