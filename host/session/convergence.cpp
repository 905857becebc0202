// See convergence.h.
#include "session/convergence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "image/image_io.h"
#include "image/relative_error.h"
#include "session/next_look.h"

namespace candela {

Image load_reference(const std::string& path, const RenderSettings& settings) {
    Image reference = read_exr(path, {.channels = {"R", "G", "B"}});
    const auto refuse = [&](const std::string& why) { throw Error("--reference: \"" + path + "\" " + why); };
    const auto describe = [](uvec2 full, const PixelRect& rect) {
        return std::to_string(full.x) + 'x' + std::to_string(full.y) + " pixels, crop " +
               std::to_string(rect.x0) + ',' + std::to_string(rect.y0) + ',' + std::to_string(rect.x1) + ',' +
               std::to_string(rect.y1);
    };
    if (reference.full != settings.size || reference.data != settings.crop) {
        refuse("has " + describe(reference.full, reference.data) + ", and this rendering has " +
               describe(settings.size, settings.crop) + "; give both the same --size and --crop");
    }
    const std::optional<RgbPlanes> planes = reference.find_rgb();
    if (!planes) refuse("lacks a channel R, G or B; give an image by candela render");
    double sum = 0.0;
    for (const auto& plane : *planes) {
        for (const float value : plane)
            sum += value;
    }
    if (!std::isfinite(sum)) refuse("holds a value that is not finite; render it again without such samples");
    if (sum <= 0.0) refuse("is black, so no error can be relative to it; give one with light in it");
    return reference;
}

Convergence::Convergence(std::optional<double> target, std::optional<Image> reference)
    : target_(target), reference_(std::move(reference)) {}

uint32_t Convergence::next(uint32_t spp, uint32_t max) const {
    if (!target_ && !reference_) return max;
    return next_look(spp, max);
}

void Convergence::measure(std::span<const Accumulation> states, double seconds) {
    if (!target_ && !reference_) return;
    Image image = make_image(states, {.sample_count = true}, {});
    ConvergencePoint point{
        .spp = samples_per_pixel(states), .seconds = seconds, .estimate = {}, .relmse = {}};
    if (point.spp >= MIN_ESTIMATED_SPP) {
        if (states.size() > 1) {
            point.estimate = estimate_relative_error_by_half(make_image(states.first(2), {}, {}), image);
        } else if (before_) {
            point.estimate = estimate_relative_error(*before_, image);
        }
    }
    if (reference_) point.relmse = relative_mse(*image.find_rgb(), *reference_->find_rgb());
    points_.push_back(point);
    before_ = std::move(image);
}

bool Convergence::reached() const {
    const std::optional<double> error = estimate();
    return target_ && error && *error <= *target_;
}

std::optional<double> Convergence::estimate() const {
    const auto last = std::find_if(points_.rbegin(), points_.rend(),
                                   [](const ConvergencePoint& point) { return point.estimate.has_value(); });
    return last == points_.rend() ? std::nullopt : last->estimate;
}

}  // namespace candela
