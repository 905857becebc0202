// PictureCopy: the host's copy of the picture that accumulates on the device, which outlives the device, and
// the error of the picture as estimated from such copies.
#pragma once

#include <optional>

#include "image/image.h"
#include "render/renderer.h"
#include "view/clock.h"

namespace candela {

class PictureCopy {
  public:
    // Forgets the picture: another begins.
    void clear();

    // Copies the picture as it is now. Call it when it is due(): every ten seconds, or less often if copying
    // would take more than a twentieth of the time.
    void take(const Renderer& renderer);
    bool due() const { return Clock::now() >= next_; }

    // Copies the picture, all of whose pixels hold `spp` samples. Estimates its error, as `candela render
    // --target-error` does, if the last look was at half as many and there are at least MIN_ESTIMATED_SPP.
    // Does nothing if a look would take more than a tenth of a second and more than a twentieth of `seconds`,
    // the picture's time so far. The time of a look is estimated by the last one's, halved each time that
    // nothing is done, so that one slow look does not end them.
    void estimate_error(const Renderer& renderer, uint32_t spp, double seconds);

    const std::optional<Accumulation>& state() const { return state_; }
    // Relative; the last estimate, if there is one.
    std::optional<double> error() const { return error_; }

  private:
    std::optional<Accumulation> state_;
    std::optional<Image> seen_;  // At the last look.
    std::optional<double> error_;
    double look_seconds_ = 0.0;  // Estimated time of a look, for any picture.
    Clock::time_point next_;
};

}  // namespace candela
