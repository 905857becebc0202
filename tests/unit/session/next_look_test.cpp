// The numbers of samples at which the error of a rendering is measured.
#include "session/next_look.h"

#include <gtest/gtest.h>

#include "film/sample_range.h"

namespace candela {
namespace {

TEST(NextLook, IsAtTheNextPowerOfTwo) {
    EXPECT_EQ(next_look(0, 1000), 1u);
    EXPECT_EQ(next_look(1, 1000), 2u);
    EXPECT_EQ(next_look(16, 1000), 32u);
    EXPECT_EQ(next_look(33, 1000), 64u);
    EXPECT_EQ(next_look(MAX_SPP / 2, MAX_SPP), MAX_SPP);
}

TEST(NextLook, IsNotBeforeTheFirstNorBeyondTheTarget) {
    EXPECT_EQ(next_look(0, 1000, 8), 8u);
    EXPECT_EQ(next_look(3, 1000, 8), 8u);
    EXPECT_EQ(next_look(8, 1000, 8), 16u);
    EXPECT_EQ(next_look(0, 3, 8), 3u);
    EXPECT_EQ(next_look(512, 1000), 1000u);
}

}  // namespace
}  // namespace candela
