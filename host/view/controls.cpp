// See controls.h.
#include "view/controls.h"

#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include "view/camera_control.h"

namespace candela {
namespace {

// A drag over the height of the window turns the camera by half a circle.
constexpr float ORBIT_PER_HEIGHT = PI;

// One step of the wheel takes a tenth off the distance, or adds a ninth.
constexpr float DOLLY_PER_STEP = 0.9f;

// Flying covers the distance to what the camera looks at in so many seconds, with Shift in a fifth of it.
constexpr double FLIGHT_SECONDS = 2.0;
constexpr float FAST = 5.0f;

// A button that went down and up within so many pixels was clicked, not dragged.
constexpr float CLICK_PIXELS = 3.0f;

void apply_mouse(ViewState& state, ViewRequests& requests) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse || io.DisplaySize.y <= 0.0f) return;
    const vec2 moved = vec2(io.MouseDelta.x, io.MouseDelta.y) / io.DisplaySize.y;
    const auto dragged = [](ImGuiMouseButton button) { return ImGui::IsMouseDragging(button, CLICK_PIXELS); };
    const bool left = dragged(ImGuiMouseButton_Left);
    if (dragged(ImGuiMouseButton_Middle) || dragged(ImGuiMouseButton_Right) || (left && io.KeyShift)) {
        if (moved != vec2(0.0f)) pan(state.camera, vec2(moved.x, -moved.y));
    } else if (left && moved != vec2(0.0f)) {
        orbit(state.camera, ORBIT_PER_HEIGHT * moved.x, ORBIT_PER_HEIGHT * moved.y);
    }
    if (io.MouseWheel != 0.0f) dolly(state.camera, std::pow(DOLLY_PER_STEP, io.MouseWheel));
    const float dragged_most = io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left];
    if (ImGui::IsMouseReleased(ImGuiMouseButton_Left) && dragged_most < CLICK_PIXELS * CLICK_PIXELS) {
        requests.focus = vec2(io.MousePos.x, io.MousePos.y) / vec2(io.DisplaySize.x, io.DisplaySize.y);
    }
}

void apply_flight(const Window& window, Camera& camera, double seconds) {
    const auto axis = [&](int forth, int back) {
        return float(window.is_down(forth)) - float(window.is_down(back));
    };
    const vec3 direction(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                         axis(GLFW_KEY_W, GLFW_KEY_S));
    if (direction == vec3(0.0f)) return;
    const float speed = length(camera.look_at - camera.position) * float(seconds / FLIGHT_SECONDS);
    fly(camera, direction * speed * (ImGui::GetIO().KeyShift ? FAST : 1.0f));
}

void apply_key(int key, ViewState& state, ViewRequests& requests) {
    switch (key) {
        case GLFW_KEY_SPACE:
            state.paused = !state.paused;
            break;
        case GLFW_KEY_TAB:
            state.panel = !state.panel;
            break;
        case GLFW_KEY_R:
            requests.restart = true;
            break;
        case GLFW_KEY_HOME:
            requests.home = true;
            break;
        case GLFW_KEY_P:
            requests.save_png = true;
            break;
        case GLFW_KEY_X:
            requests.save_exr = true;
            break;
        case GLFW_KEY_C:
            requests.save_camera = true;
            break;
        case GLFW_KEY_ESCAPE:
            requests.close = true;
            break;
        default:
            break;
    }
}

}  // namespace

ViewRequests apply_controls(Window& window, ViewState& state, double seconds) {
    ViewRequests requests;
    apply_mouse(state, requests);
    const bool typing = ImGui::GetIO().WantTextInput;
    for (const int key : window.take_keys()) {
        if (!typing) apply_key(key, state, requests);
    }
    if (!typing) apply_flight(window, state.camera, seconds);
    return requests;
}

}  // namespace candela
