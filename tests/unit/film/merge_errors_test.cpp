// Merging parts: what does not belong together is refused, and what is odd is a warning.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "unit/film/merge_fixture.h"

namespace candela {
namespace {

TEST_F(Merge, OverlapsAreRefused) {
    const auto a = write("a.exr", {0, 64}), b = write("b.exr", {32, 96}), c = write("c.exr", {63, 64});
    const std::string remedy = " does; leave one of them out, or render other samples (--samples)";
    EXPECT_EQ(refusal({b, a}), "b.exr: it holds samples 32..64 as a.exr" + remedy);
    EXPECT_EQ(refusal({c, a}), "c.exr: it holds samples 63..64 as a.exr" + remedy);
    EXPECT_EQ(refusal({a, a}), "a.exr: it holds samples 0..64 as a.exr" + remedy);
}

TEST_F(Merge, WhatIsNoPartIsRefused) {
    const auto a = write("a.exr", {0, 4});
    const auto message = [&](const std::function<void(Image&)>& change) {
        return refusal({a, write_changed("b.exr", {4, 8}, change)});
    };
    const std::string unchanged = "; give a file that candela render wrote, unchanged";
    for (const char* attribute : {"candela.identity", "candela.samples", "candela.device"}) {
        EXPECT_EQ(message([&](Image& image) { image.attributes.erase(attribute); }),
                  std::string("b.exr: the attribute ") + attribute + " is missing" + unchanged);
    }
    EXPECT_EQ(message([](Image& image) { image.attributes["candela.samples"] = std::string("4-8"); }),
              "b.exr: the attribute candela.samples is \"4-8\"" + unchanged);
    EXPECT_EQ(message([](Image& image) { image.channels.erase(image.channels.begin()); }),
              "b.exr: it has no channel R; give images (-o), not checkpoints or other files");
    for (const float count : {5.0f, -1.0f, 0.5f, NAN}) {
        EXPECT_EQ(
            message([&](Image& image) { image.channels[COUNT].values[3] = count; }),
            "b.exr: its channel SampleCount.V has the value " + std::to_string(count) +
                ", but it says to hold 4 sample(s) per pixel at most; give files as candela wrote them");
    }
    EXPECT_EQ(message([](Image& image) { image.channels[Z].values[2] += 1.0f; }),
              "b.exr: its channel Z differs from that of a.exr; give files as candela wrote them");
    EXPECT_EQ(message([](Image& image) {
                  image.channels.erase(image.channels.begin() + COUNT);
                  image.attributes["samplesPerPixel"] = 3.0f;
              }),
              "b.exr: its pixels hold different numbers of samples, and it has no channel SampleCount.V to "
              "tell them; "
              "render such parts with --aov samples among others");
    EXPECT_NE(refusal({a, folder_ / "none.exr"}).find("the file does not exist"), std::string::npos);
}

TEST_F(Merge, PartsOfAnotherRenderingAreRefused) {
    const auto a = write("a.exr", {0, 4});
    const auto message = [&](const std::function<void(Image&)>& change) {
        return refusal({write_changed("b.exr", {4, 8}, change), a});
    };
    const std::string begin = "b.exr: it does not belong with a.exr: ",
                      end = "; merge parts of one rendering";
    EXPECT_EQ(message([](Image& image) { image.attributes["candela.seed"] = std::string("8"); }),
              begin + "its seed is 8, not 7" + end);
    EXPECT_EQ(message([](Image& image) { image.attributes["candela.identity"] = std::string("1"); }),
              begin + "it shows another scene, or another version of it" + end);
    EXPECT_EQ(message([](Image& image) { image.full.x = 41; }), begin + "its size is 41x30, not 40x30" + end);
}

TEST_F(Merge, OddPartsAreWarnings) {
    const auto a = write("a.exr", {0, 4});
    EXPECT_EQ(warnings({a, write("b.exr", {4, 8})}), std::vector<std::string>{});
    EXPECT_EQ(warnings({a, write("b.exr", {6, 8}), write("c.exr", {9, 10})}),
              std::vector<std::string>{"the samples 4..6,8..9 are missing: no part holds them"});
    EXPECT_EQ(warnings({write("b.exr", {2, 8})}),
              std::vector<std::string>{"the samples 0..2 are missing: no part holds them"});
    EXPECT_EQ(
        warnings({a, write("b.exr", {4, 20}, 2)}),
        std::vector<std::string>{"b.exr was interrupted: of the samples 4..20 some pixels hold only 6"});
    EXPECT_EQ(
        warnings({a, write_changed("b.exr", {4, 8}, [](Image& image) { image.channels[0].half = true; })}),
        std::vector<std::string>{
            "b.exr holds 16-bit floats: only three of its digits are right; render parts without --half"});
    // Another device rounds positions differently.
    const auto other = write_changed("b.exr", {4, 8}, [](Image& image) {
        image.attributes["candela.driver"] = std::string("2");
        image.channels[9].values[2] += 0x1p-20f;
    });
    EXPECT_EQ(warnings({a, other}),
              std::vector<std::string>{"b.exr was made by GPU, driver 2, candela 0.1, but a.exr "
                                       "by GPU, driver 1.2, candela 0.1"});
    const Image merged = merge_files({other, a}).image;
    EXPECT_EQ(std::get<std::string>(merged.attributes.at("candela.device")), "GPU");
    EXPECT_EQ(std::get<std::string>(merged.attributes.at("candela.driver")), "1.2; 2");
    EXPECT_EQ(merged.find("Z")->values[2], 3.0f);
}

TEST_F(Merge, APartThatChangesInBetweenIsRefused) {
    const auto a = write("a.exr", {0, 4}), b = write("b.exr", {4, 8});
    const auto replace = [&](const std::filesystem::path& file, const ImageLimits& limits) {
        if (file == a) write("b.exr", {8, 12});
        return read_exr(file, limits);
    };
    EXPECT_EQ(text(error_of([&] {
                  merge_files({a, b}, {.image = replace});
              })),
              "b.exr: it was changed while it was merged; merge again");
}

}  // namespace
}  // namespace candela
