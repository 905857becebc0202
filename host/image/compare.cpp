// Comparison of two images, pixel by pixel and block by block; every sum is a double.
#include "image/compare.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/statistics.h"

namespace candela {
namespace {

constexpr std::string_view CHANNELS = "RGB";

// Difference and variance of one value, or sums of them over some pixels.
struct Deviation {
    double difference = 0.0;
    double variance = 0.0;

    Deviation& operator+=(const Deviation& other) {
        difference += other.difference;
        variance += other.variance;
        return *this;
    }
    // The same for sums and for means: both parts of the fraction scale with the number of pixels.
    double z() const {
        if (difference == 0.0) return 0.0;
        return variance > 0.0 ? difference / std::sqrt(variance)
                              : std::copysign(std::numeric_limits<double>::infinity(), difference);
    }
};

std::string describe(uvec2 size) {
    return std::to_string(size.x) + 'x' + std::to_string(size.y);
}

std::string describe(const PixelRect& rect) {
    return std::to_string(rect.x0) + ',' + std::to_string(rect.y0) + ',' + std::to_string(rect.x1) + ',' +
           std::to_string(rect.y1);
}

RgbPlanes find_planes(const Image& image, char name) {
    if (const std::optional<RgbPlanes> planes = image.find_rgb()) return *planes;
    std::string present;
    for (const Channel& channel : image.channels)
        present += (present.empty() ? "" : ", ") + channel.name;
    throw Error(std::string("cannot compare: image ") + name +
                " lacks a channel R, G or B (it has: " + (present.empty() ? "none" : present) + ')');
}

// Throws Error if a value is not finite or, for a variance, negative.
void check_values(const Image& image, char name, const RgbPlanes& planes, bool variance) {
    for (size_t c = 0; c < 3; ++c) {
        const auto bad = std::ranges::find_if(
            planes[c], [variance](float v) { return !std::isfinite(v) || (variance && v < 0.0f); });
        if (bad == planes[c].end()) continue;
        const size_t i = size_t(bad - planes[c].begin());
        const size_t x = image.data.x0 + i % image.data.width();
        const size_t y = image.data.y0 + i / image.data.width();
        throw Error(std::string("cannot compare: image ") + name + ", channel \"" +
                    (variance ? "Variance." : "") + CHANNELS[c] + "\" is " + std::to_string(*bad) +
                    " at pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                    "); render it again without non-finite samples");
    }
}

// Two images that have been checked to be comparable, and quantities of each pixel.
class Pair {
  public:
    Pair(const Image& a, const Image& b) : data_(a.data) {
        if (a.full != b.full) {
            throw Error("cannot compare: image A has " + describe(a.full) + " pixels, image B " +
                        describe(b.full) + "; render both at one size");
        }
        if (a.data != b.data) {
            throw Error("cannot compare: image A is the crop " + describe(a.data) + ", image B the crop " +
                        describe(b.data) + " (x0,y0,x1,y1); render both with one crop");
        }
        if (a.pixel_count() == 0) throw Error("cannot compare: the images have no pixels");
        a_ = find_planes(a, 'A');
        b_ = find_planes(b, 'B');
        check_values(a, 'A', a_, false);
        check_values(b, 'B', b_, false);
        const std::optional<RgbPlanes> variance_a = a.find_rgb("Variance");
        const std::optional<RgbPlanes> variance_b = b.find_rgb("Variance");
        if (!variance_a || !variance_b) return;
        has_variance_ = true;
        variance_a_ = *variance_a;
        variance_b_ = *variance_b;
        check_values(a, 'A', variance_a_, true);
        check_values(b, 'B', variance_b_, true);
    }

    const PixelRect& data() const { return data_; }
    size_t pixel_count() const { return a_[0].size(); }
    bool has_variance() const { return has_variance_; }

    double relative_squared_error(size_t c, size_t i) const {
        constexpr double DARKEST = 0.01;  // Keeps the error of black pixels finite.
        const double reference = b_[c][i];
        const double difference = a_[c][i] - reference;
        return difference * difference / (reference * reference + DARKEST);
    }
    // Only if has_variance().
    Deviation deviation(size_t c, size_t i) const {
        return {double(a_[c][i]) - b_[c][i], double(variance_a_[c][i]) + variance_b_[c][i]};
    }
    double critical_z(double alpha) const { return normal_critical_z(sidak_level(alpha, 3 * pixel_count())); }

  private:
    PixelRect data_;
    bool has_variance_ = false;
    RgbPlanes a_;
    RgbPlanes b_;
    RgbPlanes variance_a_;
    RgbPlanes variance_b_;
};

void keep_worst(WorstDeviation& worst, double z, size_t c, const PixelRect& place) {
    if (std::abs(z) > std::abs(worst.z)) {
        worst.z = z;
        worst.channel = CHANNELS[c];
        worst.place = place;
    }
}

// Tests the pixels of one block and its means. Returns the number of pixels that pass, and adds to the sums
// of the image.
size_t test_block(const Pair& pair, const PixelRect& block, ZTests& tests,
                  std::array<Deviation, 3>& image_sums) {
    const PixelRect& data = pair.data();
    std::array<Deviation, 3> sums;
    size_t passing = 0;
    for (uint32_t y = block.y0; y < block.y1; ++y) {
        for (uint32_t x = block.x0; x < block.x1; ++x) {
            const size_t i = size_t(y - data.y0) * data.width() + (x - data.x0);
            bool passes = true;
            for (size_t c = 0; c < 3; ++c) {
                const Deviation deviation = pair.deviation(c, i);
                const double z = deviation.z();
                passes = passes && std::abs(z) <= tests.pixel.critical;
                keep_worst(tests.pixel, z, c, {x, y, x + 1, y + 1});
                sums[c] += deviation;
            }
            passing += passes ? 1 : 0;
        }
    }
    for (size_t c = 0; c < 3; ++c) {
        keep_worst(tests.block, sums[c].z(), c, block);
        image_sums[c] += sums[c];
    }
    return passing;
}

ZTests run_tests(const Pair& pair, double alpha) {
    const PixelRect& data = pair.data();
    const auto blocks = [](uint32_t pixels) {
        return (uint64_t(pixels) + COMPARE_BLOCK - 1) / COMPARE_BLOCK;
    };
    ZTests tests;
    tests.pixel.critical = pair.critical_z(alpha);
    tests.block.critical =
        normal_critical_z(sidak_level(alpha, 3 * blocks(data.width()) * blocks(data.height())));
    tests.mean.critical = normal_critical_z(sidak_level(alpha, 3));
    for (WorstDeviation* worst : {&tests.pixel, &tests.block, &tests.mean})
        worst->place = data;

    std::array<Deviation, 3> sums;
    size_t passing = 0;
    for (uint32_t y = data.y0; y < data.y1; y += COMPARE_BLOCK) {
        for (uint32_t x = data.x0; x < data.x1; x += COMPARE_BLOCK) {
            const PixelRect block{x, y, std::min(x + COMPARE_BLOCK, data.x1),
                                  std::min(y + COMPARE_BLOCK, data.y1)};
            passing += test_block(pair, block, tests, sums);
        }
    }
    for (size_t c = 0; c < 3; ++c)
        keep_worst(tests.mean, sums[c].z(), c, data);
    tests.passing_pixels = double(passing) / double(pair.pixel_count());
    return tests;
}

// Colour of the map "inferno" at t in [0, 1].
// Ref: van der Walt, Smith, matplotlib's colour maps (2015); polynomials after Zucker,
// https://www.shadertoy.com/view/WlfXRN (2019).
std::array<uint8_t, 3> inferno(double t) {
    constexpr std::array<std::array<double, 7>, 3> POLYNOMIALS = {{
        {0.0002189403691192265, 0.1065134194856116, 11.60249308247187, -41.70399613139459, 77.162935699427,
         -71.31942824499214, 25.13112622477341},
        {0.001651004631001012, 0.5639564367884091, -3.972853965665698, 17.43639888205313, -33.40235894210092,
         32.62606426397723, -12.24266895238567},
        {-0.01948089843709184, 3.932712388889277, -15.9423941062914, 44.35414519872813, -81.80730925738993,
         73.20951985803202, -23.07032500287172},
    }};
    std::array<uint8_t, 3> colour;
    for (size_t c = 0; c < 3; ++c) {
        double value = 0.0;
        for (size_t k = 7; k-- > 0;)
            value = value * t + POLYNOMIALS[c][k];
        colour[c] = uint8_t(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
    }
    return colour;
}

// Position of pixel i on the scale of the heatmap, in [0, 1].
double z_on_scale(const Pair& pair, size_t i, double critical) {
    double largest = 0.0;
    for (size_t c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(pair.deviation(c, i).z()));
    return std::min(largest / critical, 1.0);
}

double error_on_scale(const Pair& pair, size_t i) {
    constexpr double DECADES = 6.0;
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c)
        sum += pair.relative_squared_error(c, i);
    return std::clamp(1.0 + std::log10(sum / 3.0) / DECADES, 0.0, 1.0);
}

}  // namespace

Comparison compare(const Image& a, const Image& b, const CompareOptions& options) {
    assert(options.alpha > 0.0 && options.alpha < 1.0);
    const Pair pair(a, b);
    Comparison result;
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < pair.pixel_count(); ++i)
            result.relmse += pair.relative_squared_error(c, i);
    }
    result.relmse /= 3.0 * double(pair.pixel_count());
    if (pair.has_variance()) result.tests = run_tests(pair, options.alpha);
    if (result.tests && !options.relmse) {
        result.passed = result.tests->passed();
    } else {
        result.passed = result.relmse <= options.relmse.value_or(DEFAULT_RELMSE);
    }
    return result;
}

std::vector<uint8_t> heatmap(const Image& a, const Image& b, const CompareOptions& options) {
    const Pair pair(a, b);
    const bool shows_z = pair.has_variance() && !options.relmse;
    const double critical = pair.critical_z(options.alpha);
    std::vector<uint8_t> bytes;
    bytes.reserve(3 * pair.pixel_count());
    for (size_t i = 0; i < pair.pixel_count(); ++i) {
        const double t = shows_z ? z_on_scale(pair, i, critical) : error_on_scale(pair, i);
        const std::array<uint8_t, 3> colour = inferno(t);
        bytes.insert(bytes.end(), colour.begin(), colour.end());
    }
    return bytes;
}

}  // namespace candela
