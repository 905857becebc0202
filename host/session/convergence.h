// How the error of an image falls while it is rendered: what --target-error and --reference measure, at fixed
// numbers of samples.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/accumulation.h"
#include "image/image.h"
#include "render/renderer.h"

namespace candela {

// Reads the image that --reference names. Throws Error if it cannot be read, if its size or crop differs from
// the settings', or if it lacks R, G or B, holds a value that is not finite, or is black.
Image load_reference(const std::string& path, const RenderSettings& settings);

// The error of the image at one moment.
struct ConvergencePoint {
    uint32_t spp = 0;                // As samples_per_pixel() says.
    double seconds = 0.0;            // Wall time of rendering.
    std::optional<double> estimate;  // Estimate of the relative error; see relative_error.h.
    std::optional<double> relmse;    // relative_mse() to the reference, if there is one.
};

class Convergence {
  public:
    // `target`: relative error to reach.
    Convergence(std::optional<double> target, std::optional<Image> reference);

    // The samples per pixel of the next measure(), after `spp` and at most `max`, from next_look(). If there
    // is neither a target nor a reference: `max`.
    uint32_t next(uint32_t spp, uint32_t max) const;
    // Measures the image of the states after `seconds` of rendering.
    void measure(std::span<const Accumulation> states, double seconds);

    // Whether the last estimate is at most the target.
    bool reached() const;
    // The last estimate; nothing if there is none yet.
    std::optional<double> estimate() const;
    // One for each measure().
    const std::vector<ConvergencePoint>& points() const { return points_; }

  private:
    std::optional<double> target_;
    std::optional<Image> reference_;
    std::optional<Image> before_;  // At the last look.
    std::vector<ConvergencePoint> points_;
};

}  // namespace candela
