// MurmurHash3, against values that other implementations give.
#include "base/murmur_hash.h"

#include <gtest/gtest.h>

namespace candela {
namespace {

TEST(MurmurHash, HasTheValuesOfOtherImplementations) {
    EXPECT_EQ(murmur3_32(""), 0u);
    EXPECT_EQ(murmur3_32("a"), 0x3C2569B2u);
    EXPECT_EQ(murmur3_32("abc"), 0xB3DD93FAu);
    EXPECT_EQ(murmur3_32("test"), 0xBA6BD213u);
    EXPECT_EQ(murmur3_32("Hello, world!"), 0xC0363E43u);
    EXPECT_EQ(murmur3_32("The quick brown fox jumps over the lazy dog"), 0x2E4FF723u);
    EXPECT_EQ(murmur3_32("W\xC3\xBCrfel"), 0xC959A2B5u);  // Bytes above 127.
}

}  // namespace
}  // namespace candela
