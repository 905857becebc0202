// Window: one window of the system, with Vulkan's surface for it and what the user does in it. Made by GLFW.
#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "base/math.h"
#include "view/input.h"
#include "vk/presenter.h"

struct GLFWwindow;

namespace candela {

// One at a time.
class Window {
  public:
    // Opens a window whose content is of `size` pixels; its size stays so unless it is `resizable`. Throws
    // Error if there is no display, or none that can show what Vulkan draws.
    Window(uvec2 size, bool resizable, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // What an instance must offer so that make_surface() can be called with it.
    std::vector<std::string> instance_extensions() const;
    // Throws Error if the window cannot have one. There may be one surface at a time.
    vk::Surface make_surface(VkInstance instance) const;

    // Pixels of the content; 0 while it is minimised.
    uvec2 size() const;
    void set_title(const std::string& title);
    // Whether the user wants it closed; `close` closes it as the user would.
    bool closing() const;
    void close();

    // Takes in what happened since the last time, and, for wait(), waits for that if nothing did, at most so
    // long [s].
    void poll();
    void wait(double seconds);
    // Whether the window changed, or the user did anything, since the last call.
    bool take_activity() { return std::exchange(activity_, false); }
    // What the user did, in that order, as far as it was taken in; who deals with the first removes it.
    std::deque<Input>& inputs() { return inputs_; }

    GLFWwindow* handle() const { return window_; }

  private:
    void watch();
    void add(const Input& input);

    GLFWwindow* window_ = nullptr;
    std::string title_;
    bool activity_ = false;
    std::deque<Input> inputs_;
};

}  // namespace candela
