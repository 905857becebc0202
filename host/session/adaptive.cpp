// See adaptive.h.
#include "session/adaptive.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "film/sample_range.h"
#include "image/relative_error.h"
#include "session/next_look.h"

namespace candela {
namespace {

// The states of half h are 2h and 2h + 1: even, extra.
constexpr size_t HALVES = 2;

// All samples of the first pass are even. Fewer would not locate the error well enough.
constexpr uint32_t FIRST_EVEN = 16;

// Later, one sample in this many is even. More would locate the error better, but leave fewer extra samples
// to reduce it.
constexpr uint32_t EVEN_PART = 8;

// A pixel gets at most this many times the average, since its error may come from a single bright sample.
constexpr double LARGEST_FRACTION = 16.0;

// Replaces each value of a row-major plane by the mean over its work group. A single pixel has too few
// samples to estimate its error; and the pixels of a group wait for each other, so that they should have the
// same limit.
void average_groups(std::vector<double>& plane, size_t width) {
    const size_t height = plane.size() / width;
    for (size_t y0 = 0; y0 < height; y0 += WORKGROUP_SIZE) {
        for (size_t x0 = 0; x0 < width; x0 += WORKGROUP_SIZE) {
            const size_t y1 = std::min(y0 + WORKGROUP_SIZE, height);
            const size_t x1 = std::min(x0 + WORKGROUP_SIZE, width);
            double sum = 0.0;
            for (size_t y = y0; y < y1; ++y)
                sum = std::accumulate(&plane[y * width + x0], &plane[y * width] + x1, sum);
            for (size_t y = y0; y < y1; ++y)
                std::fill(&plane[y * width + x0], &plane[y * width] + x1,
                          sum / double((y1 - y0) * (x1 - x0)));
        }
    }
}

// The relative variance of a sample in each pixel's group, summed over the channels, divided by the rays per
// sample.
std::vector<double> variance_over_cost(const Accumulation& state) {
    const size_t width = state.rect.width();
    const Image image = make_image(state, {.variance = true}, {});
    const RgbPlanes colours = *image.find_rgb(), variances = *image.find_rgb("Variance");
    const double darkness = darkness_of(colours);
    std::vector<double> variance(state.pixel_count(), 0.0), rays(state.pixel_count());
    for (size_t c = 0; c < 3 && darkness > 0.0; ++c) {
        std::vector<double> colour(colours[c].begin(), colours[c].end());
        average_groups(colour, width);
        for (size_t i = 0; i < variance.size(); ++i)
            variance[i] +=
                double(variances[c][i]) * state.sample_count(i) / (colour[i] * colour[i] + darkness);
    }
    for (size_t i = 0; i < rays.size(); ++i)
        rays[i] = state.rays_per_sample(i);
    average_groups(variance, width);
    average_groups(rays, width);
    for (size_t i = 0; i < rays.size(); ++i)
        variance[i] /= std::max(1.0, rays[i]);
    return variance;
}

// The factor that turns weights into numbers of samples whose mean is `mean`.
template <class Samples>
double solve_factor(double mean, const Samples& mean_with) {
    double low = 0.0, high = 1.0;
    while (mean_with(high) < mean && high < 1e30)
        high *= 2.0;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (mean_with(middle) < mean ? low : high) = middle;
    }
    return high;
}

}  // namespace

std::vector<Accumulation> adaptive_states(const RenderSettings& settings) {
    std::vector<Accumulation> states(2 * HALVES, empty_state(settings));
    for (uint32_t i = 0; i < states.size(); ++i) {
        states[i].seed ^= i << 30;
        states[i].values.resize(states[i].layer_count * states[i].pixel_count() * 4);
    }
    return states;
}

uint32_t next_pass_end(uint32_t spp, uint32_t target) {
    return next_look(spp, target, 2 * FIRST_EVEN);
}

uint32_t even_samples(uint32_t half) {
    return std::max(std::min(half, FIRST_EVEN), half / EVEN_PART);
}

void plan_extra_samples(const Accumulation& other_even, uint32_t even, uint32_t half, Accumulation& extra) {
    std::vector<double> weights = variance_over_cost(other_even);
    for (double& weight : weights)
        weight = std::sqrt(weight);
    if (std::ranges::all_of(weights, [](double weight) { return weight == 0.0; }))
        std::ranges::fill(weights, 1.0);
    const size_t pixels = weights.size();
    std::vector<double> before(pixels);
    for (size_t i = 0; i < pixels; ++i)
        before[i] = extra.limit(i) == UINT32_MAX ? 0.0 : extra.limit(i);
    const double max = std::min(LARGEST_FRACTION * half, MAX_SPP - 1.0);
    const auto extra_of = [&](size_t i, double factor) {
        return std::max(before[i], std::min(factor * weights[i], max) - even);
    };
    const double factor = solve_factor(half - even, [&](double f) {
        double sum = 0.0;
        for (size_t i = 0; i < pixels; ++i)
            sum += extra_of(i, f);
        return sum / double(pixels);
    });
    for (size_t i = 0; i < pixels; ++i)
        extra.set_limit(i, uint32_t(std::lround(extra_of(i, factor))));
}

bool render_pass(SteadyRenderer& renderer, uint32_t spp, uint32_t& planned,
                 const std::function<bool(double)>& keep_going) {
    std::vector<Accumulation>& states = renderer.states();
    const uint32_t half = spp / 2, even = even_samples(half);
    if (planned > spp) return true;
    const auto render = [&](size_t state, uint32_t target, uint64_t samples) {
        const double all = double(spp) * double(states[state].pixel_count());
        const SampleCounts held = count_samples({&states[state], 1});
        if (held.total >= samples) return true;
        const double before = double(count_samples(states).total) / all;
        const double missing = double(samples - held.total) / all;
        const double start = double(held.min) / target;
        renderer.select(state);
        return renderer.render(target, [&](double done) {
            return keep_going(std::min(1.0, before + missing * (done - start) / (1.0 - start)));
        });
    };
    for (size_t h = 0; h < HALVES; ++h) {
        if (!render(2 * h, even, uint64_t{even} * states[2 * h].pixel_count())) return false;
    }
    if (half > even && planned < spp) {
        for (size_t h = 0; h < HALVES; ++h)
            plan_extra_samples(states[2 * (1 - h)], even, half, states[2 * h + 1]);
        planned = spp;
    }
    for (size_t h = 0; half > even && h < HALVES; ++h) {
        uint32_t max = 0;
        uint64_t samples = 0;
        for (size_t i = 0; i < states[2 * h + 1].pixel_count(); ++i) {
            max = std::max(max, states[2 * h + 1].limit(i));
            samples += states[2 * h + 1].limit(i);
        }
        if (!render(2 * h + 1, max, samples)) return false;
    }
    return true;
}

}  // namespace candela
