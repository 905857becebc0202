// See warps.h.
#include "selftest/warps.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/statistics.h"
#include "base/text.h"
#include "probe/probe.h"
#include "probe/random.h"
#include "selftest/bsdfs.h"
#include "selftest/charts.h"
#include "selftest/histogram.h"

namespace candela {
namespace {

constexpr size_t WARP_CELLS = 8;         // Along each axis of a histogram.
constexpr size_t WARP_SAMPLES = 400000;  // With this many cells, enough to reveal a density that is 2 % off.

// Adds the p-value of the hypothesis that coordinates(result), in [0, 1]^2, are uniform.
template <class Coordinates>
void test_uniformity(const std::string& name, const std::vector<WarpResult>& results,
                     const Coordinates& coordinates, Evidence& evidence) {
    Histogram points(WARP_CELLS);
    for (const WarpResult& r : results)
        points.add(coordinates(r));
    evidence.add_p_value(name, points.uniformity());
}

// 1 - cos of a unit vector's angle to +z, without cancellation around the pole.
double height(vec3 w) {
    const double sine_squared = double(w.x) * double(w.x) + double(w.y) * double(w.y);
    return w.z > 0.0f ? sine_squared / (1.0 + double(w.z)) : 1.0 - double(w.z);
}

// A point of the polygon as (sum^2, (k + b2 / sum) / corners), where it is b1 times corner k plus b2
// times the next one and sum = b1 + b2.
glm::dvec2 in_polygon(vec2 p, uint32_t corners) {
    const double step = 2.0 * M_PI / corners, angle = std::atan2(double(p.y), double(p.x));
    const double k = std::floor((angle < 0.0 ? angle + 2.0 * M_PI : angle) / step);
    const glm::dvec2 c1(std::cos(k * step), std::sin(k * step));
    const glm::dvec2 c2(std::cos((k + 1.0) * step), std::sin((k + 1.0) * step));
    const double det = c1.x * c2.y - c1.y * c2.x;
    const double b1 = (double(p.x) * c2.y - double(p.y) * c2.x) / det;
    const double b2 = (c1.x * double(p.y) - c1.y * double(p.x)) / det;
    const double sum = b1 + b2;
    return {sum * sum, (k + (sum > 0.0 ? b2 / sum : 0.0)) / corners};
}

// The share of a filter by Blackman and Harris below x in [-1, 1], along one axis.
double blackman_harris_below(float x) {
    const auto part = [&](double weight, int k) {
        return weight * std::sin(k * M_PI * double(x)) / (k * M_PI);
    };
    const double sum = part(0.48829, 1) + part(0.14128, 2) + part(0.01168, 3);
    return 0.5 + 0.5 * (double(x) + sum / 0.35875);
}

double tent_below(float x) {
    const double tail = 0.5 * std::pow(1.0 - std::abs(double(x)), 2.0);
    return x < 0.0f ? tail : 1.0 - tail;
}

// The fraction of visible normals in each cell, up to a factor, by slopes (x, y) = alpha sqrt(a / (1 - a))
// (cos, sin): d(slopes) = pi alpha^2 / (1 - a)^2 da db, d(normal) = n.z^3 d(slopes), with 1 - a = (1 - s)^2.
// The density is D(n) max(0, w.n) over the projected area of all facets that w sees, which a sum over the
// cells gives as well as Smith's formula does; it is continuous, so that the midpoint rule is good to 10^-3.
std::vector<double> visible_normals(vec3 w, float alpha) {
    constexpr size_t FINE = 32, ALONG = WARP_CELLS * FINE;
    std::vector<double> expected(WARP_CELLS * WARP_CELLS);
    for (size_t i = 0; i < ALONG * ALONG; ++i) {
        const size_t row = i / ALONG, column = i % ALONG;
        const double t = 1.0 - (double(row) + 0.5) / ALONG;
        const double phi = 2.0 * M_PI * ((double(column) + 0.5) / ALONG - 0.5);
        const double r = double(alpha) * std::sqrt(1.0 - t * t) / t;
        const glm::dvec3 n = normalize(glm::dvec3(r * std::cos(phi), r * std::sin(phi), 1.0));
        // D n.z^4 is the density of slopes, uniform in (a, b); d(normal) has n.z^3 of it, which leaves 1 /
        // n.z.
        const double fraction = std::max(0.0, dot(glm::dvec3(w), n)) / n.z * 2.0 * t;
        expected[row / FINE * WARP_CELLS + column / FINE] += fraction;
    }
    return expected;
}

void test_visible_normals_of(const vk::Device& device, vec3 w, float alpha, Evidence& evidence) {
    const std::string name = concat("visible normals of roughness ", alpha, ", cosine ", w.z);
    Histogram points(WARP_CELLS);
    for (const WarpResult& result : run_warps(device, 11, {.w = w, .alpha = alpha})) {
        const glm::dvec3 n(result.normal);
        evidence.expect(std::abs(length(n) - 1.0) <= 0x1p-20 && n.z > 0.0,
                        [&] { return concat(name, ": ", n.x, ' ', n.y, ' ', n.z); });
        const double r = std::hypot(n.x, n.y) / (double(alpha) * n.z);
        points.add({1.0 - 1.0 / std::sqrt(1.0 + r * r), turn_of(n.y, n.x)});
    }
    // A cell without a midpoint visible from w may have a visible sliver.
    const std::vector<double> expected = visible_normals(w, alpha);
    for (size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] > 0.0) continue;
        const double found = std::exchange(points.counts[i], 0.0);
        evidence.expect(found < 10.0, [&] { return concat(name, ": ", found, " where none is seen"); });
    }
    evidence.add_p_value(name, pearson_p_value(points.counts, expected));
}

}  // namespace

std::vector<WarpResult> run_warps(const vk::Device& device, uint32_t seed, const WarpItem& parameters) {
    Random random(seed);
    std::vector<WarpItem> items(WARP_SAMPLES, parameters);
    for (WarpItem& item : items)
        item.u = random.square();
    return probe<WarpResult>(device, kernels::warp, items);
}

// Each in coordinates with a uniform density: r^2 and angle on the disk; cos^2 and angle on the hemisphere;
// (b1 + b2)^2 and b2 / (b1 + b2) on the triangle.
Evidence test_basic_warps(const vk::Device& device) {
    const std::vector<WarpResult> results = run_warps(device, 5);
    const auto on_disk = [](const WarpResult& r) {
        const glm::dvec2 d(r.disk);
        return glm::dvec2(dot(d, d), turn_of(d.y, d.x));
    };
    const auto on_hemisphere = [](const WarpResult& r) {
        const glm::dvec3 w(r.direction);
        return glm::dvec2(w.z * w.z, turn_of(w.y, w.x));
    };
    const auto on_triangle = [](const WarpResult& r) {
        const double sum = double(r.triangle.x) + double(r.triangle.y);
        return glm::dvec2(sum * sum, sum > 0.0 ? double(r.triangle.y) / sum : 0.0);
    };
    Evidence evidence;
    test_uniformity("disk", results, on_disk, evidence);
    test_uniformity("hemisphere", results, on_hemisphere, evidence);
    test_uniformity("triangle", results, on_triangle, evidence);
    return evidence;
}

// In the coordinates of the distribution function and the angle.
Evidence test_power_cosines(const vk::Device& device) {
    Evidence evidence;
    for (const float n : {0.0f, 1.0f, 7.5f, 100.0f, 1e4f, 1e5f}) {
        const auto coordinates = [n](const WarpResult& r) {
            const double a = std::exp((double(n) + 1.0) * std::log1p(-height(r.power_cosine)));
            return glm::dvec2(a, turn_of(r.power_cosine.y, r.power_cosine.x));
        };
        test_uniformity(concat("cosine to the power of ", n), run_warps(device, 7, {.exponent = n}),
                        coordinates, evidence);
    }
    return evidence;
}

// The sine of a direction has a root, by Vulkan's table off by 9 * 2^-24, and the cosine or sine of the
// azimuth, off by 4; its square, from which the height is computed, is off by twice that.
Evidence test_sphere_and_cones(const vk::Device& device) {
    Evidence evidence;
    for (const float h_max : {1e-8f, 1e-3f, 0.5f, 1.0f, 2.0f}) {
        const std::string name = concat("cone of height ", h_max);
        const std::vector<WarpResult> results = run_warps(device, 8, {.h_max = h_max});
        for (const WarpResult& r : results) {
            evidence.expect(std::abs(length(glm::dvec3(r.cone)) - 1.0) <= 0x1p-20 &&
                                height(r.cone) <= double(h_max) * (1.0 + 0x1p-19),
                            [&] { return concat(name, ": ", r.cone.x, ' ', r.cone.y, ' ', r.cone.z); });
        }
        const auto coordinates = [h_max](const WarpResult& r) {
            return glm::dvec2(height(r.cone) / double(h_max), turn_of(r.cone.y, r.cone.x));
        };
        test_uniformity(name, results, coordinates, evidence);
    }
    const auto on_sphere = [](const WarpResult& r) {
        return glm::dvec2(height(r.sphere) / 2.0, turn_of(r.sphere.y, r.sphere.x));
    };
    test_uniformity("sphere", run_warps(device, 9), on_sphere, evidence);
    return evidence;
}

// Points are uniform over the area, and within the sides up to some roundings: the angle of a corner has a
// division of 2.5 ulp of a turn, 16 * 2^-24, its cosine and sine 4, over a distance of at least 1/2 from the
// centre to a side; the square has twice all that.
Evidence test_polygons(const vk::Device& device) {
    Evidence evidence;
    for (const uint32_t corners : {3u, 4u, 5u, 6u, 64u}) {
        const std::string name = concat("polygon of ", corners);
        const std::vector<WarpResult> results = run_warps(device, 10, {.corners = corners});
        for (const WarpResult& r : results) {
            evidence.expect(in_polygon(r.polygon, corners).x <= 1.0 + 0x1p-17,
                            [&] { return concat(name, ": ", r.polygon.x, ' ', r.polygon.y); });
        }
        test_uniformity(
            name, results, [&](const WarpResult& r) { return in_polygon(r.polygon, corners); }, evidence);
    }
    return evidence;
}

// In the coordinates of the distribution functions.
Evidence test_pixel_filters(const vk::Device& device) {
    Evidence evidence;
    const std::vector<WarpResult> results = run_warps(device, 12);
    const auto test = [&](const char* name, const auto& coordinates) {
        test_uniformity(name, results, coordinates, evidence);
    };
    test("tent", [](const WarpResult& r) { return glm::dvec2(tent_below(r.tent.x), tent_below(r.tent.y)); });
    test("gaussian", [](const WarpResult& r) {
        const glm::dvec2 d(r.gaussian);
        return glm::dvec2(std::expm1(-4.5 * dot(d, d)) / std::expm1(-4.5), turn_of(d.y, d.x));
    });
    test("blackman-harris", [](const WarpResult& r) {
        return glm::dvec2(blackman_harris_below(r.blackman_harris.x),
                          blackman_harris_below(r.blackman_harris.y));
    });
    return evidence;
}

Evidence test_visible_normals(const vk::Device& device) {
    Evidence evidence;
    for (const vec3 w : VIEWS) {
        for (const float alpha : {0.01f, 0.3f, 1.0f})
            test_visible_normals_of(device, w, alpha, evidence);
    }
    return evidence;
}

}  // namespace candela
