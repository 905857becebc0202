// What the tests of merging share: parts of a rendering whose samples are known.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "film/identity.h"
#include "film/merge.h"
#include "film/sample_range.h"
#include "image/image_io.h"
#include "probe/random.h"
#include "unit/base/base_fixture.h"

namespace candela {

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

inline constexpr PixelRect CROP{10, 20, 13, 22};
inline constexpr size_t PIXELS = 6;
inline constexpr const char* MEANS[] = {"R", "G", "B", "A", "N.X"};
inline constexpr size_t COUNT = 12, Z = 13;  // The channels SampleCount.V and Z of a part.

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
        // The guides of denoisers have the same samples.
        Channel variance{.name = "DenoisingAlbedo.V", .values = std::vector<float>(PIXELS, 0.0f)};
        for (size_t c = 0; c < 3; ++c) {
            const std::vector<float> means = image.channels[c].values;
            image.add(std::string("DenoisingAlbedo.") + MEANS[c]).values = means;
            for (size_t i = 0; i < PIXELS; ++i)
                variance.values[i] += float(samples.of[c][i].variance_of_mean());
        }
        image.channels.push_back(variance);
        Channel& count = image.add("SampleCount.V");
        Channel& depth = image.add("Z");
        size_t min = SIZE_MAX;
        for (size_t i = 0; i < PIXELS; ++i) {
            const size_t n = samples.of[0][i].values.size();
            count.values[i] = float(n);
            depth.values[i] = 1.0f + float(i);
            min = std::min(min, n);
        }
        Identity identity{.settings = {"40x30", "10,20,13,22", "7", "sobol", "mis", "4096", "3", "at 1 2 3"},
                          .hash = 0x123456789abcdef0u};
        set_identity(image, identity);
        set_maker(image, {.device = "GPU", .driver = "1.2", .version = "0.1"});
        image.attributes["candela.samples"] = to_text({&samples.range, 1});
        image.attributes["samplesPerPixel"] = float(min);
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
        const std::string prefix = (folder_.path() / "").string();
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

}  // namespace candela
