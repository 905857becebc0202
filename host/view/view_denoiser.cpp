// See view_denoiser.h.
#include "view/view_denoiser.h"

#include <chrono>
#include <utility>

#include "denoise/denoise_image.h"

namespace candela {

// Time between two runs, in times of a run.
static constexpr double REST = 4.0;

void ViewDenoiser::clear() {
    picture_.reset();
    is_outdated_ = running_.valid();
}

void ViewDenoiser::begin(Accumulation state) {
    running_ = std::async(std::launch::async, [this, state = std::move(state)] { return run(state); });
}

bool ViewDenoiser::take() {
    if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return false;
    const bool is_wanted = !std::exchange(is_outdated_, false);
    Run done = running_.get();
    next_ = later(Clock::now(), REST * done.seconds);
    if (is_wanted) picture_ = std::move(done.image);
    return is_wanted;
}

Image ViewDenoiser::denoised(const Accumulation& state) {
    if (running_.valid()) running_.wait();
    return run(state).image;
}

ViewDenoiser::Run ViewDenoiser::run(const Accumulation& state) const {
    const Clock::time_point start = Clock::now();
    Image image =
        make_image(state, {.albedo = true, .normal = true, .variance = true, .sample_count = true}, {});
    add_denoised(image, *denoiser_, false, "the picture");
    return {std::move(image), seconds_between(start, Clock::now())};
}

}  // namespace candela
