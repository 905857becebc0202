// SteadyRenderer: a renderer that goes on when its device is lost or out of memory, from a copy of the state
// that the host holds.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "render/renderer.h"
#include "vk/device.h"
#include "vk/instance.h"

namespace candela {

class SteadyRenderer {
  public:
    struct Source {
        const vk::Instance* instance;
        vk::DeviceInfo device;
        std::optional<std::filesystem::path> pipeline_cache_file;
        const GpuScene* scene;
        const Camera* camera;
        RenderSettings settings;
        bool positions = false;                            // Whether positions() will be asked for.
        std::optional<Accumulation> state = std::nullopt;  // To continue from.
        double hold_seconds = 10.0;                        // From one copy of the state to the next.
    };
    // Told of every failure that is survived: why, how many samples per pixel are kept at least, and how long
    // submissions will take from now on [s].
    using OnFailure = std::function<void(const Error& error, uint32_t kept, double submission_seconds)>;

    // Opens the device and prepares everything, as Renderer does; what `source` points to must outlive it.
    // Throws Error if that fails, or if the state does not fit.
    SteadyRenderer(Source source, OnFailure on_failure);

    // As Renderer::render(), but `progress` is the share of all samples up to the target. If the device
    // fails, it is opened anew and submissions become half as long. Throws the Error if that happens
    // MOST_FAILURES times without progress of state(), which is then the last one.
    bool render(uint32_t target, const std::function<bool(double progress)>& keep_going);

    // Copies the state from the device to the host. To be called from keep_going(), if at all: render() does
    // it every hold_seconds, less often where copying takes long, and at its end.
    void hold();
    // The state as last copied, or that of the source; none before the first copy.
    const std::optional<Accumulation>& state() const { return source_.state; }

    // The device, until render() throws.
    const vk::Device& device() const { return *device_; }
    // As Renderer::positions(), if the source asks for them.
    const std::vector<float>& positions() const { return positions_; }
    // How the kernels read the scene; not `automatic`.
    SceneAccess scene_access() const { return source_.settings.scene_access; }
    double pipeline_seconds() const { return pipeline_seconds_; }
    // How often the device failed.
    uint32_t failures() const { return failures_; }

    static constexpr uint32_t MOST_FAILURES = 5;

  private:
    void open();
    uint32_t kept() const { return source_.state ? source_.state->least_samples() : 0; }
    void recover(const Error& error);

    Source source_;
    OnFailure on_failure_;
    std::unique_ptr<vk::Device> device_;
    std::unique_ptr<Renderer> renderer_;
    std::vector<float> positions_;
    double pipeline_seconds_ = 0.0;
    std::chrono::steady_clock::time_point next_hold_;
    std::optional<Error> cause_;  // Of the last failure that was not one of opening.
    uint32_t failures_ = 0;
    uint32_t failures_in_a_row_ = 0;   // Since the state went on.
    uint64_t samples_at_failure_ = 0;  // Of the state, at the last failure.
};

}  // namespace candela
