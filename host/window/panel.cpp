// See panel.h.
#include "window/panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <imgui.h>

#include "base/printable.h"
#include "window/controls.h"

namespace candela {
namespace {

constexpr float WIDTH = 290.0f;          // [pixels]
constexpr float START_WIDTH = 340.0f;    // Of the start page.
constexpr float LABEL_WIDTH = 90.0f;     // The part of it for labels.
constexpr float EXPOSURE_RANGE = 10.0f;  // [EV] to either side.
constexpr float INTENSITY_RANGE = 100.0f;
constexpr int DEEPEST = 32;  // Bounces on the slider; one more means no limit.

// In the order of Tonemap and of Estimator.
constexpr std::array TONEMAPS{"linear", "reinhard", "aces", "agx", "neutral"};
constexpr std::array ESTIMATORS{"bsdf", "light", "mis"};

template <class Choice, size_t N>
void choose(const char* label, Choice& choice, const std::array<const char*, N>& names) {
    int index = int(choice);
    if (ImGui::Combo(label, &index, names.data(), int(N))) choice = Choice(index);
}

void show_figures(const ViewFigures& figures) {
    ImGui::Text("%.0f samples per pixel", std::floor(figures.samples));
    ImGui::Text("%.2f Msamples/s", figures.samples_per_second / 1e6);
    if (figures.error) {
        ImGui::Text("estimated error %.2f %%", 100.0 * *figures.error);
    } else {
        ImGui::TextUnformatted("estimated error unknown yet");
    }
    ImGui::Text("%u x %u pixels, %.1f MiB on", figures.size.x, figures.size.y,
                double(figures.device_bytes) / (1 << 20));
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(printable(figures.device, MAX_NAME_BYTES).c_str());
    ImGui::PopTextWrapPos();
}

void show_buttons(ViewState& state, ViewRequests& requests) {
    if (ImGui::Button(state.paused ? "go on" : "pause")) state.paused = !state.paused;
    ImGui::SameLine();
    requests.restart |= ImGui::Button("restart");
    ImGui::SameLine();
    requests.save_png |= ImGui::Button("save PNG");
    ImGui::SameLine();
    requests.save_exr |= ImGui::Button("save EXR");
}

void show_camera(ViewState& state, ViewRequests& requests, std::span<const Camera> cameras) {
    const auto name_of = [](const Camera& camera) { return printable(camera.name, MAX_NAME_BYTES); };
    if (ImGui::BeginCombo("camera", name_of(state.camera).c_str())) {
        for (size_t i = 0; i < cameras.size(); ++i) {
            ImGui::PushID(int(i));  // Names may look alike, or be empty.
            if (ImGui::Selectable(name_of(cameras[i]).c_str(), cameras[i].name == state.camera.name))
                requests.camera = i;
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    requests.home |= ImGui::Button("camera back");
    ImGui::SameLine();
    requests.save_camera |= ImGui::Button("save camera");
    if (state.camera.ortho_height || state.camera.panorama) return;  // It has no lens.
    const float distance = float(length(state.home.look_at - state.home.position));
    Lens& lens = state.camera.lens;
    constexpr ImGuiSliderFlags LOGARITHMIC = ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp;
    ImGui::SliderFloat("aperture", &lens.radius, 0.0f, std::max(0.1f * distance, state.home.lens.radius),
                       "%.4g m", LOGARITHMIC);
    ImGui::SliderFloat("focus", &lens.focal_distance, 0.01f * distance, 100.0f * distance, "%.4g m",
                       LOGARITHMIC);
}

void show_environment(ViewState& state) {
    // Not SliderAngle(), which rounds the angle even if nobody moves it.
    float degrees = glm::degrees(state.environment_rotation);
    if (ImGui::SliderFloat("sky turned", &degrees, -180.0f, 180.0f, "%.0f deg",
                           ImGuiSliderFlags_AlwaysClamp)) {
        state.environment_rotation = glm::radians(degrees);
    }
    // Applied when the slider is released: another intensity needs new tables.
    ImGui::SliderFloat("sky times", &state.intensity_slider, 1.0f / INTENSITY_RANGE, INTENSITY_RANGE, "%.3g",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemDeactivatedAfterEdit()) state.environment_intensity = state.intensity_slider;
}

void show_rendering(ViewState& state) {
    RenderSettings& settings = state.settings;
    choose("estimator", settings.estimator, ESTIMATORS);
    int depth = int(std::min(settings.max_depth, uint32_t(DEEPEST + 1)));
    const bool limited = settings.max_depth < DEPTH_SAFETY_LIMIT;
    const std::string text = limited ? std::to_string(settings.max_depth) : "no limit";
    if (ImGui::SliderInt("bounces", &depth, 0, DEEPEST + 1, text.c_str(), ImGuiSliderFlags_AlwaysClamp)) {
        settings.max_depth = depth > DEEPEST ? DEPTH_SAFETY_LIMIT : uint32_t(depth);
    }
}

// Begins the window of Dear ImGui that all of this is in.
void begin_panel(float width) {
    ImGui::SetNextWindowPos(ImVec2(8.0f, 8.0f), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, 0.0f));
    ImGui::SetNextWindowBgAlpha(0.75f);
    ImGui::Begin("candela", nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoNav);
}

}  // namespace

void show_panel(ViewState& state, ViewRequests& requests, const ViewFigures& figures,
                std::span<const Camera> cameras, bool has_environment) {
    begin_panel(WIDTH);
    ImGui::PushItemWidth(-LABEL_WIDTH);
    show_figures(figures);
    show_buttons(state, requests);
    ImGui::Separator();
    ImGui::SliderFloat("exposure", &state.exposure_ev, -EXPOSURE_RANGE, EXPOSURE_RANGE, "%.2f EV",
                       ImGuiSliderFlags_AlwaysClamp);
    choose("tone map", state.tonemap, TONEMAPS);
    ImGui::Separator();
    show_camera(state, requests, cameras);
    show_rendering(state);
    if (has_environment) show_environment(state);
    ImGui::Checkbox("denoise at rest", &state.denoise);
    if (ImGui::CollapsingHeader("mouse and keys")) ImGui::TextUnformatted(CONTROLS_HELP);
    // Last, so that nothing above moves when it appears.
    if (!figures.message.empty()) ImGui::TextWrapped("%s", figures.message.c_str());
    ImGui::PopItemWidth();
    ImGui::End();
}

void show_start_page(const ViewFigures& figures) {
    begin_panel(START_WIDTH);
    ImGui::TextWrapped(
        "Drop a scene onto this window: a .glb, .gltf, .obj or .ply file, or a .json of candela's own.");
    ImGui::Separator();
    ImGui::TextUnformatted(CONTROLS_HELP);
    ImGui::Separator();
    ImGui::TextWrapped("%s", printable(figures.device, MAX_NAME_BYTES).c_str());
    if (!figures.message.empty()) ImGui::TextWrapped("%s", figures.message.c_str());
    ImGui::End();
}

}  // namespace candela
