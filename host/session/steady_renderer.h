// SteadyRenderer: a renderer that continues when its device is lost or out of memory, from the host's copy of
// the state.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "base/error.h"
#include "render/renderer.h"
#include "session/device_slot.h"
#include "session/recovery.h"

namespace candela {

class SteadyRenderer {
  public:
    struct Source {
        DeviceSlot* device;
        const GpuScene* scene;
        const Camera* camera;
        RenderSettings settings;
        std::vector<Accumulation> states;  // To continue from; at least one, with different seeds.
        bool positions = false;            // Whether positions() will be called,
        bool distances = false;            // distances(),
        bool coverage = false;             // and coverage().
        // Whether to go on with coverage(); if not, pixels that are left show nothing.
        std::function<bool()> keep_going = [] { return true; };
        // For motion(), which will be called if there is one.
        const std::optional<MotionSince>* motion = nullptr;
        double copy_seconds = 10.0;  // Between two copies of the state.
    };
    // Called after every failure that is survived, with its cause, the samples that every pixel still holds
    // at least, and how long submissions will take from now on [s].
    using OnFailure = std::function<void(const Error& error, uint32_t kept, double submission_seconds)>;

    // Opens the device, if it is closed, and prepares everything, as Renderer does; what `source` points to
    // must outlive it.
    // Throws Error if that fails, or if a state does not fit.
    SteadyRenderer(Source source, OnFailure on_failure);

    // Starts over, on the same device, with other settings and states, with the source's camera and scene as
    // they are now; of the scene, these buffers have changed. Throws Error if that fails; the object is then
    // unusable.
    void restart(const BufferSet& changed, const RenderSettings& settings, std::vector<Accumulation> states);

    // Selects one of the states() to continue with, as it is there now. At the start, the first is selected.
    void select(size_t state);

    // As Renderer::render(), but `progress` is the fraction of all samples up to the target. If the device
    // fails, reopens it and makes submissions half as long. Throws the Error if Recovery gives up; the states
    // are then the last copies. So they are where keep_going() ends a rendering that has a latency: copying
    // would take longer.
    bool render(uint32_t target, const std::function<bool(double progress)>& keep_going);

    // As Renderer::set_latency().
    void set_latency(double seconds);

    // Copies the selected state from the device to the host. May only be called from keep_going(). render()
    // itself copies every copy_seconds, less often where copying is slow, and at its end.
    void copy_state();
    // The states as last copied, or those of the source.
    std::vector<Accumulation>& states() { return source_.states; }
    const std::vector<Accumulation>& states() const { return source_.states; }

    // The device, which is open until render() throws.
    const vk::Device& device() const { return source_.device->open(); }
    // As Renderer::positions(), if the source asks for them.
    const std::vector<float>& positions() const { return positions_; }
    // As Renderer::distances(), if the source asks for them.
    const std::vector<float>& distances() const { return distances_; }
    // As Renderer::coverage(), by the seed of the first state, if the source asks for it.
    const Coverage& coverage() const { return coverage_; }
    // As Renderer::motion(), if the source asks for it.
    const std::vector<vec2>& motion() const { return motion_; }
    // How the arrays of the scene are read.
    const ArrayMap& array_map() const { return array_map_; }
    double pipeline_seconds() const { return pipeline_seconds_; }
    double pipeline_cpu_seconds() const { return pipeline_cpu_seconds_; }
    // Kernels that the device has compiled since the start, or since it was opened again.
    uint32_t kernels_compiled() const { return device().programs().compiled() - compiled_before_; }
    // How often the device failed since the start.
    uint32_t failures() const { return recovery_.failures(); }

  private:
    void open();
    void load(const BufferSet& changed = {});
    void look_up_first_hits();
    Accumulation& state() { return source_.states[selected_]; }
    void recover(const Error& error);

    Source source_;
    OnFailure on_failure_;
    size_t selected_ = 0;
    bool loaded_ = false;  // Whether the renderer has the selected state.
    std::unique_ptr<Renderer> renderer_;
    std::vector<float> positions_;
    std::vector<float> distances_;
    Coverage coverage_;
    std::vector<vec2> motion_;
    ArrayMap array_map_;
    double pipeline_seconds_ = 0.0;
    double pipeline_cpu_seconds_ = 0.0;
    uint32_t compiled_before_ = 0;
    std::chrono::steady_clock::time_point next_copy_;
    Recovery recovery_;
};

}  // namespace candela
