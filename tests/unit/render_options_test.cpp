// What the options of `candela render` ask of a renderer.
#include "cli/render_options.h"

#include <gtest/gtest.h>

namespace candela {
namespace {

uint32_t pass_growth(const RenderOptions& options) {
    return options.settings(Scene{}).pass_growth;
}

TEST(RenderOptions, PicturesThatMayBeTakenAtAnyTimeGrowEvenly) {
    RenderOptions options;
    EXPECT_EQ(pass_growth(options), PASS_GROWTH);
    options.write_every = 1.0;
    EXPECT_EQ(pass_growth(options), EVEN_PASS_GROWTH);
    options = RenderOptions{};
    options.time_limit = 1.0;
    EXPECT_EQ(pass_growth(options), EVEN_PASS_GROWTH);
}

}  // namespace
}  // namespace candela
