// See media.h.
#include "selftest/media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/statistics.h"
#include "base/text.h"
#include "probe/probe.h"
#include "probe/probes.h"
#include "probe/random.h"
#include "shared/medium.h"

namespace candela {
namespace {

struct DistanceItem {
    std::array<uvec4, MEDIUM_WORDS> medium{};
    vec3 beta{1};
    float t_max = 1.0f;
    uvec4 random{0};
    float along = 0.0f, distance = 1.0f, share = 0.0f, unused = 0.0f;  // Focus
    vec2 lit{0};                                                       // Also.
    vec2 padding{0};
};

struct DistanceResult {
    uint32_t scattered;
    float t;
    vec3 weight;
};

constexpr float ENDLESS = 3.4e38f;

struct MediumCase {
    std::string name;
    vec3 absorption, scattering;
    vec3 beta{1};
    float t_max = 1.0f;
    float along = 0.0f, distance = 1.0f, focused = 0.0f;  // Of a light, and the share of paths for it.
    vec2 lit{0, ENDLESS};                                 // From where to where it shines.

    double length() const { return std::min(double(t_max), 1e30); }
    dvec3 extinction() const { return dvec3(absorption + scattering); }
    dvec3 share() const { return dvec3(beta) / dot(dvec3(beta), dvec3(1.0)); }
    // The probability that the path scatters before t, without a light and with it.
    double unfocused(double t) const { return -dot(share(), expm1(-extinction() * t)); }
    double scattered_before(double t) const {
        const double place = (place_of(std::clamp(t, lit_from(), lit_to())) - place_of(lit_from())) / chord();
        return (1.0 - for_light()) * unfocused(t) + (for_light() > 0.0 ? for_light() * place : 0.0);
    }
    double passes() const { return (1.0 - for_light()) * (1.0 - unfocused(length())); }
    // Its density.
    double density(double t) const {
        const double d = distance + std::abs(t - along);
        const bool is_lit = for_light() > 0.0 && t >= lit_from() && t <= lit_to();
        return (1.0 - for_light()) * dot(share(), extinction() * exp(-extinction() * t)) +
               (is_lit ? for_light() * distance / (d * d * chord()) : 0.0);
    }
    double for_light() const {
        return chord() < 1.0 / 1024.0 ? 0.0 : double(focused) * std::sqrt(unfocused(length()));
    }
    double lit_from() const { return std::clamp(double(lit.x), 0.0, length()); }
    double lit_to() const { return std::clamp(double(lit.y), 0.0, length()); }
    double chord() const { return place_of(lit_to()) - place_of(lit_from()); }
    double place_of(double t) const { return (t - along) / (distance + std::abs(t - along)); }

    static dvec3 expm1(dvec3 x) { return {std::expm1(x.x), std::expm1(x.y), std::expm1(x.z)}; }
};

std::vector<MediumCase> medium_cases() {
    return {
        {"thin", vec3(0), vec3(1e-3f)},
        {"grey", vec3(0.5f), vec3(1.5f)},
        {"coloured", vec3(0.3f, 0, 2), vec3(0.1f, 3, 0.5f)},
        {"clear in a channel", vec3(0), vec3(0, 1, 20)},
        {"endless", vec3(0.1f), vec3(0.2f, 1, 5), vec3(1), ENDLESS},
        {"endless and clear in a channel", vec3(0), vec3(0, 1, 5), vec3(1), ENDLESS},
        {"dense", vec3(1e-3f), vec3(2, 30, 80)},
        {"on a red path", vec3(0.2f), vec3(0.5f, 2, 8), vec3(2, 1e-3f, 0)},
        {"on a blue path", vec3(0.2f), vec3(0.5f, 2, 8), vec3(0, 0, 1e-20f)},
        {"very dense", vec3(1), vec3(1e6f, 2e6f, 3e6f), vec3(1), 1e-6f},
        {"near a light", vec3(0.01f), vec3(0.02f, 0.05f, 0.1f), vec3(1), 6.0f, 2.0f, 0.01f, 0.5f},
        {"before a light", vec3(0.1f), vec3(0.5f, 1, 0), vec3(1, 2, 3), 3.0f, 10.0f, 1.0f, 0.3f},
        {"behind a light", vec3(0.1f), vec3(0.5f, 1, 2), vec3(1), ENDLESS, -1.0f, 0.5f, 0.5f},
        {"in a beam", vec3(0.01f), vec3(0.1f, 0.2f, 0.3f), vec3(1), 6.0f, 2.0f, 0.3f, 0.7f, {1.0f, 4.0f}},
        {"before a beam", vec3(0.1f), vec3(0.5f, 1, 2), vec3(1), ENDLESS, -1.0f, 0.5f, 0.5f, {3.0f, ENDLESS}},
        {"beside a beam", vec3(0.1f), vec3(0.5f, 1, 2), vec3(1), 6.0f, 2.0f, 0.5f, 0.5f, {0.0f, 0.0f}},
        {"without particles", vec3(1e-3f, 1, 80), vec3(0)},
        {"black", vec3(0, 40, 300), vec3(0)},
        {"nothing", vec3(0), vec3(0)},
    };
}

constexpr size_t DISTANCE_SAMPLES = 100000, DISTANCE_CELLS = 64;

std::vector<DistanceResult> run_distances(const vk::Device& device, const MediumCase& c, uint32_t seed) {
    Random random(seed);
    DistanceItem item{.medium = pack(MediumRecord{c.absorption, 1.0f, c.scattering, 0.0f}),
                      .beta = c.beta,
                      .t_max = c.t_max,
                      .along = c.along,
                      .distance = c.distance,
                      .share = c.focused,
                      .lit = c.lit};
    std::vector<DistanceItem> items(DISTANCE_SAMPLES, item);
    for (DistanceItem& i : items)
        i.random = uvec4{random.bits(), random.bits(), random.bits(), random.bits()};
    items[0].random = uvec4(0);
    items[1].random = uvec4(UINT32_MAX);
    KernelConstants constants;
    constants[CONSTANT_VOLUMETRIC] = 1;
    return probe<DistanceResult>(device, kernels::distance, items, constants);
}

// The weight of a path that came as far as that, and scattered there or not.
dvec3 weight_at(const MediumCase& c, const DistanceResult& r) {
    const dvec3 passed = exp(-c.extinction() * std::min(double(r.t), 1e30));
    if (c.scattering == vec3(0)) return passed;
    const double pdf =
        r.scattered != 0 ? c.density(double(r.t)) : (1.0 - c.for_light()) * dot(c.share(), passed);
    return passed / pdf * (r.scattered != 0 ? dvec3(c.scattering) : dvec3(1.0));
}

// Vulkan's exp(x) is off by up to (3 + 2 |x|) ulp, and x by its rounding. So is the density that it is
// divided by, whose greatest term is that of a depth of 23 at most. A device may flush what is below 2^-126:
// the transmittance, or its product with the scattering, which is at least 2^-6 in media as dense.
bool is_near(double found, double expected, double depth) {
    const bool may_be_zero = depth > 120.0 * std::numbers::ln2;
    return std::abs(found - expected) <= (16.0 + 8.0 * (depth + 23.0)) * 0x1p-23 * expected ||
           (may_be_zero && found == 0.0);
}

void test_case(const vk::Device& device, const MediumCase& c, uint32_t seed, Evidence& evidence) {
    std::vector<double> counts(DISTANCE_CELLS + 1), expected(DISTANCE_CELLS + 1);
    const bool scatters = c.scattering != vec3(0);
    const double before_end = scatters ? 1.0 - c.passes() : 0.0;
    std::fill_n(expected.begin(), DISTANCE_CELLS, before_end / DISTANCE_CELLS);
    expected.back() = 1.0 - before_end;
    for (const DistanceResult& r : run_distances(device, c, seed)) {
        const dvec3 weight = weight_at(c, r);
        bool holds =
            r.t >= 0.0f && double(r.t) <= double(c.t_max) * (1.0 + 0x1p-22) && (r.scattered == 0 || scatters);
        for (const int i : {0, 1, 2}) {
            // A channel of which the path has no light does not count.
            if (c.beta[i] == 0.0f) continue;
            const double depth = c.extinction()[i] * std::min(double(r.t), 1e30);
            holds = holds && is_near(double(r.weight[i]), weight[i], depth);
        }
        evidence.expect(holds, [&] {
            return concat("medium ", c.name, ": at ", r.t, r.scattered != 0 ? " scattered" : "", ", weight ",
                          r.weight.x, ' ', r.weight.y, ' ', r.weight.z, ", not ", weight.x, ' ', weight.y,
                          ' ', weight.z);
        });
        const double place = before_end > 0.0 ? c.scattered_before(double(r.t)) / before_end : 0.0;
        const auto cell = std::min(size_t(place * DISTANCE_CELLS), DISTANCE_CELLS - 1);
        ++counts[r.scattered != 0 ? cell : DISTANCE_CELLS];
    }
    if (scatters) evidence.add_p_value(concat("medium ", c.name), pearson_p_value(counts, expected));
}

}  // namespace

Evidence test_distances(const vk::Device& device) {
    Evidence evidence;
    uint32_t seed = 2600;
    for (const MediumCase& c : medium_cases())
        test_case(device, c, seed++, evidence);
    return evidence;
}

}  // namespace candela
