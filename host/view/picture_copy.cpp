// See picture_copy.h.
#include "view/picture_copy.h"

#include <algorithm>
#include <utility>

#include "image/relative_error.h"

namespace candela {

static constexpr double COPY_SECONDS = 10.0;
static constexpr double LARGEST_FRACTION = 0.05;

// A look that keeps the window waiting no longer than this is never skipped [s].
static constexpr double SHORT_LOOK = 0.1;

void PictureCopy::clear() {
    state_.reset();
    seen_.reset();
    error_.reset();
    next_ = later(Clock::now(), COPY_SECONDS);
}

void PictureCopy::take(const Renderer& renderer) {
    const Clock::time_point start = Clock::now();
    state_ = renderer.download();
    const Clock::time_point now = Clock::now();
    next_ = later(now, std::max(COPY_SECONDS, seconds_between(start, now) / LARGEST_FRACTION));
}

void PictureCopy::estimate_error(const Renderer& renderer, uint32_t spp, double seconds) {
    if (look_seconds_ > std::max(SHORT_LOOK, LARGEST_FRACTION * seconds)) {
        look_seconds_ /= 2;
        return;
    }
    const Clock::time_point start = Clock::now();
    take(renderer);
    Image image = make_image(*state_, {.sample_count = true}, {});
    if (seen_ && spp >= MIN_ESTIMATED_SPP) {
        const std::optional<double> error = estimate_relative_error(*seen_, image);
        if (error) error_ = error;
    }
    seen_ = std::move(image);
    look_seconds_ = seconds_between(start, Clock::now());
}

}  // namespace candela
