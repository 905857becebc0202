// How often a device that fails is opened again.
#include "session/recovery.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace candela {
namespace {

const Error LOST("it is lost", ErrorKind::device_lost);
const Error FULL("it is full", ErrorKind::out_of_memory);
const Error OTHER("it is something else");

// How many failures with these samples are survived, up to 20.
template <class Samples>
uint32_t survived(Recovery& recovery, const Samples& samples) {
    for (uint32_t i = 0; i < 20; ++i) {
        if (!recovery.survives(i % 2 == 0 ? LOST : FULL, true, samples(i))) return i;
    }
    return 20;
}

TEST(Recovery, EndsAtTheFifthFailureWithoutProgress) {
    Recovery recovery;
    EXPECT_EQ(survived(recovery, [](uint32_t) { return 0; }), 4u);
    EXPECT_EQ(recovery.failures(), 5u);
}

TEST(Recovery, GoesOnWhileThereIsProgress) {
    Recovery always, early;
    EXPECT_EQ(survived(always, [](uint32_t i) { return i; }), 20u);
    // The failures 3 and after make none.
    EXPECT_EQ(survived(early, [](uint32_t i) { return std::min(i, 3u); }), 7u);
}

TEST(Recovery, CountsFromTheStartIfTheCopyBeginsAgain) {
    Recovery recovery;
    for (int i = 0; i < 4; ++i)
        EXPECT_TRUE(recovery.survives(LOST, true, 100));
    recovery.forget_progress();
    EXPECT_TRUE(recovery.survives(LOST, true, 1));
}

TEST(Recovery, SurvivesErrorsOfAnOpenDeviceOnlyIfItIsLostOrOutOfMemory) {
    Recovery recovery;
    EXPECT_THROW(recovery.survives(OTHER, true, 0), Error);
    EXPECT_TRUE(recovery.survives(LOST, true, 0));
    EXPECT_TRUE(recovery.survives(OTHER, false, 0));  // While it is being opened.
    EXPECT_EQ(recovery.cause().what(), std::string("it is lost"));
}

}  // namespace
}  // namespace candela
