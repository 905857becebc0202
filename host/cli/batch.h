// The pictures of a plan, one after the other: while one is rendered, other threads read and build the next
// scene or pose the next frame of an animation, and write the picture before.
//
//   scene i:   prepare (another thread, beside the rendering of scene i - 1; the first one, this thread)
//              for each picture: render (this thread) -> write (another thread; the last one, this thread)
//
// At most two scenes and two pictures are in memory. What finds no memory beside the others is tried again
// alone. One picture is a plan of one: then an Error is thrown, and a picture that is interrupted, or whose
// device fails, is written as it is. In a batch, errors are printed and counted, and only whole pictures are
// written.
#pragma once

#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "base/exit_code.h"
#include "cli/picture_plan.h"
#include "cli/picture_renderer.h"
#include "cli/prepared_scene.h"
#include "cli/render_options.h"
#include "cli/report.h"

namespace candela {

class Batch {
  public:
    // Throws Error if the report could not be written.
    Batch(PicturePlan& plan, const RenderOptions& options, const std::string& command_line);

    // Renders all pictures. Of several, prints how many are done, and returns the exit code of those that
    // failed: `failed` if theirs differ. Throws the Error of a single one, and if there is no device.
    ExitCode run();

    // See PictureRenderer; only once run() has begun.
    const vk::Device& denoising_device() { return renderer_.denoising_device(); }

  private:
    PreparedScene prepare(size_t i);
    // Whether there is a scene after i, and whether it is a frame of the same one.
    struct Next {
        bool exists, is_frame;
    };
    Next next_of(size_t i) const;
    void begin_next(size_t i);
    bool is_alone() const { return !next_.valid() && !writing_.valid(); }
    void be_alone();
    void render_scene(PreparedScene& scene, bool is_last);
    void render(const PreparedScene& scene, const PreparedPicture& picture, bool is_last);
    void write(RenderedPicture&& rendered, bool is_last);
    ImageOutputs outputs_for(const RenderedPicture& rendered);
    void settle();
    void skip(const Picture& picture);
    void leave_out(const PlannedScene& scene);
    void leave_out(const Picture& picture);
    void report(const Picture& picture, const std::string& state, const std::optional<Error>& failure = {});
    void fail(const Picture& picture, const Error& error);
    void print_failure(const std::string& scene, const Error& error) const;
    void count_failure(const Error& error);
    bool ends_early() const;
    void print_summary() const;

    PicturePlan& plan_;
    const RenderOptions& options_;
    PictureRenderer renderer_;
    Report report_;
    std::unique_ptr<KeptScene> kept_;  // Of the thread that prepares.
    std::future<PreparedScene> next_;
    std::future<RenderedPicture> writing_;
    size_t done_ = 0, skipped_ = 0, failed_ = 0, left_out_ = 0;
    std::optional<double> first_exposure_;  // Of the first picture [EV].
    std::optional<ExitCode> code_;          // Of the pictures that failed.
    bool was_interrupted_ = false;          // Before all pictures were done.
};

}  // namespace candela
