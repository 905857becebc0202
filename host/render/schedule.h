// Cuts the work into submissions that are long enough to be efficient and short enough for any driver's
// watchdog. Pure arithmetic: which cut is made never changes a bit of the image.
#pragma once

#include <cstdint>

#include "shared/parameters.h"

namespace candela {

// Of Schedule, where an image is rendered to its end; and where rendering may stop, or be looked at, at any
// time.
inline constexpr uint32_t PASS_GROWTH = 4;
inline constexpr uint32_t EVEN_PASS_GROWTH = 2;

// Brings an image to a number of samples per pixel in passes over the whole image. A pass adds one sample per
// pixel at first and more as the image fills; it is cut into tiles of whole rows, or parts of rows where even
// those are too much. Fewer passes cost less, more leave a more even image when rendering stops early.
class Schedule {
  public:
    // `size`: pixels of the image; `first_sample`: samples that every pixel holds already; `target`: samples
    // that every pixel shall hold; `submission_seconds`: how long a submission should take; `growth`: a pass,
    // but for the first two, ends with at most so many times as many samples as it began with.
    Schedule(uvec2 size, uint32_t first_sample, uint32_t target, double submission_seconds, uint32_t growth);

    bool done() const { return pass_start_ >= target_; }
    // The next piece of work; not when done().
    Tile next() const;
    // Says that next() was carried out in so many seconds, and how many samples it added: fewer than all
    // where pixels have reached their limits.
    void advance(double seconds, uint64_t samples);
    // Samples carried out over all samples to carry out, in [0, 1], as if no pixel had a limit.
    double progress() const;

  private:
    void begin_pass();

    uvec2 size_;
    uint32_t target_;
    double submission_seconds_;
    uint32_t growth_;
    double budget_;  // Samples (of single pixels) in the next submission.
    uint64_t total_;
    uint64_t finished_ = 0;
    uint32_t pass_start_;   // Samples per pixel before the current pass ...
    uint32_t pass_target_;  // ... and after it.
    uvec2 at_{0, 0};        // Where the next tile begins.
};

// Tile::stride for so many work groups that lets any number of neighbours in the order of their indices lie
// all over the tile. Lavapipe gives each of its threads as many of them beforehand, one after the other: half
// of a tile that shows the sky would else be done long before the other half.
uvec2 spreading_stride(uvec2 groups);

}  // namespace candela
