// ViewDenoiser: denoises a picture while it accumulates, in a thread of its own.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <utility>

#include "denoise/denoiser.h"
#include "film/accumulation.h"
#include "image/image.h"
#include "view/clock.h"

namespace candela {

class ViewDenoiser {
  public:
    // `denoiser` must not be null.
    explicit ViewDenoiser(std::shared_ptr<Denoiser> denoiser) : denoiser_(std::move(denoiser)) {}

    // Forgets the picture: another begins.
    void clear();
    // Whether a run may begin: none is in flight, and runs have taken at most a fifth of the time.
    bool due() const { return !running_.valid() && Clock::now() >= next_; }
    // Begins a run. Call it when it is due().
    void begin(Accumulation state);
    // Whether a run has ended since the last call; picture() is then its result. Throws the Error of the run.
    bool take();
    // The last result, with the layers that add_denoised() adds.
    const std::optional<Image>& picture() const { return picture_; }
    // The result for a picture now, when the run in flight has ended. Throws the Error of the run.
    Image denoised(const Accumulation& state);

  private:
    struct Run {
        Image image;
        double seconds = 0.0;
    };

    Run run(const Accumulation& state) const;

    std::shared_ptr<Denoiser> denoiser_;
    bool is_outdated_ = false;  // The run in flight is of a picture that was forgotten.
    std::optional<Image> picture_;
    Clock::time_point next_;
    std::future<Run> running_;  // Last: it ends before the rest.
};

}  // namespace candela
