// See schedule.h.
#include "render/schedule.h"

#include <algorithm>
#include <numeric>

#include "shared/constants.h"

namespace candela {
namespace {

// The first submission is small, since nothing is known about the device yet: 64 x 64 pixels, one sample.
constexpr double FIRST_BUDGET = 4096;

// The budget grows by at most this factor from one submission to the next: the last one may have been
// unusually cheap.
constexpr double LARGEST_GROWTH = 4;

// If a pass needs several submissions, the first pass adds one sample per pixel, for a quick look; the second
// continues to SECOND_PASS_TARGET, and later ones add at most LARGEST_PASS. Within a pass, neighbours whose
// paths differ in length each continue with their own next sample; at its end they wait for each other, for
// about the time of two samples. A driver that ends an invocation's loops after 65 535 iterations leaves 511
// for each sample of the largest pass.
constexpr uint32_t SECOND_PASS_TARGET = 8;
constexpr uint32_t LARGEST_PASS = 128;

constexpr double GOLDEN_SECTION = 0.618;

// A number coprime to n, near n's golden section, so that any few successive multiples of it modulo n are
// spread over all of n.
uint32_t stride_over(uint32_t n) {
    auto stride = uint32_t(GOLDEN_SECTION * n);
    while (std::gcd(stride, n) != 1)
        ++stride;
    return stride;
}

uint32_t whole_groups(double pixels) {
    return std::max(WORKGROUP_SIZE, uint32_t(std::min(pixels, 1e9)) / WORKGROUP_SIZE * WORKGROUP_SIZE);
}

}  // namespace

Schedule::Schedule(uvec2 size, uint32_t first_sample, uint32_t target, double submission_seconds,
                   uint32_t growth)
    : size_(size),
      target_(target),
      submission_seconds_(submission_seconds),
      growth_(growth),
      budget_(FIRST_BUDGET),
      total_(uint64_t{size.x} * size.y * (std::max(first_sample, target) - first_sample)),
      pass_start_(first_sample),
      pass_target_(first_sample) {
    begin_pass();
}

void Schedule::begin_pass() {
    const double affordable = budget_ / (double(size_.x) * size_.y);
    const uint32_t usual =
        pass_start_ == 0 ? 1 : std::clamp((growth_ - 1) * pass_start_, SECOND_PASS_TARGET - 1, LARGEST_PASS);
    const uint32_t samples = std::max(usual, uint32_t(std::min(affordable, double(target_))));
    pass_target_ = pass_start_ + std::min(samples, target_ - std::min(pass_start_, target_));
    at_ = uvec2(0, 0);
}

Tile Schedule::next() const {
    const double pixels = budget_ / (pass_target_ - pass_start_);
    uvec2 tile{size_.x, whole_groups(pixels / size_.x)};
    if (at_.x > 0 || pixels < double(size_.x) * WORKGROUP_SIZE) {
        tile = uvec2(whole_groups(pixels / WORKGROUP_SIZE), WORKGROUP_SIZE);
    }
    return {.origin = at_,
            .size = min(tile, size_ - at_),
            .stride = {1, 1},
            .target_samples = pass_target_,
            .lane = LANES};
}

// The budget is for tiles in which no pixel has reached its limit. Where most pixels have, the cost of the
// submission itself hides that of the samples, and the budget need not shrink.
void Schedule::advance(double seconds, uint64_t samples) {
    const Tile tile = next();
    const uint64_t max = uint64_t{tile.size.x} * tile.size.y * (pass_target_ - pass_start_);
    finished_ += max;
    const double affordable = submission_seconds_ * double(samples) / std::max(seconds, 1e-9);
    const double changed = std::min(budget_ * LARGEST_GROWTH, affordable);
    const bool telling = samples == max || seconds > submission_seconds_ || changed > budget_;
    if (telling && samples > 0) budget_ = changed;
    at_.x += tile.size.x;
    if (at_.x < size_.x) return;
    at_ = uvec2(0, at_.y + tile.size.y);
    if (at_.y < size_.y) return;
    pass_start_ = pass_target_;
    begin_pass();
}

double Schedule::progress() const {
    return total_ == 0 ? 1.0 : double(finished_) / double(total_);
}

uvec2 spreading_stride(uvec2 groups) {
    return {stride_over(groups.x), stride_over(groups.y)};
}

}  // namespace candela
