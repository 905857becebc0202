// The accumulation state on the host: what a renderer has gathered so far, and the image that it makes.
#pragma once

#include <array>
#include <vector>

#include "base/image.h"
#include "shared/constants.h"

namespace candela {

// What the device counted while it rendered.
struct RenderCounters {
    uint64_t rays = 0;
    uint64_t nonfinite_samples = 0;  // Samples that were not finite and added nothing.
    uint64_t depth_limit_hits = 0;   // Paths cut at DEPTH_SAFETY_LIMIT.

    bool operator==(const RenderCounters&) const = default;
};

// Sums of samples per pixel, exactly as the device holds them: layers (LAYER_*) of `rect`, each row-major
// RGBA.
struct Accumulation {
    uvec2 full{0, 0};  // Pixels of the whole picture ...
    PixelRect rect;    // ... and the part of it that is held here.
    uint32_t seed = 0;
    uint32_t first_sample = 0;                  // Index of each pixel's first sample.
    uint32_t layer_count = LAYER_COUNT_COLOUR;  // LAYER_COUNT_COLOUR or LAYER_COUNT_AOVS.
    std::vector<float> values;
    RenderCounters counters{};  // Of all the work that went into it.

    size_t pixel_count() const { return size_t(rect.width()) * rect.height(); }
    // RGBA of a layer at pixel i of `rect`.
    const float* at(uint32_t layer, size_t i) const { return &values[(layer * pixel_count() + i) * 4]; }
    uint32_t sample_count(size_t i) const { return uint32_t(at(LAYER_L_COMPENSATION, i)[3]); }
    // All samples of all pixels.
    uint64_t total_samples() const;
    // The samples of the pixel that holds fewest, and of the one that holds most.
    uint32_t least_samples() const;
    uint32_t most_samples() const;
};

// Which images beside R G B A.
struct AovSelection {
    bool albedo = false;        // Albedo.R/G/B: mean albedo of the first hit.
    bool normal = false;        // N.X/Y/Z: mean shading normal of the first hit, world space.
    bool position = false;      // P.X/Y/Z: what the pinhole ray through the pixel centre meets [m].
    bool depth = false;         // Z: its distance along the view axis [m]; infinity where it meets nothing.
    bool variance = false;      // Variance.R/G/B of the pixel mean; infinity below two samples.
    bool sample_count = false;  // SampleCount.V.

    bool operator==(const AovSelection&) const = default;
    // The accumulation needs LAYER_COUNT_AOVS.
    bool needs_layers() const { return albedo || normal; }
    bool needs_positions() const { return position || depth; }
};

// The image of the state: means over each pixel's own samples, in double precision; 0 where there are none. A
// is the share of camera rays that hit something visible. `positions` holds x, y, z, depth per pixel,
// row-major; may be empty if the selection does not ask for it.
Image make_image(const Accumulation& state, const AovSelection& aovs, const std::vector<float>& positions);

// FNV-1a (64 bits) of the float R, G, B of the image, pixel by pixel, row-major.
uint64_t image_hash(const Image& image);

}  // namespace candela
