// Merging parts: means and variances are those of all samples, in any order of the files.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

#include "base/file.h"
#include "unit/film/merge_fixture.h"

namespace candela {
namespace {

constexpr double U = 0x1p-24;  // The relative error of rounding to a float.

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
    // Of all samples of the guides' albedo, and how far the merged variance may be from it.
    std::array<double, PIXELS> variances{}, bounds{};
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
            variances[i] += v;
            bounds[i] += bound + 3.0 * U * v;  // Each part adds up three rounded variances.
        }
    }
    for (size_t i = 0; i < PIXELS; ++i)
        EXPECT_NEAR(double(merged.find("DenoisingAlbedo.V")->values[i]), variances[i], bounds[i]) << i;
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

TEST_F(Merge, OnlyChannelsOfAllPartsAreKept) {
    const auto a = write("a.exr", {0, 4});
    const auto b = write_changed("b.exr", {4, 8}, [](Image& image) {
        std::erase_if(image.channels, [](const Channel& c) {
            return c.name == "Z" || c.name == "SampleCount.V" || c.name == "DenoisingAlbedo.R";
        });
        image.add("Mask");
    });
    const Merged merged = merge_files({a, b});
    std::vector<std::string> warnings = merged.warnings;
    for (std::string& warning : warnings)
        warning = text(warning);
    EXPECT_EQ(warnings,
              (std::vector<std::string>{
                  "the channel \"DenoisingAlbedo.R\" is left out: b.exr does not have it",
                  "the channel \"DenoisingAlbedo.V\" is left out: the channels whose variance it is "
                  "are missing",
                  "the channel \"Mask\" is left out: candela does not know how to merge it",
                  "the channel \"SampleCount.V\" is left out: b.exr does not have it",
                  "the channel \"Z\" is left out: b.exr does not have it"}));
    EXPECT_EQ(merged.image.channels.size(), 10u);
    EXPECT_EQ(merged.image.find("Z"), nullptr);
}

TEST_F(Merge, AFileThatCannotBeReadHoldsNoSamples) {
    const auto a = write("a.exr", {0, 4}), b = write("b.exr", {4, 8});
    const std::string whole = read_file(b);
    std::string zeros = whole;
    std::fill(zeros.end() - 16, zeros.end(), '\0');
    for (const std::string& damaged :
         {whole.substr(0, whole.size() - 1), whole.substr(0, whole.size() / 2), std::string(), zeros}) {
        std::ofstream(b, std::ios::binary) << damaged;
        const Missing missing = missing_samples({b, a}, {0, 8});
        EXPECT_EQ(to_text(missing.samples), "4..8");
        ASSERT_EQ(missing.warnings.size(), 1u);
        EXPECT_TRUE(text(missing.warnings[0]).starts_with("a part is left out: cannot read \"b.exr\": "))
            << missing.warnings[0];
        EXPECT_EQ(to_text(missing_samples({b}, {2, 8}).samples), "2..8");
    }
    EXPECT_EQ(to_text(missing_samples({a, folder_ / "none.exr"}, {0, 8}).samples), "4..8");
}

TEST_F(Merge, MissingSamplesAreThoseOfNoPart) {
    const auto a = write("a.exr", {4, 8}), b = write("b.exr", {12, 16}), c = write("c.exr", {8, 12}, 1);
    EXPECT_EQ(to_text(missing_samples({b, a}, {0, 20}).samples), "0..4,8..12,16..20");
    EXPECT_TRUE(missing_samples({b, a}, {4, 8}).samples.empty());
    // In an interrupted part, only samples that all pixels have are counted.
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

// What depends on no sample is the first part's; another must have the same bits and the same names.
TEST_F(Merge, LayersOfIdsAreThoseOfTheParts) {
    const auto with_ids = [](float id, const char* names) {
        return [=](Image& image) {
            for (const char* name : {"ObjectId.V", "CryptoObject00.R", "Depth.V"})
                image.add(name, id);
            image.attributes["candela.ids"] = names;
            image.attributes["cryptomatte/3ae39a5/manifest"] = names;
        };
    };
    const auto a = write_changed("a.exr", {0, 4}, with_ids(2.5e-20f, "ball"));
    const auto b = write_changed("b.exr", {4, 9}, with_ids(2.5e-20f, "ball"));
    const Image image = merge_files({a, b}).image;
    for (const char* name : {"ObjectId.V", "CryptoObject00.R", "Depth.V"})
        EXPECT_EQ(image.find(name)->values, std::vector<float>(PIXELS, 2.5e-20f)) << name;
    EXPECT_EQ(std::get<std::string>(image.attributes.at("candela.ids")), "ball");

    const auto other = write_changed("c.exr", {4, 9}, with_ids(1.0f, "ball"));
    EXPECT_EQ(
        refusal({a, other}),
        "c.exr: its channel CryptoObject00.R differs from that of a.exr; give files as candela wrote them");
    const auto renamed = write_changed("d.exr", {4, 9}, with_ids(2.5e-20f, "egg"));
    EXPECT_EQ(refusal({a, renamed}),
              "d.exr: it calls objects or materials by other names or numbers than a.exr (the attribute "
              "candela.ids); merge parts of one rendering");

    const Image without = merge_files({a, write("e.exr", {4, 9})}).image;
    EXPECT_EQ(without.find("ObjectId.V"), nullptr);
    EXPECT_FALSE(without.attributes.contains("candela.ids"));
    EXPECT_FALSE(without.attributes.contains("cryptomatte/3ae39a5/manifest"));
}

}  // namespace
}  // namespace candela
