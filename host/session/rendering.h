// Rendering: a job from its first sample to its last, with the work at intervals on the way: measuring the
// error, writing checkpoints and images of the samples so far.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "base/error.h"
#include "film/checkpoint.h"
#include "image/image.h"
#include "session/checkpoints.h"
#include "session/convergence.h"
#include "session/interval.h"
#include "session/job.h"
#include "session/record.h"
#include "session/steady_renderer.h"

namespace candela {

// Callbacks of a rendering, between submissions to the device.
struct RenderCallbacks {
    // Gets the fraction of all samples that are done, in [0, 1], and the last estimate of the error.
    std::function<void(double done, std::optional<double> error)> progress;
    // Whether to go on; asked after progress.
    std::function<bool()> keep_going;
    std::function<void(const std::string&)> warn;
    SteadyRenderer::OnFailure device_failed;
    // Gets the image of the samples so far, every job.write_every seconds.
    std::function<void(const RenderRecord&, Image)> write;
};

class Rendering {
  public:
    struct Source {
        DeviceSlot* device;
        const GpuScene* scene;
        std::optional<Checkpoint> resumed;  // To continue from.
        std::optional<Image> reference;     // To measure the error against.
        // Asked before the first sample, while ids are looked up. If it says no, so must the keep_going of
        // run(), and pixels may lack their ids.
        std::function<bool()> keep_going = [] { return true; };
    };

    // Prepares everything, as SteadyRenderer does; what `source` points to must outlive the rendering.
    // `record` is from make_record(), with what the caller adds for its files.
    Rendering(Source source, RenderJob job, RenderRecord record);
    Rendering(const Rendering&) = delete;
    Rendering& operator=(const Rendering&) = delete;

    // Renders until all samples are there, the error is small enough, the time is over or keep_going()
    // returns false. If the device fails for good after there are samples, returns the Error; throws it
    // otherwise.
    std::optional<Error> run(RenderCallbacks callbacks);

    // Takes from the job the samples per pixel, the error and the time [s] that run() renders to, and its
    // latency. There is no reference.
    void set_target(const RenderJob& job);
    // Starts over, on the same device, with another job, which may not ask for files, and with the source's
    // scene as it is now, of which these buffers have changed. Throws Error if that fails; the object is then
    // unusable.
    void restart(RenderJob job, RenderRecord record, const BufferSet& changed);

    // The image of the samples so far, whose numbers record() takes.
    Image image();
    // Writes the last checkpoint, as finished work, if the job asks for one. Throws Error if that fails.
    void finish_checkpoint() const;

    const RenderRecord& record() const { return record_; }
    // The samples per pixel so far.
    uint32_t spp() const { return samples_per_pixel(renderer_.states()); }
    // The most samples that a pixel has.
    uint32_t max_spp() const { return count_samples(renderer_.states()).max; }
    // The device, unless run() has returned an Error.
    const vk::Device& device() const { return renderer_.device(); }

  private:
    void complete_record();
    bool render_and_look();
    bool step(double done);
    void keep();
    Image collect_image(RenderRecord& record) const;
    CheckpointHeader checkpoint_header() const;
    double seconds_of_run() const;
    double seconds() const { return seconds_before_ + seconds_of_run(); }

    const GpuScene* scene_;
    const DeviceSlot* device_;
    RenderJob job_;
    RenderRecord record_;
    RenderCallbacks callbacks_;
    SteadyRenderer renderer_;
    Convergence convergence_;
    std::optional<CheckpointWriter> checkpoints_;
    std::optional<Interval> images_;  // Between two writes of the images.
    std::chrono::steady_clock::time_point start_;
    double seconds_before_;  // Rendering time before this run.
    uint32_t planned_;       // For adaptive rendering: see render_pass().
};

}  // namespace candela
