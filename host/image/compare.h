// Comparison of two renderings of one picture: how much they differ, and whether noise alone explains it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "image/image.h"

namespace candela {

struct CompareOptions {
    // Probability, in (0, 1), with which each of the three z-tests may reject two images of the same
    // expectation.
    double alpha = 0.01;
    // If given, the images pass when relmse is at most this, regardless of the z-tests.
    std::optional<double> relmse = std::nullopt;
};

// The limit of relmse if there are neither variances nor CompareOptions::relmse.
inline constexpr double DEFAULT_RELMSE = 1e-3;
// Fraction of pixels that must pass. Not all: estimates of the variance from few samples have heavy tails.
inline constexpr double REQUIRED_PIXEL_FRACTION = 0.9975;
// Edge of the square blocks whose means are tested, in pixels; those at the right and lower edges may be
// smaller.
inline constexpr uint32_t COMPARE_BLOCK = 8;

// The largest deviation among the pixels, the blocks or the image means.
struct WorstDeviation {
    double z = 0.0;  // (a - b) / sqrt(var_a + var_b), signed; infinite where values differ without variance.
    double critical = 0.0;  // The |z| that a deviation may reach: the level alpha, Sidak-corrected.
    char channel = 'R';     // R, G or B.
    PixelRect place;        // In the whole picture.

    bool passed() const { return !(z > critical || z < -critical); }
};

struct ZTests {
    double passing_pixels = 0.0;  // Fraction of the pixels with all channels within pixel.critical.
    WorstDeviation pixel;
    WorstDeviation block;
    WorstDeviation mean;

    bool passed() const {
        return passing_pixels >= REQUIRED_PIXEL_FRACTION && block.passed() && mean.passed();
    }
};

struct Comparison {
    double relmse = 0.0;          // Mean over pixels and channels of (a - b)^2 / (b^2 + 0.01).
    std::optional<ZTests> tests;  // If both images have variances.
    bool passed = false;
};

// Compares the channels R, G and B of `a` with those of the reference `b`. Where both images have the
// channels Variance.R, .G and .B (variance of the pixel's mean), it also tests pixels, block means and image
// means, and these tests decide; else, or if options.relmse is given, relmse decides. Throws Error if the
// images differ in size or crop, lack a channel, or hold a value that is not finite or a negative variance.
Comparison compare(const Image& a, const Image& b, const CompareOptions& options = {});

// A picture of the differences: red, green and blue bytes of the colours of the map "inferno" from black to
// pale yellow, row-major, 3 * pixel_count(). Where z-tests decide, it shows the largest |z| of each pixel,
// linear from 0 to the critical value or more; else the mean relative squared error of each pixel,
// logarithmic from 1e-6 or less to 1 or more. Throws Error as compare() does.
std::vector<uint8_t> heatmap(const Image& a, const Image& b, const CompareOptions& options = {});

}  // namespace candela
