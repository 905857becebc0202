// See accumulation.h.
#include "film/accumulation.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "film/catcher_layers.h"

namespace candela {
namespace {

// Appends a channel whose value at pixel i is value(i).
template <class Value>
void add_channel(Image& image, const char* name, const Value& value) {
    Channel& channel = image.add(name);
    for (size_t i = 0; i < channel.values.size(); ++i)
        channel.values[i] = float(value(i));
}

// Appends channels whose values at pixel i are the components of value(i).
template <int N, class Value>
void add_channels(Image& image, const std::array<const char*, size_t(N)>& names, const Value& value) {
    const size_t first = image.channels.size();
    for (const char* name : names)
        image.add(name);
    std::array<float*, size_t(N)> planes;
    for (size_t c = 0; c < planes.size(); ++c)
        planes[c] = image.channels[first + c].values.data();
    const size_t count = image.pixel_count();
    for (size_t i = 0; i < count; ++i) {
        const glm::vec<N, double> values = value(i);
        for (int c = 0; c < N; ++c)
            planes[size_t(c)][i] = float(values[c]);
    }
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
    // The mean R, G and B, and the fraction of camera rays that hit something visible.
    dvec4 colour(size_t i) const {
        dvec4 sum(0.0);
        for (const Accumulation& state : states_) {
            if (state.sample_count(i) > 0)
                sum += dvec4(dvec3(total(state, LAYER_L, i)), double(state.at(LAYER_L, i)[3]));
        }
        return sum / double(count(i));
    }
    dvec3 mean(uint32_t layer, size_t i) const {
        dvec3 sum(0.0);
        for (const Accumulation& state : states_) {
            if (state.sample_count(i) > 0) sum += dvec3(total(state, layer, i));
        }
        return sum / double(count(i));
    }
    // The fraction of camera rays that hit a catcher (LAYER_WITH), or one that reflects (LAYER_WITHOUT).
    double caught(uint32_t layer, size_t i) const {
        return sum(i, [&](const Accumulation& state) { return double(state.at(layer, i)[3]); }) / count(i);
    }
    double transmission(size_t i) const { return total(LAYER_ALBEDO, i, 3) / count(i); }
    // Variance of the mean, from the sum of the samples and the sum of their squares.
    double variance(size_t i, int component) const {
        const double samples = total(LAYER_L, i, component);
        return variance(i, samples * samples, total(LAYER_SQUARE, i, component));
    }
    // The same of the guide albedo, added up over its channels.
    double albedo_variance(size_t i) const {
        const uint32_t layer = states_.front().denoising_layer + GUIDE_ALBEDO;
        double squared_sum = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double samples = total(layer, i, c);
            squared_sum += samples * samples;
        }
        return variance(i, squared_sum, total(layer, i, 3));
    }

  private:
    double variance(size_t i, double squared_sum, double squares) const {
        const double n = count(i);
        return n < 2 ? INFINITE : std::max(0.0, squares - squared_sum / n) / (n * (n - 1.0));
    }
    template <class Value>
    double sum(size_t i, const Value& value) const {
        double sum = 0.0;
        for (const Accumulation& state : states_)
            sum += state.sample_count(i) == 0 ? 0.0 : value(state);
        return sum;
    }
    // The compensated sums, with their compensation applied.
    static dvec4 total(const Accumulation& state, uint32_t layer, size_t i) {
        const float* const values = state.at(layer, i);
        const float* const errors = state.at(layer + 1, i);
        return dvec4(values[0], values[1], values[2], values[3]) -
               dvec4(errors[0], errors[1], errors[2], errors[3]);
    }
    double total(uint32_t layer, size_t i, int component) const {
        return sum(i, [&](const Accumulation& state) { return total(state, layer, i)[component]; });
    }

    std::span<const Accumulation> states_;
};

std::vector<Half> halves_of(std::span<const Accumulation> states) {
    if (states.size() < 4) return {Half(states)};
    return {Half(states.first(2)), Half(states.last(2))};
}

// The mean of value(half) over the halves with samples of pixel i; 0 if there are none.
template <class Value>
auto mean_of(const std::vector<Half>& halves, size_t i, const Value& value) {
    decltype(value(halves.front())) sum(0.0);
    if (halves.size() == 1) return halves[0].count(i) == 0 ? sum : value(halves[0]);
    int count = 0;
    for (const Half& half : halves) {
        if (half.count(i) == 0) continue;
        sum += value(half);
        ++count;
    }
    return count == 0 ? sum : sum / double(count);
}

// Variance of the mean of independent halves, whose own is variance(half).
template <class Value>
double variance_of_mean(const std::vector<Half>& halves, size_t i, const Value& variance) {
    if (std::ranges::any_of(halves, [i](const Half& half) { return half.count(i) == 0; })) return INFINITE;
    return mean_of(halves, i, variance) / double(halves.size());
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
    if (std::ranges::all_of(states, [](const Accumulation& state) { return state.values.empty(); }))
        return {};
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
    return samples_per_pixel(states, count_samples(states));
}

uint32_t samples_per_pixel(std::span<const Accumulation> states, const SampleCounts& counts) {
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
        add_channels<3>(image, names, [&](size_t i) {
            return mean_of(halves, i, [&](const Half& half) { return half.mean(layer, i); });
        });
    };
    const bool has_others = aovs.catchers || aovs.transmission;
    add_channels<4>(image, {"R", "G", "B", has_others ? FIRST_HIT_ALPHA : "A"}, [&](size_t i) {
        return mean_of(halves, i, [&](const Half& half) {
            dvec4 colour = half.colour(i);
            if (aovs.catchers) colour.w += half.caught(LAYER_WITHOUT, i);
            return colour;
        });
    });
    if (has_others) {
        add_channel(image, aovs.catchers ? FOREGROUND_ALPHA : "A", [&](size_t i) {
            return mean_of(halves, i, [&](const Half& half) {
                return aovs.transmission ? 1.0 - half.transmission(i) : half.colour(i).w;
            });
        });
    }
    if (aovs.catchers) {
        add_channel(image, CATCHER_ALPHA, [&](size_t i) {
            return mean_of(halves, i, [&](const Half& half) { return half.caught(LAYER_WITH, i); });
        });
        add_means(CATCHER_WITH, LAYER_WITH);
        add_means(CATCHER_WITHOUT, LAYER_WITHOUT);
        set_catcher_alpha(image);
    }
    if (aovs.albedo) add_means({"Albedo.R", "Albedo.G", "Albedo.B"}, LAYER_ALBEDO);
    if (aovs.normal) add_means({"N.X", "N.Y", "N.Z"}, LAYER_NORMAL);
    if (aovs.denoising) {
        add_means(DENOISING_ALBEDO, first.denoising_layer + GUIDE_ALBEDO);
        add_means(DENOISING_NORMAL, first.denoising_layer + GUIDE_NORMAL);
        add_channel(image, DENOISING_ALBEDO_VARIANCE, [&](size_t i) {
            return variance_of_mean(halves, i, [&](const Half& half) { return half.albedo_variance(i); });
        });
    }
    if (aovs.position) {
        constexpr const char* NAMES[] = {"P.X", "P.Y", "P.Z"};
        for (size_t c = 0; c < 3; ++c)
            add_channel(image, NAMES[c], [&](size_t i) { return positions[4 * i + c]; });
    }
    if (aovs.depth) add_channel(image, "Z", [&](size_t i) { return positions[4 * i + 3]; });
    if (aovs.variance) {
        constexpr const char* NAMES[] = {"Variance.R", "Variance.G", "Variance.B"};
        for (int c = 0; c < 3; ++c)
            add_channel(image, NAMES[c], [&](size_t i) {
                return variance_of_mean(halves, i, [&](const Half& half) { return half.variance(i, c); });
            });
    }
    if (aovs.sample_count) add_channel(image, "SampleCount.V", [&](size_t i) { return count_of(states, i); });
    return image;
}

uint64_t image_hash(const Image& image) {
    uint64_t hash = FNV1A64_BASIS;
    const RgbPlanes rgb = *image.find_rgb();
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const std::array<float, 3> colour{rgb[0][i], rgb[1][i], rgb[2][i]};
        hash = fnv1a64(std::as_bytes(std::span(colour)), hash);
    }
    return hash;
}

}  // namespace candela
