// A computed sky as an image: what its sun and its upper half send, where they are, and what lies below.
#include "scene/sky.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/color.h"
#include "scene/atmosphere.h"
#include "scene/environment.h"
#include "unit/scene/slant_column.h"

namespace candela {
namespace {

constexpr double WHITE = M_PI;  // Irradiance of the sun outside the atmosphere.

Sky sky_at(double elevation, double azimuth) {
    return {.sun_elevation = glm::radians(elevation), .sun_azimuth = glm::radians(azimuth)};
}

dvec3 towards(const Environment& sky, uint32_t x, uint32_t y) {
    return latitude_longitude_direction({(x + 0.5) / sky.size.x, (y + 0.5) / sky.size.y});
}

// Irradiance on a surface that faces the sun from the disk alone: of all within half a degree, less as much
// of the sky as there is around it.
dvec3 sun_irradiance(const Environment& sky, const Sky& at) {
    const dvec3 sun(std::cos(at.sun_elevation) * std::sin(at.sun_azimuth), std::sin(at.sun_elevation),
                    std::cos(at.sun_elevation) * std::cos(at.sun_azimuth));
    dvec3 disk(0.0), ring(0.0);
    double disk_sr = 0.0, ring_sr = 0.0;
    for (uint32_t y = 0; y < sky.size.y; ++y) {
        const double sr = 2.0 * M_PI / sky.size.x *
                          (std::cos(M_PI * y / sky.size.y) - std::cos(M_PI * (y + 1) / sky.size.y));
        for (uint32_t x = 0; x < sky.size.x; ++x) {
            const double cosine = dot(towards(sky, x, y), sun);
            const dvec3 sent = sr * cosine * dvec3(sky.radiance[size_t{y} * sky.size.x + x]);
            if (cosine > std::cos(glm::radians(0.5))) {
                disk += sent;
                disk_sr += sr;
            } else if (cosine > std::cos(glm::radians(0.8))) {
                ring += sent;
                ring_sr += sr;
            }
        }
    }
    return disk - ring * (disk_sr / ring_sr);
}

// The closed form: the mean over the disk, in strips across it.
dvec3 expected_irradiance(double elevation) {
    const Air air = clear_air(Sky().turbidity);
    constexpr int STRIPS = 16;
    dvec3 sum(0.0);
    double width = 0.0;
    for (int i = 0; i < STRIPS; ++i) {
        const double y = -1.0 + 2.0 * (i + 0.5) / STRIPS, w = std::sqrt(1.0 - y * y);
        const double degrees = elevation + glm::degrees(SUN_RADIUS) * y;
        const dvec3 columns = slant_column(degrees > 90.0 ? 180.0 - degrees : degrees);
        Spectrum light;
        for (int k = 0; k < WAVELENGTHS; ++k)
            light[k] = std::exp(-dot(air[k], columns));
        sum += w * rgb_of(light);
        width += w;
    }
    return sum / width;
}

// Ref: IES Calculation Procedures Committee, "Recommended Practice for the Calculation of Daylight
// Availability", 1984: illuminance by a clear sky, from measurements, relative to that of the sun outside the
// atmosphere.
double measured_sun(double sine) {
    return std::exp(-0.21 / sine);
}
double measured_sky(double sine) {
    return (0.8 + 15.5 * std::sqrt(sine)) / 127.5;
}

struct SunPlace {
    double elevation, azimuth;
};

TEST(Sky, SunAndSkySendWhatTheyShould) {
    for (const auto& [elevation, azimuth] : {SunPlace{90, 0}, SunPlace{30, 123.4}, SunPlace{6, 3}}) {
        SCOPED_TRACE(elevation);
        const Sky at = sky_at(elevation, azimuth);
        const Environment sky = sky_environment(at);
        const dvec3 sun = sun_irradiance(sky, at), expected = expected_irradiance(elevation);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sun[c] / expected[c], 1.0, 1e-3);
        const double sine = std::sin(at.sun_elevation), total = M_PI * luminance(vec3(paper_radiance(sky))),
                     direct = luminance(vec3(sun)), diffuse = total - sine * direct;
        EXPECT_LT(total, WHITE * sine);
        if (elevation < 10.0) continue;  // The formulas are for a flat Earth.
        EXPECT_NEAR(direct / WHITE / measured_sun(sine), 1.0, 0.05);
        EXPECT_NEAR(diffuse / WHITE / measured_sky(sine), 1.0, 0.2);
    }
}

TEST(Sky, IsTheSameOnBothSidesOfTheSunAndTurnsWithIt) {
    const Environment ahead = sky_environment(sky_at(12, 180)), right = sky_environment(sky_at(12, 90));
    const uint32_t width = ahead.size.x;
    const auto expect_same = [](vec3 a, vec3 b) {
        // Azimuths are rounded at 2^-50 and, in the directions of subsamples of the disk's edge, may swap
        // sides.
        const float scale = 1e-5f * std::max({a.x, a.y, a.z}) + (a.x > 100.0f ? 0.01f * a.x : 0.0f);
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(a[c], b[c], scale);
    };
    for (uint32_t y = 0; y < ahead.size.y; y += 3) {
        for (uint32_t x = 0; x < width; ++x) {
            const vec3 here = ahead.radiance[size_t{y} * width + x];
            expect_same(here, ahead.radiance[size_t{y} * width + width - 1 - x]);
            expect_same(here, right.radiance[size_t{y} * width + (x + width / 4) % width]);
        }
    }
    // --view's azimuth 90 is +X.
    const auto brightest = std::ranges::max_element(right.radiance, {}, [](vec3 l) { return luminance(l); });
    const auto at = uint32_t(brightest - right.radiance.begin());
    EXPECT_GT(dot(towards(right, at % width, at / width),
                  dvec3(std::cos(glm::radians(12.0)), std::sin(glm::radians(12.0)), 0)),
              std::cos(glm::radians(0.3)));
}

TEST(Sky, TheGroundReflectsSunAndSky) {
    Sky at = sky_at(40, 0);
    at.ground = vec3(0.6f, 0.3f, 0.0f);
    const Environment sky = sky_environment(at);
    const vec3 below = sky.radiance.back(), paper = vec3(paper_radiance(sky));
    // A hundred metres of air take and add a hundredth of the light.
    EXPECT_NEAR(below.x / (0.6f * paper.x), 1.0f, 0.02f);
    EXPECT_NEAR(below.y / (0.3f * paper.y), 1.0f, 0.02f);
    EXPECT_LT(below.z, 0.02f * paper.z);
    EXPECT_GT(below.z, 0.0f);
}

// The eye is a little above the ground, so that it sees all of a sun whose middle is at 0 degrees.
TEST(Sky, ASettingSunReachesBelowTheMiddleOfTheImage) {
    Sky at = sky_at(0, 180);
    at.turbidity = 1.0;
    const Environment sky = sky_environment(at);
    const vec3* const row = &sky.radiance[size_t{sky.size.y / 2} * sky.size.x];
    EXPECT_GT(row[sky.size.x / 2].x, 100.0f * row[sky.size.x / 2 + 4].x);
}

TEST(Sky, IsDimmerAfterSunsetAndHasNoSun) {
    const Environment dusk = sky_environment(sky_at(-5, 0));
    float brightest = 0.0f;
    for (const vec3 radiance : dusk.radiance) {
        ASSERT_TRUE(is_finite(radiance) && std::min({radiance.x, radiance.y, radiance.z}) >= 0.0f);
        brightest = std::max(brightest, luminance(radiance));
    }
    // Ref: illuminance at -5 degrees is between 3.4 lx at the end of civil twilight and 400 lx at sunset, of
    // 133 000 lx (e.g. Seidelmann, "Explanatory Supplement to the Astronomical Almanac", 1992).
    const double paper = luminance(vec3(paper_radiance(dusk)));
    EXPECT_GT(paper, 3.4 / 133000.0);
    EXPECT_LT(paper, 400.0 / 133000.0);
    EXPECT_LT(brightest, 100.0 * paper);
}

}  // namespace
}  // namespace candela
