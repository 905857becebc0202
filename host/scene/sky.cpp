// See sky.h.
#include "scene/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/color.h"
#include "scene/atmosphere.h"
#include "scene/environment.h"

namespace candela {
namespace {

constexpr uvec2 SIZE(2048, 1024);  // The sun is three texels wide.
constexpr int AZIMUTHS = 16;       // At which the sky is computed: from that of the sun to the opposite one.

// What is scattered towards the eye in a direction, but for the phase functions; and what the air leaves of
// light from the ground there.
struct Scattered {
    dvec3 molecules, aerosol, rest;

    Scattered& operator+=(const Scattered& other) {
        molecules += other.molecules;
        aerosol += other.aerosol;
        rest += other.rest;
        return *this;
    }
    Scattered operator*(double factor) const { return {factor * molecules, factor * aerosol, factor * rest}; }
};

dvec3 sun_direction(const Sky& sky) {
    const double across = std::cos(sky.sun_elevation);
    return {across * std::sin(sky.sun_azimuth), std::sin(sky.sun_elevation),
            across * std::cos(sky.sun_azimuth)};
}

// A column of the image: a horizontal direction, and a curve (Catmull-Rom) through what is computed at four
// azimuths around it.
struct Column {
    dvec3 towards;
    std::array<int, 4> azimuths;
    std::array<double, 4> weights;
};

std::vector<Column> columns_of(const Sky& sky) {
    std::vector<Column> columns;
    for (uint32_t x = 0; x < SIZE.x; ++x) {
        const dvec3 towards = latitude_longitude_direction({(x + 0.5) / SIZE.x, 0.5});
        const double from_sun =
            std::remainder(std::atan2(towards.x, towards.z) - sky.sun_azimuth, 2.0 * std::numbers::pi);
        const double at = std::abs(from_sun) / std::numbers::pi * AZIMUTHS;
        const int i = std::min(int(at), AZIMUTHS - 1);
        const double t = at - i;
        // Both sides of the sun's meridian are alike.
        columns.push_back({towards,
                           {std::abs(i - 1), i, i + 1, std::min(i + 2, 2 * AZIMUTHS - i - 2)},
                           {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
                            0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)}});
    }
    return columns;
}

// A row of the image at these azimuths.
std::array<Scattered, AZIMUTHS + 1> scattered_in_row(const Atmosphere& atmosphere, const Sky& sky,
                                                     double theta, dvec3 paper) {
    Spectrum all;
    all.fill(1.0);
    const dvec3 sunlight = rgb_of(all), sun(std::cos(sky.sun_elevation), std::sin(sky.sun_elevation), 0.0);
    std::array<Scattered, AZIMUTHS + 1> row;
    for (int i = 0; i <= AZIMUTHS; ++i) {
        const double azimuth = std::numbers::pi * i / AZIMUTHS;
        const ScatteredLight light = atmosphere.scattered(
            {std::sin(theta) * std::cos(azimuth), std::cos(theta), std::sin(theta) * std::sin(azimuth)}, sun);
        row[i] = {rgb_of(light.molecules), rgb_of(light.aerosol), rgb_of(light.multiple)};
        if (light.meets_ground) row[i].rest += dvec3(sky.ground) * paper * rgb_of(light.passing) / sunlight;
    }
    return row;
}

// Adds the sky to rows, and a ground on which white paper has that radiance.
void add_sky(Environment& environment, const Atmosphere& atmosphere, const Sky& sky, uint32_t first_row,
             uint32_t end_row, dvec3 paper) {
    const dvec3 sun = sun_direction(sky);
    const std::vector<Column> columns = columns_of(sky);
    for (uint32_t y = first_row; y < end_row; ++y) {
        const double theta = std::numbers::pi * (y + 0.5) / SIZE.y;
        const auto row = scattered_in_row(atmosphere, sky, theta, paper);
        for (uint32_t x = 0; x < SIZE.x; ++x) {
            const Column& column = columns[x];
            Scattered part{};
            for (int i = 0; i < 4; ++i)
                part += row[column.azimuths[i]] * column.weights[i];
            const double cosine = dot(std::sin(theta) * column.towards + dvec3(0, std::cos(theta), 0), sun);
            const dvec3 light =
                molecule_phase(cosine) * part.molecules + aerosol_phase(cosine) * part.aerosol + part.rest;
            environment.radiance[size_t{y} * SIZE.x + x] += vec3(glm::max(light, dvec3(0.0)));
        }
    }
}

// Adds the sun's disk: to each texel the share of it that the disk covers.
void add_sun(Environment& environment, const Atmosphere& atmosphere, const Sky& sky) {
    constexpr int PARTS = 16;  // Of a texel, along each axis.
    constexpr double STEP = std::numbers::pi / SIZE.y;
    const dvec3 sun = sun_direction(sky);
    const double theta = 0.5 * std::numbers::pi - sky.sun_elevation, edge = std::cos(SUN_RADIUS);
    const auto row_of = [&](double angle) {
        return uint32_t(std::clamp(angle / STEP, 0.0, double(SIZE.y - 1)));
    };
    struct Covered {
        size_t texel;
        dvec3 light;  // Mean over the texel, as if the disk covered 1 sr.
    };
    std::vector<Covered> covered;
    double solid_angle = 0.0;
    for (uint32_t y = row_of(theta - SUN_RADIUS); y <= row_of(theta + SUN_RADIUS); ++y) {
        std::array<dvec3, PARTS> colours;
        for (int j = 0; j < PARTS; ++j) {
            const double angle = (y + (j + 0.5) / PARTS) * STEP;
            colours[j] = rgb_of(atmosphere.transmittance({std::sin(angle), std::cos(angle), 0.0}));
        }
        const double weight = 2.0 * STEP * std::sin((y + 0.5) * STEP) * std::sin(0.5 * STEP);  // [sr]
        for (uint32_t x = 0; x < SIZE.x; ++x) {
            const dvec3 middle = latitude_longitude_direction({(x + 0.5) / SIZE.x, (y + 0.5) / SIZE.y});
            if (dot(middle, sun) < std::cos(SUN_RADIUS + STEP)) continue;
            dvec3 light(0.0);
            for (int part = 0; part < PARTS * PARTS; ++part) {
                const int i = part % PARTS, j = part / PARTS;
                const glm::dvec2 at((x + (i + 0.5) / PARTS) / SIZE.x, (y + (j + 0.5) / PARTS) / SIZE.y);
                if (dot(latitude_longitude_direction(at), sun) < edge) continue;
                light += colours[j] / double(PARTS * PARTS);
                solid_angle += weight / (PARTS * PARTS);
            }
            covered.push_back({size_t{y} * SIZE.x + x, light});
        }
    }
    for (const Covered& part : covered)
        environment.radiance[part.texel] += vec3(glm::max(part.light / solid_angle, dvec3(0.0)));
}

}  // namespace

Environment sky_environment(const Sky& sky) {
    const Atmosphere atmosphere(clear_air(sky.turbidity), luminance(sky.ground));
    Environment environment{.size = SIZE, .radiance = std::vector<vec3>(size_t{SIZE.x} * SIZE.y)};
    add_sky(environment, atmosphere, sky, 0, SIZE.y / 2, dvec3(0.0));
    add_sun(environment, atmosphere, sky);
    add_sky(environment, atmosphere, sky, SIZE.y / 2, SIZE.y, paper_radiance(environment));
    return environment;
}

}  // namespace candela
