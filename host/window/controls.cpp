// See controls.h.
#include "window/controls.h"

#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include "view/camera_control.h"

namespace candela {
namespace {

// A drag over the height of the window turns the camera by half a circle.
constexpr float ORBIT_PER_HEIGHT = PI;

// One step of the wheel shortens the distance by a tenth, or lengthens it by a ninth.
constexpr float DOLLY_PER_STEP = 0.9f;

// Flying covers the distance to the point that the camera looks at in this many seconds, or with Shift in a
// fifth of the time.
constexpr double FLIGHT_SECONDS = 2.0;
constexpr float FAST = 5.0f;

// A button that went down and up within this many pixels was clicked, not dragged.
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
    const float max_dragged = io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left];
    if (ImGui::IsMouseReleased(ImGuiMouseButton_Left) && max_dragged < CLICK_PIXELS * CLICK_PIXELS) {
        requests.focus = vec2(io.MousePos.x, io.MousePos.y) / vec2(io.DisplaySize.x, io.DisplaySize.y);
    }
}

// Moves the camera as if these keys were down for `seconds`.
void fly_by(const std::set<int>& keys, Camera& camera, double seconds) {
    const auto axis = [&](int forth, int back) {
        return double(keys.contains(forth)) - double(keys.contains(back));
    };
    const dvec3 direction(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                          axis(GLFW_KEY_W, GLFW_KEY_S));
    if (direction == dvec3(0.0)) return;
    const double speed = length(camera.look_at - camera.position) * (seconds / FLIGHT_SECONDS);
    candela::fly(camera, direction * speed * (ImGui::GetIO().KeyShift ? double(FAST) : 1.0));
}

void apply_press(int key, ViewState& state, ViewRequests& requests) {
    switch (key) {
        case GLFW_KEY_SPACE:
            state.paused = !state.paused;
            break;
        case GLFW_KEY_TAB:
            state.panel = !state.panel;
            break;
        case GLFW_KEY_N:
            state.denoise = !state.denoise;
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

ViewRequests Controls::apply(const Input* input, ViewState& state, double seconds) {
    ViewRequests requests;
    apply_mouse(state, requests);
    const KeyInput* const key = input == nullptr ? nullptr : std::get_if<KeyInput>(input);
    if (key != nullptr) apply_key(*key, state, requests, seconds);
    return requests;
}

// A key that goes up was down until now: fly() will not see it again, or has never seen it.
void Controls::apply_key(const KeyInput& key, ViewState& state, ViewRequests& requests, double seconds) {
    if (!key.down) {
        if (held_.erase(key.key) > 0) fly_by({key.key}, state.camera, seconds);
    } else if (!ImGui::GetIO().WantTextInput) {
        held_.insert(key.key);
        apply_press(key.key, state, requests);
    }
}

void Controls::fly(Camera& camera, double seconds) const {
    if (!ImGui::GetIO().WantTextInput) fly_by(held_, camera, seconds);
}

}  // namespace candela
