// The accumulation state on the host: the sums of samples so far, and the image made from them.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "image/image.h"
#include "shared/constants.h"

namespace candela {

// Counters of the device.
struct RenderCounters {
    uint64_t rays = 0;
    uint64_t nonfinite_samples = 0;  // Samples that were not finite and added nothing.
    uint64_t depth_limit_hits = 0;   // Paths cut at DEPTH_SAFETY_LIMIT.

    bool operator==(const RenderCounters&) const = default;
};

// Sums of samples per pixel, exactly as the device holds them: layers (LAYER_*) of `rect`, each row-major
// RGBA.
struct Accumulation {
    uvec2 full{0, 0};  // Size of the whole picture [pixels].
    PixelRect rect;    // The part of the picture that is held here.
    uint32_t seed = 0;
    uint32_t first_sample = 0;                  // Index of each pixel's first sample.
    uint32_t layer_count = LAYER_COUNT_COLOUR;  // LAYER_COUNT_*, and LAYER_COUNT_GUIDES
    uint32_t denoising_layer = 0;               // if there are guides: the first layer of theirs; else 0.
    std::vector<float> values;                  // Empty if no pixel has a sample or a limit.
    RenderCounters counters{};                  // Totals for all of the samples.

    size_t pixel_count() const { return size_t(rect.width()) * rect.height(); }
    // RGBA of a layer at pixel i of `rect`.
    const float* at(uint32_t layer, size_t i) const { return &values[(layer * pixel_count() + i) * 4]; }
    // LAYER_COUNT_*
    uint32_t layers_before_guides() const { return denoising_layer != 0 ? denoising_layer : layer_count; }
    uint32_t sample_count(size_t i) const {
        return values.empty() ? 0 : uint32_t(at(LAYER_L_COMPENSATION, i)[3]);
    }
    // The average number of rays of a sample of pixel i.
    double rays_per_sample(size_t i) const {
        return double(at(LAYER_SQUARE_COMPENSATION, i)[3]) / std::max(1u, sample_count(i));
    }
    // The most samples that pixel i may get, below 2^24; UINT32_MAX if it has no limit.
    uint32_t limit(size_t i) const;
    void set_limit(size_t i, uint32_t samples);
    // The samples of all pixels together.
    uint64_t total_samples() const;
    // The fewest and the most samples that a pixel holds.
    uint32_t min_samples() const;
    uint32_t max_samples() const;
};

// `states` below are one state; or two, whose samples are combined; or four, for the two halves of an
// adaptive rendering: the samples of each pair are combined, and the image is the unweighted mean of the
// halves.

struct SampleCounts {
    uint64_t total = 0;  // Samples of all pixels.
    uint32_t min = 0;    // Fewest samples of a pixel.
    uint32_t max = 0;    // Most samples of a pixel.
};
SampleCounts count_samples(std::span<const Accumulation> states);
// The number of samples that every pixel has; for two halves, the mean over the pixels, rounded down.
uint32_t samples_per_pixel(std::span<const Accumulation> states);
// The same from their counts.
uint32_t samples_per_pixel(std::span<const Accumulation> states, const SampleCounts& counts);
RenderCounters total_counters(std::span<const Accumulation> states);

// The images to make besides R G B A.
struct AovSelection {
    bool albedo = false;        // Albedo.R/G/B: mean albedo of the first hit.
    bool normal = false;        // N.X/Y/Z: mean shading normal of the first hit, world space.
    bool position = false;      // P.X/Y/Z: where the pinhole ray through the pixel centre hits [m].
    bool depth = false;         // Z: depth of that hit along the view axis [m]; infinity at a miss.
    bool variance = false;      // Variance.R/G/B of the pixel mean; infinity below two samples.
    bool sample_count = false;  // SampleCount.V.
    // A is 1 - the mean transmission, and FirstHit.A what A is otherwise. The samples were rendered so.
    bool transmission = false;
    bool distance = false;     // Depth.V: distance of that hit along its ray [m]; infinity at a miss.
    bool ids = false;          // ObjectId.V, InstanceId.V, MaterialId.V: see id_layers.h.
    bool cryptomatte = false;  // CryptoObject, CryptoMaterial: see id_layers.h.
    bool motion = false;       // Motion.X/Y: since the frame before; see render/motion.h.
    bool denoising = false;    // DenoisingAlbedo.R/G/B/V, DenoisingNormal.X/Y/Z: see integrator/guides.glsl.

    bool catchers = false;  // The scene has catchers, rendered as such: see catcher_layers.h.

    bool operator==(const AovSelection&) const = default;
    // Whether the accumulation needs more than LAYER_COUNT_COLOUR.
    bool needs_layers() const { return albedo || normal || transmission || catchers; }
    bool needs_positions() const { return position || depth; }
    bool needs_coverage() const { return ids || cryptomatte; }
};

// The image of the states: means over each pixel's own samples, in double precision; over one half alone if
// the other has no samples, and 0 if neither has. A is the fraction of camera rays that hit something
// visible, unless the selection says otherwise. `positions` holds x, y, z, depth per pixel, row-major; it may
// be empty if the selection does not need it.
Image make_image(std::span<const Accumulation> states, const AovSelection& aovs,
                 const std::vector<float>& positions);

// The layers of guides.
inline constexpr std::array<const char*, 3> DENOISING_ALBEDO{"DenoisingAlbedo.R", "DenoisingAlbedo.G",
                                                             "DenoisingAlbedo.B"};
inline constexpr std::array<const char*, 3> DENOISING_NORMAL{"DenoisingNormal.X", "DenoisingNormal.Y",
                                                             "DenoisingNormal.Z"};
// The variance of the pixel's mean albedo, added up over its three channels; infinity below two samples.
inline constexpr const char* DENOISING_ALBEDO_VARIANCE = "DenoisingAlbedo.V";

inline Image make_image(const Accumulation& state, const AovSelection& aovs,
                        const std::vector<float>& positions) {
    return make_image({&state, 1}, aovs, positions);
}

// FNV-1a (64 bits) of the float R, G, B of the image, pixel by pixel, row-major.
uint64_t image_hash(const Image& image);

}  // namespace candela
