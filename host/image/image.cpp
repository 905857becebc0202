// Members of Image: finding and adding channels.
#include "image/image.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace candela {

const Channel* Image::find(std::string_view name) const {
    const auto found = std::ranges::find(channels, name, &Channel::name);
    return found == channels.end() ? nullptr : &*found;
}

std::optional<RgbPlanes> Image::find_rgb(std::string_view layer) const {
    const std::string prefix = layer.empty() ? "" : std::string(layer) + '.';
    RgbPlanes planes;
    for (size_t i = 0; i < 3; ++i) {
        const Channel* channel = find(prefix + "RGB"[i]);
        if (channel == nullptr) return std::nullopt;
        planes[i] = channel->values;
    }
    return planes;
}

Channel& Image::add(std::string name, float value) {
    assert(find(name) == nullptr);
    return channels.emplace_back(Channel{std::move(name), std::vector<float>(pixel_count(), value), false});
}

}  // namespace candela
