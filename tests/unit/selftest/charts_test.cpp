// Charts of directions: there and back, their solid angles, and what they do at poles and borders.
#include "selftest/charts.h"

#include <array>
#include <random>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace candela {
namespace {

using Chart = std::variant<SphereChart, LobeChart, FacetChart>;

const std::array<glm::dvec3, 3> VIEWS{glm::dvec3(0, 0, 1), normalize(glm::dvec3(1, 0.5, 1)),
                                      normalize(glm::dvec3(-1, 2, 0.01))};

// The last one is that of the narrowest facets seen at a grazing angle.
std::vector<Chart> charts() {
    std::vector<Chart> all{SphereChart()};
    for (const glm::dvec3 view : VIEWS) {
        for (const double n : {0.0, 7.5, 1e3, 1e5})
            all.emplace_back(LobeChart(view, n));
        for (const double alpha : {1.0, 0.1, 1e-3})
            all.emplace_back(FacetChart(view, alpha));
    }
    return all;
}

ChartPoint at(const Chart& chart, double a, double b) {
    return std::visit([&](const auto& c) { return c.at(a, b); }, chart);
}

std::optional<glm::dvec2> find(const Chart& chart, glm::dvec3 w) {
    return std::visit([&](const auto& c) -> std::optional<glm::dvec2> { return c.find(w); }, chart);
}

// Facets that face away from the viewer have no place of their own: what they would reflect is below the
// surface, and so are some directions that others reflect. Nothing is sampled there.
bool is_sampled(const Chart& chart, glm::dvec3 w) {
    return !std::holds_alternative<FacetChart>(chart) || w.z > 0.0;
}

// Directions have an error of 2^-53; what is 10^-3 wide, at alpha = 10^-3 or an exponent of 10^5, and seen at
// the cosine 0.0045 of the grazing view, is known to 2^-53 / 10^-6 / 0.01.
constexpr double CHART_ROUNDING = 1e-7;

TEST(Charts, FindWhatTheyShow) {
    const std::vector<Chart> all = charts();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(1e-3, 1.0 - 1e-3);
    for (size_t k = 0; k < all.size(); ++k) {
        for (int i = 0; i < 1000; ++i) {
            const glm::dvec2 place(unit(random), unit(random));
            const ChartPoint point = at(all[k], place.x, place.y);
            ASSERT_NEAR(length(point.w), 1.0, 1e-12);
            if (!is_sampled(all[k], point.w)) continue;
            const std::optional<glm::dvec2> found = find(all[k], point.w);
            ASSERT_TRUE(found);
            ASSERT_LE(length(*found - place), CHART_ROUNDING)
                << "chart " << k << " at " << place.x << ' ' << place.y;
        }
    }
}

// The area on the sphere of a small square of the chart, by central differences; their step of 10^-4 costs
// 10^-8 times a third derivative, which near the rim (not nearer than 0.05) is some 10^4 at most.
TEST(Charts, SolidAnglesAreThoseOfTheirCells) {
    const std::vector<Chart> all = charts();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0.05, 0.95);
    for (size_t k = 0; k < all.size(); ++k) {
        for (int i = 0; i < 1000; ++i) {
            const double a = unit(random), b = unit(random), step = 1e-4;
            const glm::dvec3 along_a = at(all[k], a + step, b).w - at(all[k], a - step, b).w;
            const glm::dvec3 along_b = at(all[k], a, b + step).w - at(all[k], a, b - step).w;
            const double area = length(cross(along_a, along_b)) / (4.0 * step * step);
            const double expected = at(all[k], a, b).solid_angle;
            ASSERT_NEAR(area / expected, 1.0, 1e-4) << "chart " << k << " at " << a << ' ' << b;
        }
    }
}

// At a pole the angle is not defined: it is some number of [0, 1], and the pole is in the cell at the chart's
// edge.
TEST(Charts, PolesAreInTheChart) {
    for (const double sign : {-1.0, 1.0}) {
        const glm::dvec2 place = SphereChart().find(glm::dvec3(0, 0, sign)).value();
        EXPECT_EQ(place.x, sign < 0.0 ? 0.0 : 1.0);
        EXPECT_TRUE(place.y >= 0.0 && place.y <= 1.0);
    }
    for (const glm::dvec3 view : VIEWS) {
        const glm::dvec2 axis = LobeChart(view, 1e5).find(view).value();
        EXPECT_NEAR(axis.x, 0.0, 1e-9);
        EXPECT_TRUE(axis.y >= 0.0 && axis.y <= 1.0);
        EXPECT_FALSE(LobeChart(view, 1e5).find(-view)) << "the other pole is outside of the cone";
        const glm::dvec2 flat = FacetChart(view, 1e-3).find(glm::dvec3(-view.x, -view.y, view.z)).value();
        EXPECT_NEAR(flat.x, 0.0, 1e-6);
        EXPECT_TRUE(flat.y >= 0.0 && flat.y <= 1.0);
    }
}

// The margin for poles and borders: directions from a device are rounded by some 2^-24, so that samples next
// to a border are counted on its other side, most of them around the poles, where cells are narrow: one in a
// thousand at most. (As many come as go.) In the narrowest facets seen at grazing angles it is one in ten:
// their normals come from a sum of directions of the length 0.009 and are known to 2^-24 / 0.009, which is
// 0.7 % of alpha = 10^-3, and a cell is 6 % wide.
TEST(Charts, RoundingMovesFewSamplesToAnotherCell) {
    constexpr double CELLS = 16.0;
    constexpr size_t SAMPLES = 40000;
    const std::vector<Chart> all = charts();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit, error(-0x1p-24, 0x1p-24);
    for (size_t k = 0; k < all.size(); ++k) {
        const bool narrow_and_grazing = k + 1 == all.size();
        size_t moved = 0;
        for (size_t i = 0; i < SAMPLES; ++i) {
            const glm::dvec2 place(unit(random), unit(random));
            const glm::dvec3 w = at(all[k], place.x, place.y).w;
            if (!is_sampled(all[k], w)) continue;
            const glm::dvec3 rounded = w + glm::dvec3(error(random), error(random), error(random));
            const std::optional<glm::dvec2> found = find(all[k], rounded);
            moved += !found || floor(CELLS * *found) != floor(CELLS * place);
        }
        EXPECT_LE(moved, SAMPLES / (narrow_and_grazing ? 10 : 1000)) << "chart " << k;
    }
}

}  // namespace
}  // namespace candela
