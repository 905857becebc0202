// Cuts the work into submissions that are long enough to be efficient and short enough for any driver's
// watchdog. Pure arithmetic: the cut never changes a bit of the image.
#pragma once

#include <cstdint>

#include "shared/parameters.h"

namespace candela {

// Values of Schedule's `growth`: for an image that is rendered to its end, and for one that somebody may
// watch or stop at any time.
inline constexpr uint32_t PASS_GROWTH = 4;
inline constexpr uint32_t EVEN_PASS_GROWTH = 2;

// Brings an image to a number of samples per pixel in passes over the whole image. The first pass adds one
// sample per pixel, later ones add more. A pass is cut into tiles of whole rows, or of parts of rows if a row
// is too slow. Fewer passes cost less; more passes leave a more even image when rendering stops early.
class Schedule {
  public:
    // `size`: pixels of the image; `first_sample`: samples that every pixel already has; `target`: samples
    // that every pixel will have; `submission_seconds`: duration of a submission; `growth`: the factor by
    // which a pass may increase the number of samples, except for the first two passes.
    Schedule(uvec2 size, uint32_t first_sample, uint32_t target, double submission_seconds, uint32_t growth);

    bool done() const { return pass_start_ >= target_; }
    // The next piece of work; may not be called when done().
    Tile next() const;
    // Reports that next() took that many seconds and added that many samples: fewer than the tile has if
    // pixels have reached their limits.
    void advance(double seconds, uint64_t samples);
    // The fraction of the samples that are done, in [0, 1], as if no pixel had a limit.
    double progress() const;

  private:
    void begin_pass();

    uvec2 size_;
    uint32_t target_;
    double submission_seconds_;
    uint32_t growth_;
    double budget_;  // Samples of single pixels in the next submission.
    uint64_t total_;
    uint64_t finished_ = 0;
    uint32_t pass_start_;   // Samples per pixel before the current pass.
    uint32_t pass_target_;  // Samples per pixel after it.
    uvec2 at_{0, 0};        // Where the next tile begins.
};

// A Tile::stride for that many work groups which spreads groups with neighbouring indices over the whole
// tile. Lavapipe divides the indices evenly among its threads beforehand: without the stride, a thread whose
// half of the tile shows the sky would finish long before the other.
uvec2 spreading_stride(uvec2 groups);

}  // namespace candela
