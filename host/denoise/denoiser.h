// Denoising: from a noisy picture, and what is known of it, to one that looks as if it had many more samples.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"

namespace candela {

// Planes of width * height values, row-major from the top; any float may occur in them.
struct NoisyPicture {
    uvec2 size{0, 0};
    RgbPlanes rgb;                        // Linear radiance, of any range.
    std::optional<RgbPlanes> variance{};  // Of each pixel's mean, which `rgb` is.
    std::optional<RgbPlanes> albedo{};    // Mean albedo, in [0, 1].
    std::optional<RgbPlanes> normal{};  // Mean normal, at most 1 long: x, y, z in place of red, green, blue.
    std::span<const float> alpha{};     // In [0, 1]; empty: none, and none is made.
    std::span<const float> samples{};   // Of each pixel; empty: unknown.
    // Of each pixel's albedo, which is a mean, too: added up over red, green and blue; empty: unknown.
    std::span<const float> albedo_variance{};

    size_t pixel_count() const { return size_t{size.x} * size.y; }
};

// The planes of a denoised picture, row-major.
struct Denoised {
    std::array<std::vector<float>, 3> rgb;
    std::vector<float> alpha;  // In [0, 1]; empty without NoisyPicture::alpha.
    // The weight with which a pixel's own noisy value went into its denoised one; empty if unknown, and taken
    // for 0.
    std::vector<float> own_weight;
};

// A way to denoise.
class Denoiser {
  public:
    Denoiser() = default;
    virtual ~Denoiser() = default;
    Denoiser(const Denoiser&) = delete;
    Denoiser& operator=(const Denoiser&) = delete;

    // Its word on the command line, and what it is: "oidn", "Open Image Denoise 2.5.1".
    virtual std::string name() const = 0;
    virtual std::string description() const = 0;
    // Throws Error if it fails; another picture may then succeed. One picture at a time.
    virtual Denoised run(const NoisyPicture& picture) = 0;
};

}  // namespace candela
