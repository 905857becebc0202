// Merging parts: means and variances are those of all samples, in any order of the files, and what does not
// belong together is refused.
#include "film/merge.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include <gtest/gtest.h>

#include "base/image_io.h"
#include "base_fixture.h"
#include "film/identity.h"
#include "film/sample_range.h"
#include "probe/random.h"

namespace candela {
namespace {

constexpr double U = 0x1p-24;  // The relative error of rounding to a float.

// Samples of one channel at one pixel, and what a part says of them, with one rounding to float each.
struct Samples {
    std::vector<double> values;

    double mean() const {
        double sum = 0.0;
        for (const double value : values)
            sum += value;
        return values.empty() ? 0.0 : sum / double(values.size());
    }
    double variance_of_mean() const {
        const double n = double(values.size());
        double squares = 0.0;
        for (const double value : values)
            squares += (value - mean()) * (value - mean());
        return n < 2 ? double(INFINITE) : squares / (n * (n - 1.0));
    }
};

constexpr PixelRect CROP{10, 20, 13, 22};
constexpr size_t PIXELS = 6;
constexpr const char* MEANS[] = {"R", "G", "B", "A", "N.X"};

// One part: for each of MEANS, six pixels' samples.
struct PartSamples {
    SampleRange range;
    std::array<std::array<Samples, PIXELS>, 5> of;
};

class Merge : public testing::Test {
  protected:
    // Pixel i holds the samples of the range but the last i * missing of them. R varies much, G around 100 by
    // 1 %, B not at all; A is 0 or 1, N.X of either sign.
    PartSamples samples_of(SampleRange range, uint32_t missing = 0) {
        PartSamples part{.range = range, .of = {}};
        for (size_t i = 0; i < PIXELS; ++i) {
            const uint32_t lost = std::min(range.count(), uint32_t(i) * missing);
            for (uint32_t n = range.first; n < range.end - lost; ++n) {
                part.of[0][i].values.push_back(std::exp(8.0 * double(random_.unit())));
                part.of[1][i].values.push_back(100.0 + double(random_.unit()));
                part.of[2][i].values.push_back(0.1);
                part.of[3][i].values.push_back(random_.unit() < 0.5f ? 0.0 : 1.0);
                part.of[4][i].values.push_back(2.0 * double(random_.unit()) - 1.0);
            }
        }
        return part;
    }
    static Image image_of(const PartSamples& samples) {
        Image image{.full = uvec2(40, 30), .data = CROP, .channels = {}, .attributes = {}};
        for (size_t c = 0; c < 5; ++c) {
            Channel& channel = image.add(MEANS[c]);
            for (size_t i = 0; i < PIXELS; ++i)
                channel.values[i] = float(samples.of[c][i].mean());
        }
        for (size_t c = 0; c < 3; ++c) {
            Channel& channel = image.add(std::string("Variance.") + MEANS[c]);
            for (size_t i = 0; i < PIXELS; ++i)
                channel.values[i] = float(samples.of[c][i].variance_of_mean());
        }
        Channel& count = image.add("SampleCount.V");
        Channel& depth = image.add("Z");
        size_t least = SIZE_MAX;
        for (size_t i = 0; i < PIXELS; ++i) {
            const size_t n = samples.of[0][i].values.size();
            count.values[i] = float(n);
            depth.values[i] = 1.0f + float(i);
            least = std::min(least, n);
        }
        Identity identity{.settings = {"40x30", "10,20,13,22", "7", "sobol", "mis", "4096", "3", "at 1 2 3"},
                          .hash = 0x123456789abcdef0u};
        set_identity(image, identity);
        set_maker(image, {.device = "GPU", .driver = "1.2", .version = "0.1"});
        image.attributes["candela.samples"] = to_text({&samples.range, 1});
        image.attributes["samplesPerPixel"] = float(least);
        image.attributes["renderTimeSeconds"] = 2.0f;
        return image;
    }
    std::filesystem::path write(const std::string& name, const Image& image) const {
        write_exr(folder_ / name, image);
        return folder_ / name;
    }
    std::filesystem::path write(const std::string& name, SampleRange range, uint32_t missing = 0) {
        return write(name, image_of(samples_of(range, missing)));
    }
    // The same part after a change to its image.
    std::filesystem::path write_changed(const std::string& name, SampleRange range,
                                        const std::function<void(Image&)>& change) {
        Image image = image_of(samples_of(range));
        change(image);
        return write(name, image);
    }
    // The message without the folder of the files.
    std::string text(std::string message) const {
        const std::string prefix = folder_.path().string() + "/";
        for (size_t at; (at = message.find(prefix)) != std::string::npos;)
            message.erase(at, prefix.size());
        return message;
    }
    std::string refusal(const std::vector<std::filesystem::path>& files) const {
        return text(error_of([&] { merge_files(files); }));
    }
    std::vector<std::string> warnings(const std::vector<std::filesystem::path>& files) const {
        std::vector<std::string> result = merge_files(files).warnings;
        for (std::string& warning : result)
            warning = text(warning);
        return result;
    }

    TemporaryDirectory folder_;
    Random random_{5};
};

bool same_bits(const Image& a, const Image& b) {
    return std::ranges::equal(a.channels, b.channels, [](const Channel& x, const Channel& y) {
        return x.name == y.name &&
               std::memcmp(x.values.data(), y.values.data(), x.values.size() * sizeof(float)) == 0;
    });
}

// Against two passes over all samples in double precision, within the bounds of part_sum.h. Some pixels of
// some parts hold no sample or a single one.
TEST_F(Merge, MeansAndVariancesAreThoseOfAllSamples) {
    const std::vector<PartSamples> parts = {samples_of({0, 64}), samples_of({64, 67}, 1),
                                            samples_of({67, 68}), samples_of({68, 1000}, 100)};
    std::vector<std::filesystem::path> files;
    for (size_t k = 0; k < parts.size(); ++k)
        files.push_back(write(std::to_string(k) + ".exr", image_of(parts[k])));
    const Image merged = merge_files(files).image;
    EXPECT_EQ(merged.full, uvec2(40, 30));
    EXPECT_EQ(merged.data, CROP);
    for (size_t c = 0; c < 5; ++c) {
        for (size_t i = 0; i < PIXELS; ++i) {
            Samples all;
            double largest = 0.0, absolute = 0.0;
            long double stored = 0.0L;
            for (const PartSamples& part : parts) {
                const Samples& some = part.of[c][i];
                all.values.insert(all.values.end(), some.values.begin(), some.values.end());
                largest = std::max(largest, std::abs(some.mean()));
                absolute += std::abs(some.mean()) * double(some.values.size());
                stored += (long double)(float(some.mean())) * (long double)(some.values.size());
            }
            const double n = double(all.values.size());
            EXPECT_NEAR(double(merged.find(MEANS[c])->values[i]), all.mean(), 2.0 * U * absolute / n * 1.001)
                << MEANS[c] << ' ' << i;
            // What the files hold is added without further loss, up to the one rounding of the result.
            EXPECT_EQ(merged.find(MEANS[c])->values[i], float(stored / (long double)n));
            EXPECT_EQ(merged.find("SampleCount.V")->values[i], float(n));
            if (c >= 3) continue;
            const double v = all.variance_of_mean();
            const double bound = 3.0 * U * v + 4.0 * U * largest * std::sqrt(v / (n - 1.0)) +
                                 4.0 * U * U * largest * largest / (n - 1.0);
            EXPECT_NEAR(double(merged.find(std::string("Variance.") + MEANS[c])->values[i]), v, bound)
                << MEANS[c] << ' ' << i;
        }
    }
    EXPECT_EQ(merged.find("Z")->values[4], 5.0f);
    EXPECT_EQ(std::get<std::string>(merged.attributes.at("candela.samples")), "0..1000");
    EXPECT_EQ(std::get<float>(merged.attributes.at("samplesPerPixel")), 64.0f + 0 + 1 + 432);
    EXPECT_EQ(std::get<float>(merged.attributes.at("renderTimeSeconds")), 8.0f);
}

TEST_F(Merge, FewSamplesHaveInfiniteVarianceAndNoneAreBlack) {
    const auto a = write("a.exr", {0, 1}, 1), b = write("b.exr", {1, 2}, 1);
    const Image merged = merge_files({a, b}).image;
    EXPECT_TRUE(std::isfinite(merged.find("Variance.R")->values[0]));
    for (size_t i = 1; i < PIXELS; ++i) {
        EXPECT_EQ(merged.find("Variance.R")->values[i], INFINITE);
        EXPECT_EQ(merged.find("R")->values[i], 0.0f);
    }
    EXPECT_EQ(merge_files({a}).image.find("Variance.R")->values[0], INFINITE);
}

// 1e30 swallows what is added to it, so that sums in another order would differ.
TEST_F(Merge, AnyOrderGivesTheSameBits) {
    const auto with_red = [this](const std::string& name, SampleRange range, float red) {
        return write_changed(name, range,
                             [red](Image& image) { image.channels[0].values.assign(PIXELS, red); });
    };
    std::vector<std::filesystem::path> files = {
        with_red("c.exr", {0, 4}, 1e30f), with_red("a.exr", {4, 8}, 1.0f), with_red("d.exr", {8, 12}, -1e30f),
        with_red("b.exr", {20, 24}, 3.0f)};
    const Merged first = merge_files(files);
    EXPECT_EQ(first.image.find("R")->values[0], 0.75f);
    std::ranges::sort(files);
    do {
        const Merged other = merge_files(files);
        EXPECT_TRUE(same_bits(other.image, first.image));
        EXPECT_EQ(other.image.attributes, first.image.attributes);
        EXPECT_EQ(other.warnings, first.warnings);
    } while (std::ranges::next_permutation(files).found);
}

TEST_F(Merge, AMergedImageCanBeMergedAgain) {
    const auto a = write("a.exr", {0, 7}), b = write("b.exr", {7, 9}), c = write("c.exr", {20, 30});
    const Merged ac = merge_files({a, c});
    EXPECT_EQ(std::get<std::string>(ac.image.attributes.at("candela.samples")), "0..7,20..30");
    const auto both = write("ac.exr", ac.image);
    EXPECT_EQ(refusal({both, c}),
              "c.exr: it holds samples 20..30 as ac.exr does; leave one of them out, or render "
              "other samples (--samples)");
    const Image at_once = merge_files({a, b, c}).image;
    const Image again = merge_files({both, b}).image;
    for (size_t i = 0; i < PIXELS; ++i) {
        // Twice the bound of one merge.
        EXPECT_NEAR(again.find("R")->values[i], at_once.find("R")->values[i],
                    4.0 * U * double(at_once.find("R")->values[i]));
    }
    EXPECT_EQ(std::get<std::string>(merge_files({both, b}).image.attributes.at("candela.samples")),
              "0..9,20..30");
}

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
              "b.exr: it has no channel R; give images (-o), no checkpoints or other files");
    for (const float count : {5.0f, -1.0f, 0.5f, NAN}) {
        EXPECT_EQ(
            message([&](Image& image) { image.channels[8].values[3] = count; }),
            "b.exr: its channel SampleCount.V has the value " + std::to_string(count) +
                ", but it says to hold 4 sample(s) per pixel at most; give files as candela wrote them");
    }
    EXPECT_EQ(message([](Image& image) { image.channels[9].values[2] += 1.0f; }),
              "b.exr: its channel Z differs from that of a.exr; give files as candela wrote them");
    EXPECT_EQ(message([](Image& image) {
                  image.channels.erase(image.channels.begin() + 8);
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
            "b.exr holds 16-bit floats: of its digits only three are right; render parts without --half"});
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

TEST_F(Merge, OnlyChannelsOfAllPartsAreKept) {
    const auto a = write("a.exr", {0, 4});
    const auto b = write_changed("b.exr", {4, 8}, [](Image& image) {
        std::erase_if(image.channels,
                      [](const Channel& c) { return c.name == "Z" || c.name == "SampleCount.V"; });
        image.add("Mask");
    });
    const Merged merged = merge_files({a, b});
    std::vector<std::string> warnings = merged.warnings;
    for (std::string& warning : warnings)
        warning = text(warning);
    EXPECT_EQ(warnings,
              (std::vector<std::string>{"the channel Mask is left out: candela does not know how to merge it",
                                        "the channel SampleCount.V is left out: b.exr does not have it",
                                        "the channel Z is left out: b.exr does not have it"}));
    EXPECT_EQ(merged.image.channels.size(), 8u);
    EXPECT_EQ(merged.image.find("Z"), nullptr);
}

TEST_F(Merge, MissingSamplesAreThoseOfNoPart) {
    const auto a = write("a.exr", {4, 8}), b = write("b.exr", {12, 16}), c = write("c.exr", {8, 12}, 1);
    EXPECT_EQ(to_text(missing_samples({b, a}, {0, 20}).samples), "0..4,8..12,16..20");
    EXPECT_TRUE(missing_samples({b, a}, {4, 8}).samples.empty());
    // Of an interrupted part, the samples that all pixels hold count.
    EXPECT_EQ(to_text(missing_samples({b, a, c}, {4, 16}).samples), "8..12");
    const auto d =
        write_changed("d.exr", {8, 12}, [](Image& image) { image.attributes["samplesPerPixel"] = 3.0f; });
    EXPECT_EQ(to_text(missing_samples({b, a, d}, {4, 16}).samples), "11..12");
    ASSERT_EQ(missing_samples({a, c}, {0, 8}).warnings.size(), 1u);
    EXPECT_EQ(text(missing_samples({a, c}, {0, 8}).warnings[0]),
              "c.exr was interrupted: of the samples 8..12 some pixels hold only 0");
    const auto other = write_changed(
        "d.exr", {0, 4}, [](Image& image) { image.attributes["candela.seed"] = std::string("8"); });
    EXPECT_EQ(text(error_of([&] { missing_samples({a, other}, {0, 8}); })), refusal({a, other}));
}

// However many parts there are, only the values of one are in memory, and only merged ones are read.
TEST_F(Merge, ReadsTheValuesOfEachPartOnce) {
    const auto a = write("a.exr", {0, 4});
    const auto b = write_changed("b.exr", {4, 8}, [](Image& image) { image.add("Custom.X", 7.0f); });
    std::vector<std::string> read;
    const auto count = [&](const std::filesystem::path& file, const ImageLimits& limits) {
        read.push_back(file.filename().string());
        EXPECT_TRUE(limits.wants("R") && limits.wants("SampleCount.V"));
        EXPECT_FALSE(limits.wants("Custom.X"));
        return read_exr(file, limits);
    };
    const Merged merged = merge_files({b, a}, {.image = count});
    EXPECT_EQ(read, (std::vector<std::string>{"a.exr", "b.exr"}));
    EXPECT_TRUE(same_bits(merged.image, merge_files({a, b}).image));
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
