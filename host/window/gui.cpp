// See gui.h.
#include "window/gui.h"

#include <algorithm>
#include <cfloat>
#include <iterator>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include "window/rasterise.h"

namespace candela {
namespace {

// The position by which Dear ImGui knows that there is no mouse.
constexpr vec2 NOWHERE(-FLT_MAX);

// Time advances once per frame; further turns advance it by almost nothing [s].
constexpr float INSTANT = 1e-6f;

}  // namespace

Gui::Gui(Window& window) : window_(window), mouse_(NOWHERE) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // Leave no file behind.
    // Draw lines as triangles: the texture is read at the nearest texel, which suits letters, but not lines
    // of any width.
    io.Fonts->Flags |= ImFontAtlasFlags_NoBakedLines;
    io.Fonts->Build();
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForOther(window.handle(), false);
    // Otherwise newer versions ask the system for the mouse's position, which may be ahead of the input being
    // handled.
    ImGui_ImplGlfw_CursorEnterCallback(window.handle(), GLFW_TRUE);
}

Gui::~Gui() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Gui::begin_frame() {
    ImGui_ImplGlfw_NewFrame();
}

void Gui::begin_turn(const Input* input) {
    if (input != nullptr) std::visit([this](const auto& what) { take(what); }, *input);
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = ImVec2(mouse_.x, mouse_.y);
    std::ranges::copy(buttons_, std::begin(io.MouseDown));
    ImGui::NewFrame();
}

void Gui::end_turn() {
    ImGui::EndFrame();
    ImGui::GetIO().DeltaTime = INSTANT;
}

const Overlay& Gui::draw(uvec2 size) {
    ImGui::Render();
    unsigned char* alpha = nullptr;
    int width = 0;
    int height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&alpha, &width, &height);
    rasterise(*ImGui::GetDrawData(), alpha, uvec2(width, height), size, overlay_);
    return overlay_;
}

void Gui::take(const KeyInput& input) {
    ImGui_ImplGlfw_KeyCallback(window_.handle(), input.key, input.scancode,
                               input.down ? GLFW_PRESS : GLFW_RELEASE, input.modifiers);
#if IMGUI_VERSION_NUM >= 18900
    // These versions ask the system for the modifiers, too, which may be ahead of the input being handled.
    if (input.key >= GLFW_KEY_LEFT_SHIFT && input.key <= GLFW_KEY_RIGHT_SUPER)
        modifiers_[size_t(input.key - GLFW_KEY_LEFT_SHIFT)] = input.down;
    constexpr std::array KINDS{ImGuiMod_Shift, ImGuiMod_Ctrl, ImGuiMod_Alt, ImGuiMod_Super};
    for (size_t i = 0; i < KINDS.size(); ++i)
        ImGui::GetIO().AddKeyEvent(KINDS[i], modifiers_[i] || modifiers_[i + KINDS.size()]);
#endif
}

void Gui::take(const CharacterInput& input) {
    ImGui_ImplGlfw_CharCallback(window_.handle(), input.code);
}

void Gui::take(const ButtonInput& input) {
    if (size_t(input.button) < buttons_.size()) buttons_[size_t(input.button)] = input.down;
}

void Gui::take(const MoveInput& input) {
    mouse_ = input.place;
}

// A drag continues outside.
void Gui::take(const LeaveInput&) {
    if (std::ranges::none_of(buttons_, [](bool down) { return down; })) mouse_ = NOWHERE;
}

void Gui::take(const WheelInput& input) {
    ImGui_ImplGlfw_ScrollCallback(window_.handle(), input.steps.x, input.steps.y);
}

void Gui::take(const FocusInput& input) {
    ImGui_ImplGlfw_WindowFocusCallback(window_.handle(), int(input.focused));
}

}  // namespace candela
