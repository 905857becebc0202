// See denoise_image.h.
#include "denoise/denoise_image.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "denoise/blend.h"

namespace candela {
namespace {

constexpr const char* VARIANCE_LAYER = "Variance";

struct Guide {
    const char* layer;
    RgbPlanes planes;
};

std::optional<RgbPlanes> find_xyz(const Image& image, const std::string& layer) {
    const Channel *const x = image.find(layer + ".X"), *const y = image.find(layer + ".Y"),
                         *const z = image.find(layer + ".Z");
    if (x == nullptr || y == nullptr || z == nullptr) return std::nullopt;
    return RgbPlanes{x->values, y->values, z->values};
}

std::optional<Guide> albedo_of(const Image& image) {
    for (const char* layer : {"DenoisingAlbedo", "Albedo"}) {
        if (const auto planes = image.find_rgb(layer)) return Guide{layer, *planes};
    }
    return std::nullopt;
}

std::optional<Guide> normal_of(const Image& image) {
    for (const char* layer : {"DenoisingNormal", "N"}) {
        if (const auto planes = find_xyz(image, layer)) return Guide{layer, *planes};
    }
    return std::nullopt;
}

Channel* find_channel(Image& image, const char* name) {
    const auto place = std::ranges::find(image.channels, name, &Channel::name);
    return place == image.channels.end() ? nullptr : &*place;
}

void set_channel(Image& image, const char* name, std::vector<float> values) {
    Channel* const channel = find_channel(image, name);
    (channel == nullptr ? image.add(name) : *channel).values = std::move(values);
}

// An alpha that is the same everywhere has no noise.
bool varies(const Channel* alpha) {
    return alpha != nullptr && !alpha->values.empty() &&
           std::ranges::any_of(alpha->values, [&](float a) { return !(a == alpha->values.front()); });
}

}  // namespace

bool is_denoised_channel(const std::string& name) {
    return name == DENOISED_ALPHA || std::ranges::find(DENOISED, name) != DENOISED.end();
}

NoisyPicture noisy_picture(const Image& image, bool with_alpha, const std::string& name) {
    const auto colour = image.find_rgb();
    if (!colour) {
        throw Error(name +
                    ": it has no channels R, G and B, so that there is nothing to denoise; give an image "
                    "such as candela render writes");
    }
    NoisyPicture picture{.size = {image.data.width(), image.data.height()}, .rgb = *colour};
    if (const Channel* const alpha = image.find("A"); with_alpha && varies(alpha))
        picture.alpha = alpha->values;
    if (const auto albedo = albedo_of(image)) {
        picture.albedo = albedo->planes;
        const Channel* const variance = image.find(std::string(albedo->layer) + ".V");
        if (variance != nullptr) picture.albedo_variance = variance->values;
    }
    if (const auto normal = normal_of(image)) picture.normal = normal->planes;
    picture.variance = image.find_rgb(VARIANCE_LAYER);
    if (const Channel* const samples = image.find("SampleCount.V")) picture.samples = samples->values;
    return picture;
}

std::string describe_guides(const Image& image) {
    const auto albedo = albedo_of(image), normal = normal_of(image);
    std::string result = "with ";
    if (!albedo) {
        result += "colour alone: it has no layer Albedo (--aov albedo,n or, better, denoising)";
    } else if (!normal) {
        result += std::string(albedo->layer) + ", but without normals: it has no layer N (--aov n)";
    } else {
        result += std::string(albedo->layer) + " and " + normal->layer;
    }
    if (!image.find_rgb(VARIANCE_LAYER))
        result += "; not blended with the noisy picture: it has no layer Variance (--aov variance)";
    return result;
}

void add_denoised(Image& image, Denoiser& denoiser, bool with_alpha, const std::string& name) {
    const NoisyPicture noisy = noisy_picture(image, with_alpha, name);
    Denoised denoised = denoiser.run(noisy);
    blend_with(noisy, denoised);
    for (size_t c = 0; c < 3; ++c)
        set_channel(image, DENOISED[c], std::move(denoised.rgb[c]));
    if (!denoised.alpha.empty()) {
        set_channel(image, DENOISED_ALPHA, std::move(denoised.alpha));
    } else {
        std::erase_if(image.channels, [](const Channel& channel) { return channel.name == DENOISED_ALPHA; });
    }
}

void DenoisedView::swap() {
    constexpr std::pair<const char*, const char*> PAIRS[] = {
        {"R", DENOISED[0]}, {"G", DENOISED[1]}, {"B", DENOISED[2]}, {"A", DENOISED_ALPHA}};
    for (const auto& [noisy, denoised] : PAIRS) {
        Channel *const a = find_channel(image_, noisy), *const b = find_channel(image_, denoised);
        if (a != nullptr && b != nullptr) std::swap(a->values, b->values);
    }
}

}  // namespace candela
