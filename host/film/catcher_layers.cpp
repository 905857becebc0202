// See catcher_layers.h.
#include "film/catcher_layers.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/color.h"

namespace candela {

void set_catcher_alpha(Image& image) {
    const Channel *const foreground = image.find(FOREGROUND_ALPHA), *const share = image.find(CATCHER_ALPHA);
    const auto with = image.find_rgb("CatcherWith"), without = image.find_rgb("CatcherWithout");
    if (foreground == nullptr || share == nullptr || !with || !without) return;
    const auto luminance_at = [](const RgbPlanes& planes, size_t i) {
        return double(luminance(vec3(planes[0][i], planes[1][i], planes[2][i])));
    };
    std::vector<float> alpha(image.pixel_count());
    for (size_t i = 0; i < alpha.size(); ++i) {
        const double unshadowed = luminance_at(*without, i);
        const double passed = unshadowed > 0.0 ? std::min(luminance_at(*with, i) / unshadowed, 1.0) : 1.0;
        alpha[i] = float(double(foreground->values[i]) + double(share->values[i]) * (1.0 - passed));
    }
    const auto place = std::ranges::find(image.channels, "A", &Channel::name);
    (place == image.channels.end() ? image.add("A") : *place).values = std::move(alpha);
}

}  // namespace candela
