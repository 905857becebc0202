// Window: a window of the system, its Vulkan surface, and the user's input. Made with GLFW.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/math.h"
#include "vk/presenter.h"
#include "window/input.h"

struct GLFWwindow;

namespace candela {

// Only one may exist at a time.
class Window {
  public:
    // Opens a window whose content has `size` pixels; the user can change that only if it is `resizable`.
    // Throws Error if there is no display, or if it cannot show what Vulkan draws.
    Window(uvec2 size, bool resizable, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // The extensions that an instance needs for make_surface().
    std::vector<std::string> instance_extensions() const;
    // Throws Error if the window cannot have one. Only one surface may exist at a time.
    vk::Surface make_surface(VkInstance instance) const;

    // Pixels of the content; 0 while it is minimised.
    uvec2 size() const;
    void set_title(const std::string& title);
    // Whether the user wants it closed; close() has the same effect.
    bool closing() const;
    void close();

    // Reads the events since the last call; if there are none, wait() waits for one, at most `seconds`.
    void poll();
    void wait(double seconds);
    // Whether the window changed, or the user did anything, since the last call.
    bool take_activity() { return std::exchange(activity_, false); }
    // The input that was read, in order; the caller removes what it has handled.
    std::deque<Input>& inputs() { return inputs_; }
    // The path of the file that was dropped onto the window last, if one was since take_dropped().
    const std::optional<std::string>& dropped() const { return dropped_; }
    std::optional<std::string> take_dropped() { return std::exchange(dropped_, std::nullopt); }

    GLFWwindow* handle() const { return window_; }

  private:
    void watch();
    void add(const Input& input);

    GLFWwindow* window_ = nullptr;
    std::string title_;
    bool activity_ = false;
    std::deque<Input> inputs_;
    std::optional<std::string> dropped_;
};

}  // namespace candela
