// Gui: Dear ImGui over a window, from the window's input to an overlay.
#pragma once

#include "view/display.h"
#include "view/window.h"

namespace candela {

// One at a time. Between begin() and end() the widgets of Dear ImGui may be called.
class Gui {
  public:
    // `window` must outlive it.
    explicit Gui(Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    void begin();
    // What the widgets look like, in a window of `size` pixels; valid until the next call.
    const Overlay& end(uvec2 size);

  private:
    Overlay overlay_;
};

}  // namespace candela
