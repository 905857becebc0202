// See gui.h.
#include "view/gui.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include "view/rasterise.h"

namespace candela {

Gui::Gui(Window& window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // Leave no file behind.
    // Lines as triangles: the texture is read at the nearest texel, which serves letters, but not lines of
    // any width.
    io.Fonts->Flags |= ImFontAtlasFlags_NoBakedLines;
    io.Fonts->Build();
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForOther(window.handle(), true);
}

Gui::~Gui() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Gui::begin() {
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

const Overlay& Gui::end(uvec2 size) {
    ImGui::Render();
    unsigned char* alpha = nullptr;
    int width = 0;
    int height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&alpha, &width, &height);
    rasterise(*ImGui::GetDrawData(), alpha, uvec2(width, height), size, overlay_);
    return overlay_;
}

}  // namespace candela
