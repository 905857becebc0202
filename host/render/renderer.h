// Renderer: uploads a scene, traces paths on the device and accumulates them.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "film/accumulation.h"
#include "film/coverage.h"
#include "gpu_scene/gpu_scene.h"
#include "render/array_map.h"
#include "render/motion.h"
#include "render/scene_buffers.h"
#include "render/schedule.h"
#include "scene/scene.h"
#include "shared/kernel_constants.h"
#include "shared/parameters.h"
#include "vk/buffer.h"
#include "vk/commands.h"
#include "vk/image.h"
#include "vk/kernel.h"

namespace candela {

// What camera rays see where they leave the scene.
enum class Backdrop {
    environment,  // As the scene says.
    background,   // Nothing: the picture is put before something else.
    transmitted,  // The same through ideal transmission; how much of it is seen is accumulated (needs
                  // `aovs`).
};

struct RenderSettings {
    uvec2 size{512, 512};  // Pixels of the whole picture.
    PixelRect crop;        // The part to render; not empty.
    Estimator estimator = Estimator::mis;
    SamplerKind sampler = SamplerKind::sobol;
    LightSampler light_sampler = LightSampler::automatic;
    Terminator terminator = Terminator::smooth;
    PixelFilter filter{};
    // Contributions of light that has bounced more than once are scaled down to this mean of their channels
    // [W/(m^2 sr)], above 0; none: they are not.
    std::optional<float> clamp_indirect{};
    uint32_t seed = 0;
    uint32_t first_sample = 0;  // Index of each pixel's first sample.
    uint32_t max_depth = DEPTH_SAFETY_LIMIT;
    uint32_t rr_depth = 3;
    Backdrop backdrop = Backdrop::environment;
    bool aovs = false;      // Accumulate albedo and normal as well.
    bool catchers = false;  // Catchers are seen as such, otherwise as other surfaces (needs `aovs`).
    bool guides = false;    // Accumulate what guides denoisers as well.
    // Bytes of the host's memory that each pixel needs besides what is accumulated.
    uint32_t layer_bytes = 0;
    uint64_t later_bytes = 0;  // Bytes of it that are needed when the picture is there, whatever its size.
    SceneAccess scene_access = SceneAccess::automatic;
    double submission_seconds = 0.0;  // Duration of a submission; 0: suitable for the device.
    // No submission takes longer than that, as far as the device allows: how soon a rendering can end [s].
    double latency = std::numeric_limits<double>::infinity();
    uint32_t pass_growth = PASS_GROWTH;  // See Schedule; changes no bit.
};

// The uniform record of a camera and settings for a scene.
Parameters make_parameters(const GpuScene& scene, const Camera& camera, const RenderSettings& settings);

// The kernels' specialization constants for them; those that depend on the device have their defaults.
KernelConstants make_constants(const GpuScene& scene, const Camera& camera, const RenderSettings& settings);

// The same, including those that depend on the device.
KernelConstants kernel_constants(const vk::Device& device, const GpuScene& scene, const ArrayMap& map,
                                 const Camera& camera, const RenderSettings& settings);

// The renderer's kernels, compiled for kernel_constants(), with nothing bound.
enum class RenderKernel { render, position, first_hits, first_points };
vk::Kernel make_kernel(const vk::Device& device, RenderKernel which, const KernelConstants& constants);

// The layers of the accumulation image without those of guides: LAYER_COUNT_*.
uint32_t layers_before_guides(const RenderSettings& settings);

// The state before the first sample: it holds no values yet.
Accumulation empty_state(const RenderSettings& settings);

// Bytes of device memory for rendering: scene, accumulation image and position image.
uint64_t device_bytes(const GpuScene& scene, const RenderSettings& settings);

class Renderer {
  public:
    // Uploads the scene and compiles the kernel, including an empty first dispatch. `device` must outlive the
    // renderer. Throws Error (out_of_memory) with the memory that is needed and that the device has.
    Renderer(const vk::Device& device, const GpuScene& scene, const Camera& camera,
             const RenderSettings& settings);

    // Starts over without samples, with another camera or other settings. Compiles the kernel only if its
    // constants change (see make_constants). `scene` must have the arrays that it had before, except in the
    // buffers `changed`: only these are copied to the device. The picture is what a new renderer would make.
    void reset(const GpuScene& scene, const Camera& camera, const RenderSettings& settings,
               const BufferSet& changed = {});

    // Adds samples until every pixel holds `target`, or its limit if that is less. Calls
    // `keep_going(progress)`, progress in [0, 1], between submissions; if it returns false, rendering stops,
    // and pixels may hold different numbers of samples. Returns whether the target was reached.
    bool render(uint32_t target, const std::function<bool(double)>& keep_going);

    // Copies the state, counters included, to the host; and from the host, to continue from it. Throws Error
    // if its size, crop, seed, first sample or layers are not those of this rendering.
    Accumulation download() const;
    void upload(const Accumulation& state);

    // x, y, z of the hit of the pinhole ray through each pixel's centre, and its depth along the view axis,
    // or, of a panorama, its distance from the camera [m]; row-major. 0 0 0 infinity at a miss.
    std::vector<float> positions();

    // The distances of these positions along their rays [m], infinite at a miss.
    std::vector<float> distances();

    // What the pixels show first, by FIRST_HITS camera rays each: a function of pixel, seed and filter alone,
    // whichever samples and sampler were asked for. `scene` is the one that was rendered. If keep_going(),
    // which is called between submissions, returns false, the pixels that are left show nothing.
    Coverage coverage(const GpuScene& scene, const std::function<bool()>& keep_going);

    // How far what the centre of each pixel shows has moved in the picture since the frame before; row-major.
    // See render/motion.h. `scene` and `camera` are those that were rendered.
    std::vector<vec2> motion(const GpuScene& scene, const Camera& camera, const MotionSince& since);

    const RenderCounters& counters() const { return counters_; }
    // The sums of samples, layers LAYER_*, for kernels that display them. A reset() to another size replaces
    // the image.
    const vk::StorageImage& accumulation() const { return image_; }
    // How the arrays of the scene are read.
    const ArrayMap& array_map() const { return scene_.map(); }
    // See RenderSettings::latency.
    void set_latency(double seconds) { settings_.latency = seconds; }
    // How long a submission should take [s].
    double submission_seconds() const { return settings_.submission_seconds; }
    // Wall time of compiling, first dispatch included; and the CPU time of it in this thread.
    double pipeline_seconds() const { return pipeline_seconds_; }
    double pipeline_cpu_seconds() const { return pipeline_cpu_seconds_; }

  private:
    struct Work {
        double seconds = 0.0;  // Time on the device.
        uint64_t samples = 0;
    };

    // Makes the render kernel for constants_ and image_, including an empty first dispatch if it is new.
    void compile();
    // A kernel for constants_, bound to the scene.
    vk::Kernel scene_kernel(RenderKernel which) const;
    void record(const vk::Kernel& kernel, Tile tile);
    // As positions(), but in the frame of the scene.
    std::vector<float> positions_in_frame();
    bool dispatch(const Tile& tile, Work& work);
    Work complete(const Tile& tile);
    uvec2 image_size() const { return {settings_.crop.width(), settings_.crop.height()}; }

    const vk::Device* device_;
    RenderSettings settings_;
    SceneFrame frame_;
    vec3 eye_;  // The camera's position, in the frame.
    RenderCounters counters_;
    double pipeline_seconds_ = 0.0;
    double pipeline_cpu_seconds_ = 0.0;
    uint32_t samples_ = 0;  // Samples that every pixel has.

    SceneBuffers scene_;
    KernelConstants constants_;
    vk::Buffer counter_buffer_;  // The device's counters of one submission.
    vk::Buffer counts_;          // The host's copy.
    vk::StorageImage image_;
    vk::Commands commands_;
    std::unique_ptr<vk::Kernel> render_kernel_;
};

}  // namespace candela
