// The schedule covers every pixel once per pass, keeps submissions near their length, and stops.
#include "render/schedule.h"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "shared/constants.h"

namespace candela {
namespace {

struct Device {
    double seconds_per_sample;
    double overhead;  // Seconds per submission.
};

// Runs a schedule on a made-up device and checks every tile against the samples that its pixels hold.
struct Rendering {
    std::vector<uint32_t> samples;  // Per pixel.
    size_t submissions = 0;
    double longest = 0.0;  // [s], of the submissions after the first ten, in which the budget settles.
};

Rendering carry_out(uvec2 size, uint32_t first, uint32_t target, double submission_seconds,
                    const Device& device) {
    Schedule schedule(size, first, target, submission_seconds, PASS_GROWTH);
    Rendering r{std::vector<uint32_t>(size_t(size.x) * size.y, first)};
    double progress = 0.0;
    while (!schedule.done()) {
        const Tile tile = schedule.next();
        EXPECT_GT(tile.size.x * tile.size.y, 0u);
        EXPECT_TRUE(tile.origin.x + tile.size.x <= size.x && tile.origin.y + tile.size.y <= size.y);
        EXPECT_LE(tile.target_samples, target);
        const uint32_t before = r.samples[size_t(tile.origin.y) * size.x + tile.origin.x];
        for (uint32_t y = tile.origin.y; y < tile.origin.y + tile.size.y; ++y) {
            for (uint32_t x = tile.origin.x; x < tile.origin.x + tile.size.x; ++x) {
                uint32_t& samples = r.samples[size_t(y) * size.x + x];
                EXPECT_EQ(samples, before) << "a pixel is in two tiles of a pass, or in none";
                samples = tile.target_samples;
            }
        }
        EXPECT_GT(tile.target_samples, before);
        const double work = double(tile.size.x) * tile.size.y * (tile.target_samples - before);
        const double seconds = device.overhead + work * device.seconds_per_sample;
        schedule.advance(seconds, uint64_t(work));
        if (++r.submissions > 10) r.longest = std::max(r.longest, seconds);
        EXPECT_GE(schedule.progress(), progress);
        progress = schedule.progress();
        if (testing::Test::HasFailure() || r.submissions > 1000000) break;
    }
    EXPECT_EQ(progress, r.submissions == 0 ? 0.0 : 1.0);
    return r;
}

TEST(Schedule, EveryPixelReachesTheTargetOnWholePasses) {
    for (const uvec2 size : {uvec2(1, 1), uvec2(7, 1), uvec2(1, 9), uvec2(8, 8), uvec2(37, 23),
                             uvec2(1000, 3), uvec2(3, 1000), uvec2(256, 200)}) {
        for (const uint32_t target : {1u, 2u, 5u, 64u}) {
            for (const double seconds_per_sample : {1e-9, 1e-6, 1e-3}) {
                SCOPED_TRACE(testing::Message() << size.x << 'x' << size.y << ", target " << target << ", "
                                                << seconds_per_sample << " s per sample");
                const Rendering r = carry_out(size, 0, target, 0.05, {seconds_per_sample, 1e-5});
                EXPECT_EQ(std::count(r.samples.begin(), r.samples.end(), target),
                          ptrdiff_t(r.samples.size()));
                if (HasFailure()) return;
            }
        }
    }
}

TEST(Schedule, GoesOnFromTheSamplesThatAreThere) {
    const Rendering r = carry_out(uvec2(37, 23), 5, 16, 0.05, {1e-6, 0.0});
    EXPECT_EQ(std::count(r.samples.begin(), r.samples.end(), 16u), ptrdiff_t(r.samples.size()));
}

TEST(Schedule, ThereIsNothingToDoAtTheTarget) {
    for (const uint32_t first : {7u, 9u}) {
        const Schedule schedule(uvec2(64, 64), first, 7, 0.05, PASS_GROWTH);
        EXPECT_TRUE(schedule.done());
        EXPECT_EQ(schedule.progress(), 1.0);
    }
    EXPECT_TRUE(Schedule(uvec2(64, 64), 0, 0, 0.05, PASS_GROWTH).done());
}

// The smallest piece of work is a group of 8 x 8 pixels; where that is affordable, submissions end up near
// their length.
TEST(Schedule, SubmissionsAreAsLongAsWanted) {
    for (const double seconds_per_sample : {1e-8, 1e-7, 1e-6, 1e-5}) {
        const Rendering r = carry_out(uvec2(640, 480), 0, 64, 0.05, {seconds_per_sample, 0.0});
        EXPECT_LE(r.longest, 0.05 * 1.01) << seconds_per_sample;
        // The last tiles of a pass may be short: half of the work at least is done in full ones.
        EXPECT_LE(double(r.submissions), 2.0 * 640 * 480 * 64 * seconds_per_sample / 0.05 + 70.0)
            << seconds_per_sample;
    }
}

// 4096 pixels at first, then four times as many at most in each submission.
TEST(Schedule, GrowthIsBoundedWhenSubmissionsTakeNoTime) {
    Schedule schedule(uvec2(4096, 4096), 0, 1, 0.05, PASS_GROWTH);
    for (double max = 4096; !schedule.done(); max *= 4) {
        const Tile tile = schedule.next();
        EXPECT_LE(double(tile.size.x) * tile.size.y, max);
        schedule.advance(0.0, uint64_t{tile.size.x} * tile.size.y);
    }
}

// An early stop leaves an even image: all pixels get a first sample, and then none is ahead of another by
// more than eight samples or `growth` times as many.
TEST(Schedule, PassesAreShortWhileTheImageIsYoung) {
    for (const uint32_t growth : {EVEN_PASS_GROWTH, PASS_GROWTH}) {
        Schedule schedule(uvec2(512, 512), 0, 1000, 0.05, growth);
        uint32_t before = 0, reached = 0;
        while (!schedule.done()) {
            const Tile tile = schedule.next();
            if (tile.origin == uvec2(0, 0)) {
                before = std::exchange(reached, tile.target_samples);
                EXPECT_LE(reached, before == 0 ? 1u : std::max(8u, growth * before));
                EXPECT_LE(reached - before, 128u);
            }
            const uint64_t pixels = uint64_t{tile.size.x} * tile.size.y;
            schedule.advance(1e-6 * double(pixels), pixels * (reached - before));
        }
        EXPECT_EQ(reached, 1000u);
    }
}

// In 512 x 512 pixels, only every sixteenth row of groups continues; all others have reached their limits. A
// submission that includes such a row is no longer than allowed, however little the previous ones had to do,
// and those are not made smaller.
TEST(Schedule, PixelsAtTheirLimitsNeitherHideWorkNorMakeSubmissionsSmall) {
    constexpr double SECONDS_PER_SAMPLE = 1e-6, OVERHEAD = 1e-4;
    constexpr uint32_t BEFORE = 64, TARGET = 128;
    Schedule schedule(uvec2(512, 512), BEFORE, TARGET, 0.05, PASS_GROWTH);
    size_t submissions = 0;
    uint64_t done = 0;
    while (!schedule.done()) {
        const Tile tile = schedule.next();
        uint64_t busy = 0;
        for (uint32_t y = tile.origin.y; y < tile.origin.y + tile.size.y; ++y)
            busy += y / WORKGROUP_SIZE % 16 == 0 ? tile.size.x : 0;
        const uint64_t samples = busy * (TARGET - BEFORE);
        const double seconds = OVERHEAD + SECONDS_PER_SAMPLE * double(samples);
        EXPECT_LE(seconds, 0.05 + OVERHEAD);
        schedule.advance(seconds, samples);
        done += samples;
        ++submissions;
    }
    EXPECT_EQ(done, 512u * 512 / 16 * (TARGET - BEFORE));
    // All of it, if every pixel were busy, is 336 submissions; 70 more until the budget has grown.
    EXPECT_LE(submissions, 336u + 70u);
}

// However many threads divide the groups of a row or a column among them, one run each, every thread gets
// groups from all of it: as many from the first half as from the second, within a tenth of all and three. (In
// the order of their places they would differ by half of all with two threads.)
TEST(SpreadingStride, EveryThreadSeesAllOfATile) {
    for (uint32_t n = 1; n <= 600; ++n) {
        SCOPED_TRACE(n);
        const uint32_t stride = spreading_stride(uvec2(n, 1)).x;
        EXPECT_EQ(spreading_stride(uvec2(1, n)).y, stride);
        std::vector<bool> taken(n);
        for (const uint32_t threads : {2u, 3u, 8u, 16u}) {
            for (uint32_t thread = 0; thread < threads; ++thread) {
                int balance = 0;
                for (uint32_t i = n * thread / threads; i < n * (thread + 1) / threads; ++i) {
                    const uint32_t place = i * stride % n;
                    taken[place] = true;
                    balance += 2 * place < n ? 1 : -1;
                }
                EXPECT_LE(std::abs(balance), int(3 + n / 10));
            }
        }
        EXPECT_EQ(std::ranges::count(taken, true), n);
    }
}

}  // namespace
}  // namespace candela
