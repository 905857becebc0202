// Ranges of samples: as text, and joined.
#include "film/sample_range.h"

#include <gtest/gtest.h>

namespace candela {
namespace {

TEST(SampleRange, TextAndBack) {
    for (const std::string text :
         {"0..64", "64..128", "0..0", "0..64,128..192", "0..64,64..65", "0..16777216"}) {
        const auto ranges = parse_ranges(text);
        ASSERT_TRUE(ranges.has_value()) << text;
        EXPECT_EQ(to_text(*ranges), text);
    }
    EXPECT_EQ(*parse_ranges("3..5"), (std::vector<SampleRange>{{3, 5}}));
    EXPECT_EQ(total_count(*parse_ranges("0..64,128..192")), 128u);
}

TEST(SampleRange, AnythingElseIsRefused) {
    for (const std::string text :
         {"", "0", "0..", "..4", "4..0", "0...4", "0..4,", ",0..4", "0..4,2..8", "8..9,0..4", "-1..4",
          "0..16777217", "0..4 ", " 0..4", "0..99999999999", "a..b", "0-4"}) {
        EXPECT_FALSE(parse_ranges(text).has_value()) << text;
    }
}

TEST(SampleRange, RangesThatTouchBecomeOne) {
    EXPECT_EQ(to_text(joined({{64, 128}, {5, 5}, {0, 64}, {200, 201}, {198, 200}})), "0..128,198..201");
    EXPECT_TRUE(joined({{7, 7}}).empty());
}

TEST(SampleRange, GapsAreWhatNoRangeHolds) {
    const std::vector<SampleRange> ranges{{20, 30}, {4, 8}, {8, 9}, {12, 12}};
    EXPECT_EQ(to_text(gaps(ranges, {0, 40})), "0..4,9..20,30..40");
    EXPECT_EQ(to_text(gaps(ranges, {5, 25})), "9..20");
    EXPECT_EQ(to_text(gaps(ranges, {10, 15})), "10..15");
    EXPECT_EQ(to_text(gaps({}, {3, 5})), "3..5");
    EXPECT_TRUE(gaps(ranges, {4, 9}).empty());
    EXPECT_TRUE(gaps(ranges, {22, 25}).empty());
    EXPECT_TRUE(gaps(ranges, {6, 6}).empty());
}

}  // namespace
}  // namespace candela
