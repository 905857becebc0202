// The device's part of `candela render`: one picture after the other, on one device.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "cli/attempts.h"
#include "cli/interrupt.h"
#include "cli/prepared_scene.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "image/image.h"
#include "session/device_slot.h"
#include "session/record.h"
#include "session/rendering.h"
#include "vk/instance.h"

namespace candela {

// CPU time beside a picture's samples [s].
struct OverheadTimes {
    double scene = 0.0;    // To read and build its scene, for all the pictures of the scene.
    double kernels = 0.0;  // To compile kernels, in the thread that asks the driver for them.
    double host = 0.0;     // Of the thread that drives the device, beside that.
    double develop = 0.0;  // From the image to the contents of its files;
    double encode = 0.0;   // to compress and write them.
};

// A picture whose files are not yet written.
struct RenderedPicture {
    Picture picture;
    RenderRecord record;
    Image image;
    std::string state;  // How it ended: "done", "interrupted", "left out" or "time limit".
    std::unique_ptr<Progress> progress;
    double exposure = 0.0;                       // Of its pictures for the screen [EV].
    std::optional<DenoisingRecord> denoising{};  // If it was denoised.
    OverheadTimes overhead{};
    uint64_t image_hash = 0;         // If there is a report.
    Attempts attempts{};             // To write its files.
    std::optional<Error> failure{};  // Of the device, if there are samples nevertheless.
};

class PictureRenderer {
  public:
    // In a batch, messages name the scene or the picture.
    PictureRenderer(const RenderOptions& options, bool is_batch, std::string command_line);

    // Chooses the device. Throws Error if there is none. Does nothing the second time.
    void choose_device();
    // The same device, opened a second time for what runs beside rendering.
    const vk::Device& denoising_device();
    // Renders a picture that has a job. The pictures of a scene and its frames are rendered one after the
    // other, since what the device holds of the scene, as far as they share it, stays until leave_scene().
    // Throws Error if there are no samples, or the device fails for good; the next call opens it again.
    RenderedPicture render(const PreparedScene& scene, const PreparedPicture& picture);
    void leave_scene() {
        rendering_.reset();
        records_ = {};
    }

    // Whether a signal has come since the first picture began.
    bool interrupted() const { return interrupts_ && interrupts_->noted(); }
    // Whether the time for all pictures is over.
    bool time_is_over() const;
    // Whether signals end the program at once.
    bool can_be_quit() const { return !interrupts_; }
    // Throws Error if the validation layer has reported anything.
    void check_validation() const;

  private:
    RenderRecord record_of(const PreparedScene& scene, const RenderJob& job) const;
    bool goes_on() const { return !interrupted() && !time_is_over(); }
    void start(const PreparedScene& scene, const PreparedPicture& picture);
    RenderedPicture run(const PreparedScene& scene, const PreparedPicture& picture);
    void print_details(const GpuScene& scene) const;
    void print_outcome(const RenderRecord& record, uint32_t target, const std::string& name) const;

    const RenderOptions& options_;
    bool is_batch_;
    std::string command_line_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::optional<vk::Instance> instance_;
    std::optional<DeviceSlot> device_, denoising_device_;
    GpuScene records_;                      // Of the current scene.
    std::unique_ptr<Rendering> rendering_;  // Of them.
    std::optional<os::Interrupts> interrupts_;
};

}  // namespace candela
