// See accumulation.h.
#include "film/accumulation.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"

namespace candela {
namespace {

// Appends a channel whose value at pixel i is value(i).
template <class Value>
void add_channel(Image& image, const char* name, const Value& value) {
    Channel& channel = image.add(name);
    for (size_t i = 0; i < channel.values.size(); ++i)
        channel.values[i] = float(value(i));
}

uint32_t count_of(std::span<const Accumulation> states, size_t i) {
    uint32_t n = 0;
    for (const Accumulation& state : states)
        n += state.sample_count(i);
    return n;
}

// The samples of one half of a rendering, or of all of it.
class Half {
  public:
    explicit Half(std::span<const Accumulation> states) : states_(states) {}

    uint32_t count(size_t i) const { return count_of(states_, i); }
    // The fraction of camera rays that hit something visible.
    double alpha(size_t i) const {
        return sum(i, [&](const Accumulation& state) { return double(state.at(LAYER_L, i)[3]); }) / count(i);
    }
    double mean(uint32_t layer, size_t i, int component) const {
        return total(layer, i, component) / count(i);
    }
    double transmission(size_t i) const { return mean(LAYER_ALBEDO, i, 3); }
    // Variance of the mean, from the sum of the samples and the sum of their squares.
    double variance(size_t i, int component) const {
        const double n = count(i);
        if (n < 2) return INFINITE;
        const double samples = total(LAYER_L, i, component);
        const double squares = total(LAYER_SQUARE, i, component);
        return std::max(0.0, squares - samples * samples / n) / (n * (n - 1.0));
    }

  private:
    template <class Value>
    double sum(size_t i, const Value& value) const {
        double sum = 0.0;
        for (const Accumulation& state : states_)
            sum += state.sample_count(i) == 0 ? 0.0 : value(state);
        return sum;
    }
    // The compensated sums, with their compensation applied.
    double total(uint32_t layer, size_t i, int component) const {
        return sum(i, [&](const Accumulation& state) {
            return double(state.at(layer, i)[component]) - double(state.at(layer + 1, i)[component]);
        });
    }

    std::span<const Accumulation> states_;
};

std::vector<Half> halves_of(std::span<const Accumulation> states) {
    if (states.size() < 4) return {Half(states)};
    return {Half(states.first(2)), Half(states.last(2))};
}

// The mean of value(half) over the halves with samples of pixel i; 0 if there are none.
template <class Value>
double mean_of(const std::vector<Half>& halves, size_t i, const Value& value) {
    double sum = 0.0;
    int count = 0;
    for (const Half& half : halves) {
        if (half.count(i) == 0) continue;
        sum += value(half);
        ++count;
    }
    return count == 0 ? 0.0 : sum / count;
}

// Variance of the image, which is the mean of independent halves.
double variance_of_mean(const std::vector<Half>& halves, size_t i, int component) {
    if (std::ranges::any_of(halves, [i](const Half& half) { return half.count(i) == 0; })) return INFINITE;
    return mean_of(halves, i, [&](const Half& half) { return half.variance(i, component); }) /
           double(halves.size());
}

}  // namespace

uint32_t Accumulation::limit(size_t i) const {
    const float limit = values.empty() ? 0.0f : at(LAYER_SQUARE, i)[3];
    return limit == 0.0f ? UINT32_MAX : uint32_t(limit) - 1;
}

void Accumulation::set_limit(size_t i, uint32_t samples) {
    values[(LAYER_SQUARE * pixel_count() + i) * 4 + 3] = float(samples + 1);
}

uint64_t Accumulation::total_samples() const {
    return count_samples({this, 1}).total;
}

uint32_t Accumulation::min_samples() const {
    return count_samples({this, 1}).min;
}

uint32_t Accumulation::max_samples() const {
    return count_samples({this, 1}).max;
}

SampleCounts count_samples(std::span<const Accumulation> states) {
    SampleCounts counts{.total = 0, .min = UINT32_MAX, .max = 0};
    for (size_t i = 0; i < states.front().pixel_count(); ++i) {
        const uint32_t n = count_of(states, i);
        counts.total += n;
        counts.min = std::min(counts.min, n);
        counts.max = std::max(counts.max, n);
    }
    return counts;
}

uint32_t samples_per_pixel(std::span<const Accumulation> states) {
    const SampleCounts counts = count_samples(states);
    return states.size() < 4 ? counts.min : uint32_t(counts.total / states.front().pixel_count());
}

RenderCounters total_counters(std::span<const Accumulation> states) {
    RenderCounters sum;
    for (const Accumulation& state : states) {
        sum.rays += state.counters.rays;
        sum.nonfinite_samples += state.counters.nonfinite_samples;
        sum.depth_limit_hits += state.counters.depth_limit_hits;
    }
    return sum;
}

Image make_image(std::span<const Accumulation> states, const AovSelection& aovs,
                 const std::vector<float>& positions) {
    const Accumulation& first = states.front();
    const std::vector<Half> halves = halves_of(states);
    Image image{.full = first.full, .data = first.rect, .channels = {}, .attributes = {}};
    const auto add_means = [&](std::array<const char*, 3> names, uint32_t layer) {
        for (int c = 0; c < 3; ++c) {
            add_channel(image, names[c], [&](size_t i) {
                return mean_of(halves, i, [&](const Half& half) { return half.mean(layer, i, c); });
            });
        }
    };
    add_means({"R", "G", "B"}, LAYER_L);
    add_channel(image, aovs.transmission ? FIRST_HIT_ALPHA : "A", [&](size_t i) {
        return mean_of(halves, i, [&](const Half& half) { return half.alpha(i); });
    });
    if (aovs.transmission) {
        add_channel(image, "A", [&](size_t i) {
            return mean_of(halves, i, [&](const Half& half) { return 1.0 - half.transmission(i); });
        });
    }
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
            add_channel(image, NAMES[c], [&](size_t i) { return variance_of_mean(halves, i, c); });
    }
    if (aovs.sample_count) add_channel(image, "SampleCount.V", [&](size_t i) { return count_of(states, i); });
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
