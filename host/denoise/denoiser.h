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

// A noisy picture: planes of width * height values, row-major from the top; any float may occur in them.
struct DenoiserInput {
    uint32_t width = 0, height = 0;
    RgbPlanes colour;                     // Linear, of any range.
    std::span<const float> alpha{};       // In [0, 1]; empty: none, and none is made.
    std::optional<RgbPlanes> albedo{};    // In [0, 1].
    std::optional<RgbPlanes> normal{};    // In [-1, 1]: x, y and z in place of red, green and blue.
    std::optional<RgbPlanes> variance{};  // Of the mean that `colour` is.

    size_t pixel_count() const { return size_t{width} * height; }
};

struct DenoisedPicture {
    std::array<std::vector<float>, 3> colour;  // All finite and at least 0.
    std::vector<float> alpha;                  // In [0, 1]; empty without DenoiserInput::alpha.
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
    virtual DenoisedPicture run(const DenoiserInput& input) = 0;
};

}  // namespace candela
