// See accumulation.h.
#include "render/accumulation.h"

#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/hash.h"
#include "base/image_io.h"

namespace candela {
namespace {

constexpr const char* COMPONENTS[] = {"R", "G", "B", "A"};
constexpr const char* SEED_ATTRIBUTE = "candela.seed";

std::string layer_channel(uint32_t layer, size_t component) {
    return "Layer" + std::to_string(layer) + "." + COMPONENTS[component];
}

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

void save_accumulation(const std::filesystem::path& path, const Accumulation& state) {
    Image image{.full = state.full, .data = state.rect, .channels = {}, .attributes = {}};
    image.attributes[SEED_ATTRIBUTE] = std::to_string(state.seed);
    for (uint32_t layer = 0; layer < state.layer_count; ++layer) {
        for (size_t c = 0; c < 4; ++c) {
            add_channel(image, layer_channel(layer, c).c_str(),
                        [&](size_t i) { return state.at(layer, i)[c]; });
        }
    }
    write_exr(path, image);
}

Accumulation load_accumulation(const std::filesystem::path& path) {
    const Image image = read_exr(path);
    const auto refuse = [&](const std::string& why) {
        throw Error(path.string() + ": not a state of candela: " + why +
                    "; give a file that candela wrote as one");
    };
    Accumulation state{.full = image.full, .rect = image.data, .values = {}};
    const auto seed = image.attributes.find(SEED_ATTRIBUTE);
    if (seed == image.attributes.end() || !std::holds_alternative<std::string>(seed->second)) {
        refuse(std::string("the attribute ") + SEED_ATTRIBUTE + " is missing");
    }
    const std::string& text = std::get<std::string>(seed->second);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), state.seed);
    if (error != std::errc{} || end != text.data() + text.size()) {
        refuse("its seed is \"" + text + "\"");
    }
    if (image.find(layer_channel(LAYER_ALBEDO, 0)) != nullptr) state.layer_count = LAYER_COUNT_AOVS;
    state.values.resize(state.layer_count * state.pixel_count() * 4);
    for (uint32_t layer = 0; layer < state.layer_count; ++layer) {
        for (size_t c = 0; c < 4; ++c) {
            const Channel* channel = image.find(layer_channel(layer, c));
            if (channel == nullptr) refuse("the channel " + layer_channel(layer, c) + " is missing");
            for (size_t i = 0; i < state.pixel_count(); ++i) {
                state.values[(layer * state.pixel_count() + i) * 4 + c] = channel->values[i];
            }
        }
    }
    return state;
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
