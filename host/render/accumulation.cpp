// See accumulation.h.
#include "render/accumulation.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"

namespace candela {
namespace {

// Appends one channel, its value at pixel i given by value(i).
template <class Value>
void add_channel(Image& image, const char* name, const Value& value) {
    Channel& channel = image.add(name);
    for (size_t i = 0; i < channel.values.size(); ++i)
        channel.values[i] = float(value(i));
}

// A compensated sum as the number that it stands for.
double total(const Accumulation& state, uint32_t layer, size_t i, int component) {
    return double(state.at(layer, i)[component]) - double(state.at(layer + 1, i)[component]);
}

double mean(const Accumulation& state, uint32_t layer, size_t i, int component) {
    const uint32_t n = state.sample_count(i);
    return n == 0 ? 0.0 : total(state, layer, i, component) / n;
}

// Variance of the mean of the pixel's samples, from their sum and their sum of squares.
double variance(const Accumulation& state, size_t i, int component) {
    const double n = state.sample_count(i);
    if (n < 2) return INFINITE;
    const double sum = total(state, LAYER_L, i, component);
    const double squares = total(state, LAYER_SQUARE, i, component);
    return std::max(0.0, squares - sum * sum / n) / (n * (n - 1.0));
}

}  // namespace

uint64_t Accumulation::total_samples() const {
    uint64_t samples = 0;
    for (size_t i = 0; i < pixel_count(); ++i)
        samples += sample_count(i);
    return samples;
}

uint32_t Accumulation::least_samples() const {
    uint32_t least = UINT32_MAX;
    for (size_t i = 0; i < pixel_count(); ++i)
        least = std::min(least, sample_count(i));
    return least;
}

uint32_t Accumulation::most_samples() const {
    uint32_t most = 0;
    for (size_t i = 0; i < pixel_count(); ++i)
        most = std::max(most, sample_count(i));
    return most;
}

Image make_image(const Accumulation& state, const AovSelection& aovs, const std::vector<float>& positions) {
    Image image{.full = state.full, .data = state.rect, .channels = {}, .attributes = {}};
    const auto add_means = [&](std::array<const char*, 3> names, uint32_t layer) {
        for (int c = 0; c < 3; ++c) {
            add_channel(image, names[c], [&](size_t i) { return mean(state, layer, i, c); });
        }
    };
    add_means({"R", "G", "B"}, LAYER_L);
    add_channel(image, "A", [&](size_t i) {
        const uint32_t n = state.sample_count(i);
        return n == 0 ? 0.0f : state.at(LAYER_L, i)[3] / float(n);
    });
    if (aovs.albedo) add_means({"Albedo.R", "Albedo.G", "Albedo.B"}, LAYER_ALBEDO);
    if (aovs.normal) add_means({"N.X", "N.Y", "N.Z"}, LAYER_NORMAL);
    if (aovs.position) {
        constexpr const char* NAMES[] = {"P.X", "P.Y", "P.Z"};
        for (size_t c = 0; c < 3; ++c)
            add_channel(image, NAMES[c], [&](size_t i) { return positions[4 * i + c]; });
    }
    if (aovs.depth) add_channel(image, "Z", [&](size_t i) { return positions[4 * i + 3]; });
    if (aovs.variance) {
        constexpr const char* NAMES[] = {"Variance.R", "Variance.G", "Variance.B"};
        for (int c = 0; c < 3; ++c)
            add_channel(image, NAMES[c], [&](size_t i) { return variance(state, i, c); });
    }
    if (aovs.sample_count)
        add_channel(image, "SampleCount.V", [&](size_t i) { return state.sample_count(i); });
    return image;
}

uint64_t image_hash(const Image& image) {
    std::vector<float> rgb;
    rgb.reserve(image.pixel_count() * 3);
    const Channel* channels[] = {image.find("R"), image.find("G"), image.find("B")};
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        for (const Channel* channel : channels)
            rgb.push_back(channel->values[i]);
    }
    return fnv1a64(std::as_bytes(std::span(rgb)));
}

}  // namespace candela
