// See window.h.
#include "window/window.h"

// Included before GLFW's header, which then declares its functions for Vulkan.
#include <volk.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/error.h"
#include "vk/check.h"

namespace candela {
namespace {

// GLFW's last message; its callback cannot store it elsewhere.
std::string last_error;

Error no_window() {
    return Error("cannot open a window: " + last_error +
                 "; run it where there is a display (see DISPLAY or WAYLAND_DISPLAY), or use candela render");
}

Window& window_of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

}  // namespace

Window::Window(uvec2 size, bool resizable, const std::string& title) : title_(title) {
    glfwSetErrorCallback([](int, const char* description) { last_error = description; });
    if (glfwInit() == GLFW_FALSE) throw no_window();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_RESIZABLE, resizable ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    window_ = glfwCreateWindow(int(size.x), int(size.y), title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        glfwTerminate();
        throw no_window();
    }
    glfwSetWindowUserPointer(window_, this);
    watch();
    // GLFW waits until X11 shows the window, for a tenth of a second at most, but for ever if other events
    // are in its queue. (GLFW 3.3)
    glfwPollEvents();
    glfwShowWindow(window_);
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::add(const Input& input) {
    inputs_.push_back(input);
    activity_ = true;
}

void Window::watch() {
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
        // Repeats of a held key are not actions of the user.
        if (action != GLFW_REPEAT) window_of(w).add(KeyInput{key, scancode, action == GLFW_PRESS, modifiers});
    });
    glfwSetCharCallback(window_,
                        [](GLFWwindow* w, unsigned int code) { window_of(w).add(CharacterInput{code}); });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
        window_of(w).add(ButtonInput{button, action == GLFW_PRESS});
    });
    glfwSetCursorPosCallback(
        window_, [](GLFWwindow* w, double x, double y) { window_of(w).add(MoveInput{vec2(x, y)}); });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) {
        if (entered == GLFW_FALSE) window_of(w).add(LeaveInput{});
    });
    glfwSetScrollCallback(
        window_, [](GLFWwindow* w, double x, double y) { window_of(w).add(WheelInput{vec2(x, y)}); });
    glfwSetWindowFocusCallback(
        window_, [](GLFWwindow* w, int focused) { window_of(w).add(FocusInput{focused != GLFW_FALSE}); });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        if (count > 0) window_of(w).dropped_ = paths[0];
        window_of(w).activity_ = true;
    });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { window_of(w).activity_ = true; });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { window_of(w).activity_ = true; });
}

std::vector<std::string> Window::instance_extensions() const {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    // Also null if there is no Vulkan at all; the instance then says so.
    return names == nullptr ? std::vector<std::string>{} : std::vector<std::string>(names, names + count);
}

vk::Surface Window::make_surface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(instance, window_, nullptr, &surface);
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT) {
        throw Error("Vulkan cannot draw in windows here: " + last_error +
                        "; install the driver of your GPU, or use candela render",
                    ErrorKind::no_device);
    }
    VK_CHECK(result);
    return {surface, vkDestroySurfaceKHR, instance};
}

uvec2 Window::size() const {
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    const bool minimised = glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != GLFW_FALSE;
    return minimised ? uvec2(0) : uvec2(width, height);
}

void Window::set_title(const std::string& title) {
    if (title == title_) return;
    title_ = title;
    glfwSetWindowTitle(window_, title.c_str());
}

bool Window::closing() const {
    return glfwWindowShouldClose(window_) != GLFW_FALSE;
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::poll() {
    glfwPollEvents();
}

void Window::wait(double seconds) {
    glfwWaitEventsTimeout(seconds);
}

}  // namespace candela
