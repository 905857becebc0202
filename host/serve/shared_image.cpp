// See shared_image.h.
#include "serve/shared_image.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "serve/picture_request.h"

namespace candela::serve {

std::vector<SharedImage::Layer> SharedImage::layers_of(const Image& image) {
    std::vector<Layer> layers;
    uint64_t offset = 0;
    for (const LayerKind& kind : layer_kinds()) {
        if (image.find(kind.channels.front()) == nullptr) continue;
        layers.push_back({std::string(kind.name), {kind.channels.begin(), kind.channels.end()}, offset});
        offset += kind.channels.size() * image.pixel_count() * sizeof(float);
    }
    return layers;
}

uint64_t SharedImage::bytes_of(const Image& image, const std::vector<Layer>& layers) {
    const Layer& last = layers.back();
    return last.offset + last.channels.size() * image.pixel_count() * sizeof(float);
}

SharedImage::SharedImage(Image image, std::shared_ptr<const Labels> labels)
    : layers_(layers_of(image)),
      labels_(std::move(labels)),
      charge_(bytes_of(image, layers_)),
      memory_(bytes_of(image, layers_)) {
    for (const Layer& layer : layers_) {
        const size_t step = layer.channels.size();
        for (size_t c = 0; c < step; ++c) {
            float* target = values_of(layer) + c;
            for (const float value : image.find(layer.channels[c])->values) {
                *target = value;
                target += step;
            }
        }
    }
    frame_ = std::move(image);
    std::erase_if(frame_.channels, [this](const Channel& channel) {
        return std::ranges::any_of(layers_, [&](const Layer& layer) {
            return std::ranges::find(layer.channels, channel.name) != layer.channels.end();
        });
    });
}

float* SharedImage::values_of(const Layer& layer) const {
    return reinterpret_cast<float*>(memory_.bytes().data() + layer.offset);
}

Json SharedImage::describe() const {
    Json layers = Json::object();
    for (const Layer& layer : layers_)
        layers[layer.name] = {{"offset", layer.offset}, {"channels", layer.channels.size()}};
    const PixelRect& crop = frame_.data;
    return {{"file", memory_.path().string()},
            {"bytes", memory_.bytes().size()},
            {"width", crop.width()},
            {"height", crop.height()},
            {"crop", {crop.x0, crop.y0, crop.x1, crop.y1}},
            {"layers", layers}};
}

Image SharedImage::image() const {
    Image image = frame_;
    for (const Layer& layer : layers_) {
        const size_t step = layer.channels.size();
        for (size_t c = 0; c < step; ++c) {
            const float* source = values_of(layer) + c;
            for (float& value : image.add(layer.channels[c]).values) {
                value = *source;
                source += step;
            }
        }
    }
    return image;
}

}  // namespace candela::serve
