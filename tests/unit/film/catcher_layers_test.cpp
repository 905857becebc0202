// The alpha of catchers.
#include "film/catcher_layers.h"

#include <gtest/gtest.h>

namespace candela {
namespace {

struct CatcherPixel {
    float foreground, share;
    vec3 with, without;
    float alpha;  // Expected.
};

// Luminance weighs red, green and blue by 0.2126, 0.7152 and 0.0722.
TEST(CatcherLayers, AlphaIsTheShadowsOverWhatIsBehind) {
    const std::vector<CatcherPixel> pixels = {
        {0.25f, 0.5f, vec3(0.3f), vec3(0.4f), 0.25f + 0.5f * 0.25f},
        {0.0f, 1.0f, vec3(1, 0, 0), vec3(1), 1.0f - 0.2126f},
        {0.5f, 0.5f, vec3(3), vec3(2), 0.5f},  // Brighter than without: clipped.
        {0.5f, 0.5f, vec3(0), vec3(0), 0.5f},  // There is nothing to darken.
        {0.0f, 1.0f, vec3(0), vec3(2), 1.0f},
    };
    Image image{.full = {uint32_t(pixels.size()), 1},
                .data = {0, 0, uint32_t(pixels.size()), 1},
                .channels = {},
                .attributes = {}};
    const auto fill = [&](const char* name, auto value) {
        Channel& channel = image.add(name);
        for (size_t i = 0; i < pixels.size(); ++i)
            channel.values[i] = value(pixels[i]);
    };
    fill(FOREGROUND_ALPHA, [](const CatcherPixel& p) { return p.foreground; });
    fill(CATCHER_ALPHA, [](const CatcherPixel& p) { return p.share; });
    for (int c = 0; c < 3; ++c)
        fill(CATCHER_WITH[size_t(c)], [c](const CatcherPixel& p) { return p.with[c]; });
    set_catcher_alpha(image);
    EXPECT_EQ(image.find("A"), nullptr);  // A layer is missing.
    for (int c = 0; c < 3; ++c)
        fill(CATCHER_WITHOUT[size_t(c)], [c](const CatcherPixel& p) { return p.without[c]; });
    for (int call = 0; call < 2; ++call) {  // Adds the channel, and replaces it.
        set_catcher_alpha(image);
        for (size_t i = 0; i < pixels.size(); ++i)
            EXPECT_NEAR(image.find("A")->values[i], pixels[i].alpha, 1e-6f) << i;
    }
}

}  // namespace
}  // namespace candela
