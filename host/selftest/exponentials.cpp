// See exponentials.h.
#include "selftest/exponentials.h"

#include <bit>
#include <cmath>

#include "base/text.h"
#include "probe/probe.h"
#include "probe/probes.h"

namespace candela {
namespace {

// Negative numbers of every size from -2^-100 to `min`, on a logarithmic scale, `min` included.
std::vector<float> of_every_size(double min) {
    std::vector<float> x;
    const int count = 100000;
    for (int i = 0; i <= count; ++i)
        x.push_back(float(-std::exp2(-100.0 + (std::log2(-min) + 100.0) * i / count)));
    x.back() = float(min);
    return x;
}

// The floats around `x`, 64 on either side.
void add_neighbours(std::vector<float>& out, float x) {
    for (int steps = -64; steps <= 64; ++steps)
        out.push_back(std::bit_cast<float>(std::bit_cast<uint32_t>(x) + uint32_t(steps)));
}

}  // namespace

std::vector<Exponentials> run_exponentials(const vk::Device& device, const std::vector<float>& x) {
    std::vector<vec4> items;
    for (const float value : x)
        items.emplace_back(value, 0.0f, 0.0f, 0.0f);
    return probe<Exponentials>(device, kernels::exponential, items);
}

// Errors, in units of 2^-24 of the result: s = f / (2 + f) has a division, 5 by Vulkan's rules (2.5 ulp), and
// a sum, 1. Below -0.2929 the mantissa comes from the rounded 1 + x, which is off by 1/2, and the logarithm
// by at most 1/2 / (0.7 * 0.35) = 2, close to -0.2929. The additions of the series add less than 1: they are
// multiplied by less than 0.36 where they add to an exponent. Vulkan allows sums and products to be rounded
// to either neighbour, so everything except the division may be doubled.
Evidence test_logarithm(const vk::Device& device) {
    std::vector<float> x = of_every_size(-1.0 + 0x1p-24);
    add_neighbours(x, -0.2929f);
    for (const float scale : {0.25f, 0.125f, 0x1p-10f}) {  // 1 + x around scale and scale / sqrt(2).
        add_neighbours(x, scale - 1.0f);
        add_neighbours(x, scale * std::sqrt(0.5f) - 1.0f);
    }
    add_neighbours(x, -0.5f);
    for (int i = 0; i < 100; ++i)
        x.push_back(-1.0f + float(i + 1) * 0x1p-24f);  // 1 - u for the last u of [0, 1).
    const std::vector<Exponentials> values = run_exponentials(device, x);
    Evidence evidence;
    for (size_t i = 0; i < x.size(); ++i) {
        const double expected = std::log1p(double(x[i]));
        evidence.expect(std::abs(double(values[i].log1p) - expected) <= 11 * 0x1p-24 * -expected,
                        [&] { return concat("log1p(", x[i], ") = ", values[i].log1p); });
    }
    return evidence;
}

// exp(x) = 2^k (1 + p). Errors, in units of 2^-24 of the result, in the worst case, |x - k log(2)| = 0.35:
// this difference is off by 1/4; p, in [-0.3, 0.42], by 2.4 of itself (a product, a sum, the rest of the
// series), which is 0.7 of 1 + p; the sum adds 0.7; the last product is exact. Together that is less than 2.
// expm1 cancels most at k = -1, p = 0.41: 0.3 out of 0.5; less than 3. Both are doubled, since a device may
// round to either neighbour.
Evidence test_exponentials(const vk::Device& device) {
    constexpr float MIN = -87.0f;
    std::vector<float> x = of_every_size(double(MIN));
    for (int k = 0; k < 126; ++k)  // At the boundaries between powers of two.
        add_neighbours(x, float(-std::log(2.0) * (k + 0.5)));
    const std::vector<Exponentials> values = run_exponentials(device, x);
    Evidence evidence;
    for (size_t i = 0; i < x.size(); ++i) {
        if (x[i] < MIN) continue;
        const double exp = std::exp(double(x[i])), expm1 = std::expm1(double(x[i]));
        evidence.expect(
            std::abs(double(values[i].exp) - exp) <= 4 * 0x1p-24 * exp &&
                std::abs(double(values[i].expm1) - expm1) <= 6 * 0x1p-24 * -expm1,
            [&] { return concat("exp(", x[i], ") = ", values[i].exp, ", less 1: ", values[i].expm1); });
    }
    return evidence;
}

}  // namespace candela
