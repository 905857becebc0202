// See atmosphere.h. Lengths are in km. A column is the air along a ray, relative to that above the sea,
// straight up: of molecules, aerosol and ozone.
#include "scene/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace candela {
namespace {

constexpr double EARTH = 6371.0, TOP = EARTH + 100.0;
constexpr double FIRST_WAVELENGTH = 380.0, LAST_WAVELENGTH = 740.0;  // [nm]

// Share of what aerosol takes from a ray that it scatters; it absorbs the rest. Ref: Bruneton and Neyret,
// "Precomputed Atmospheric Scattering", 2008.
constexpr double AEROSOL_ALBEDO = 0.9;

// [1/km] Ref: the scale heights of Bruneton and Neyret; ozone between 10 and 40 km, most at 25 km.
dvec3 density(double height) {
    constexpr double MOLECULES = 8.0, AEROSOL = 1.2, OZONE = 25.0, HALF_LAYER = 15.0;
    return {std::exp(-height / MOLECULES) / MOLECULES, std::exp(-height / AEROSOL) / AEROSOL,
            std::max(0.0, 1.0 - std::abs(height - OZONE) / HALF_LAYER) / HALF_LAYER};
}

bool meets_ground(double radius, double mu) {
    return mu < 0.0 && radius * std::sqrt(1.0 - mu * mu) < EARTH;
}

// To the atmosphere's end.
double distance_to_top(double radius, double mu) {
    return -radius * mu + std::sqrt(radius * radius * (mu * mu - 1.0) + TOP * TOP);
}

// The column from a point to space, along a ray that does not meet the ground.
dvec3 column(double radius, double mu) {
    if (mu < 0.0)  // As far down as up again, and on.
        return 2.0 * column(radius * std::sqrt(1.0 - mu * mu), 0.0) - column(radius, -mu);
    constexpr int STEPS = 128;
    const double length = distance_to_top(radius, mu);
    dvec3 sum(0.0);
    for (int i = 0; i < STEPS; ++i) {
        const double s = (i + 0.5) / STEPS, t = length * s * s;  // Most points where the air is dense.
        const double height = std::sqrt(radius * radius + t * t + 2.0 * radius * mu * t) - EARTH;
        sum += 2.0 * s * length / STEPS * density(height);
    }
    return sum;
}

// A place between two of `size` numbers.
struct Place {
    int first;
    double share;  // Of the next one.
};

Place place_in(int size, double x) {
    const double at = std::clamp(x, 0.0, 1.0) * (size - 1);
    const int first = std::min(int(at), size - 2);
    return {first, at - first};
}

constexpr int COLUMN_RADII = 48, COLUMN_SLANTS = 128;
// Of the tangent from the ground to the top.
const double LONGEST = std::sqrt(TOP * TOP - EARTH * EARTH);

constexpr int MULTIPLE_HEIGHTS = 20, MULTIPLE_SUNS = 28;
constexpr double LOWEST_SUN = -0.6;  // By sine * |sine| of its elevation.

}  // namespace

double wavelength(int i) {
    return FIRST_WAVELENGTH + (i + 0.5) * (LAST_WAVELENGTH - FIRST_WAVELENGTH) / WAVELENGTHS;
}

// Ref: Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions",
// 2013, multi-lobe fit; ITU-R BT.709 for the matrix. The sun is a black body of 5900 K, which has the colour
// of sunlight outside the atmosphere as ASTM G173 states it, within 0.5 % in each channel.
static std::array<dvec3, WAVELENGTHS> rgb_weights() {
    std::array<dvec3, WAVELENGTHS> weights;
    double sum = 0.0;
    for (int i = 0; i < WAVELENGTHS; ++i) {
        const double nm = wavelength(i);
        const auto lobe = [nm](double middle, double below, double above) {
            const double x = (nm - middle) / (nm < middle ? below : above);
            return std::exp(-0.5 * x * x);
        };
        const dvec3 xyz(1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) -
                            0.065 * lobe(501.1, 20.4, 26.2),
                        0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
                        1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8));
        constexpr double SECOND_RADIATION = 1.438777e7, SUN = 5900.0;  // [nm K], [K]
        const dvec3 seen = xyz / (std::pow(nm, 5.0) * std::expm1(SECOND_RADIATION / (nm * SUN)));
        weights[i] = {3.2404542 * seen.x - 1.5371385 * seen.y - 0.4985314 * seen.z,
                      -0.9692660 * seen.x + 1.8760108 * seen.y + 0.0415560 * seen.z,
                      0.0556434 * seen.x - 0.2040259 * seen.y + 1.0572252 * seen.z};
        sum += seen.y;
    }
    for (dvec3& weight : weights)
        weight *= std::numbers::pi / sum;
    return weights;
}

dvec3 rgb_of(const Spectrum& light) {
    static const std::array<dvec3, WAVELENGTHS> weights = rgb_weights();
    dvec3 rgb(0.0);
    for (int i = 0; i < WAVELENGTHS; ++i)
        rgb += light[i] * weights[i];
    return rgb;
}

// Ref: Hansen and Travis, "Light Scattering in Planetary Atmospheres", 1974, equation 2.30, for molecules;
// Angstrom's law, with the exponent of Preetham et al., "A Practical Analytic Model for Daylight", 1999, for
// aerosol. Ozone: 300 Dobson units, whose Chappuis band is a Gaussian fitted to the cross sections of
// Serdyuchenko et al., 2014, at 233 K (within a tenth of their maximum).
Air clear_air(double turbidity) {
    const auto molecules = [](double um) {
        const double q = 1.0 / (um * um);
        return 0.008569 * q * q * (1.0 + 0.0113 * q + 0.00013 * q * q);
    };
    constexpr double MIDDLE = 0.55, EXPONENT = 1.3;                                    // [um]
    constexpr double OZONE = 300.0 * 2.687e20 * 4.71e-25, BAND = 592.0, WIDTH = 53.7;  // [nm]
    Air air;
    for (int i = 0; i < WAVELENGTHS; ++i) {
        const double nm = wavelength(i), um = 1e-3 * nm, x = (nm - BAND) / WIDTH;
        air[i] = {molecules(um), (turbidity - 1.0) * molecules(MIDDLE) * std::pow(um / MIDDLE, -EXPONENT),
                  OZONE * std::exp(-0.5 * x * x)};
    }
    return air;
}

double molecule_phase(double cosine) {
    return 3.0 / (16.0 * std::numbers::pi) * (1.0 + cosine * cosine);
}

// Ref: Cornette and Shanks, "Physically Reasonable Analytic Expression for the Single-Scattering Phase
// Function", 1992; the asymmetry of Bruneton and Neyret.
double aerosol_phase(double cosine) {
    constexpr double G = 0.76, G2 = G * G;
    const double distance = 1.0 + G2 - 2.0 * G * cosine;
    return 3.0 / (8.0 * std::numbers::pi) * (1.0 - G2) * (1.0 + cosine * cosine) /
           ((2.0 + G2) * distance * std::sqrt(distance));
}

Atmosphere::Atmosphere(const Air& air, double albedo) : air_(air), albedo_(albedo) {
    // Ref: Bruneton and Neyret, for the places of the columns: most are near the horizon.
    for (int i = 0; i < COLUMN_RADII; ++i) {
        const double rho = LONGEST * i / (COLUMN_RADII - 1), radius = std::hypot(rho, EARTH);
        for (int j = 0; j < COLUMN_SLANTS; ++j) {
            const double d = (TOP - radius) + (rho + LONGEST - (TOP - radius)) * j / (COLUMN_SLANTS - 1);
            const double mu = d > 0.0 ? ((TOP - radius) * (TOP + radius) - d * d) / (2.0 * radius * d) : 1.0;
            columns_.push_back(column(radius, std::clamp(mu, -rho / radius, 1.0)));
        }
    }
    for (int i = 0; i < MULTIPLE_HEIGHTS; ++i) {
        const double s = double(i) / (MULTIPLE_HEIGHTS - 1);
        for (int j = 0; j < MULTIPLE_SUNS; ++j) {
            const double x = LOWEST_SUN + (1.0 - LOWEST_SUN) * j / (MULTIPLE_SUNS - 1);
            multiple_.push_back(isotropic({EARTH + (TOP - EARTH) * s * s, x * std::abs(x)}));
        }
    }
}

dvec3 Atmosphere::stored_columns(Slant slant) const {
    const double rho = std::sqrt(std::max(slant.radius * slant.radius - EARTH * EARTH, 0.0));
    const double least = TOP - slant.radius;
    const Place i = place_in(COLUMN_RADII, rho / LONGEST),
                j = place_in(COLUMN_SLANTS,
                             (distance_to_top(slant.radius, slant.mu) - least) / (rho + LONGEST - least));
    const dvec3* const row = &columns_[size_t(i.first) * COLUMN_SLANTS + j.first];
    return glm::mix(glm::mix(row[0], row[1], j.share),
                    glm::mix(row[COLUMN_SLANTS], row[COLUMN_SLANTS + 1], j.share), i.share);
}

Spectrum Atmosphere::stored_multiple(Slant slant) const {
    const double x = std::copysign(std::sqrt(std::abs(slant.mu)), slant.mu);
    const Place i = place_in(MULTIPLE_HEIGHTS, std::sqrt((slant.radius - EARTH) / (TOP - EARTH))),
                j = place_in(MULTIPLE_SUNS, (x - LOWEST_SUN) / (1.0 - LOWEST_SUN));
    const Spectrum* const row = &multiple_[size_t(i.first) * MULTIPLE_SUNS + j.first];
    Spectrum light;
    for (int k = 0; k < WAVELENGTHS; ++k)
        light[k] = std::lerp(std::lerp(row[0][k], row[1][k], j.share),
                             std::lerp(row[MULTIPLE_SUNS][k], row[MULTIPLE_SUNS + 1][k], j.share), i.share);
    return light;
}

// The share of sunlight that reaches a point.
Spectrum Atmosphere::sunlight(Slant slant) const {
    Spectrum light{};
    if (meets_ground(slant.radius, slant.mu)) return light;
    const dvec3 columns = stored_columns(slant);
    for (int k = 0; k < WAVELENGTHS; ++k)
        light[k] = std::exp(-dot(air_[k], columns));
    return light;
}

// Calls `step(point, seen)` for each part of a ray, from that distance from the Earth's centre to the ground
// or to space. In the point, the Earth's centre is the origin; `seen` has, at each wavelength, the share of
// light that molecules and aerosol scatter there and that comes back along the ray. Tells `light` how the ray
// ends.
template <class Step>
void Atmosphere::follow(double radius, dvec3 towards, int steps, ScatteredLight& light,
                        const Step& step) const {
    const double mu = towards.y;
    light.passing.fill(1.0);
    light.meets_ground = meets_ground(radius, mu);
    const double length = light.meets_ground
                              ? -radius * mu - std::sqrt(EARTH * EARTH - radius * radius * (1.0 - mu * mu))
                              : distance_to_top(radius, mu);
    for (int i = 0; i < steps; ++i) {
        const double s0 = double(i) / steps, s1 = double(i + 1) / steps;
        const double from = length * s0 * s0, to = length * s1 * s1;
        const dvec3 point = dvec3(0, radius, 0) + 0.5 * (from + to) * towards;
        const dvec3 air = (to - from) * density(glm::length(point) - EARTH);
        std::array<Spectrum, 2> seen;
        for (int k = 0; k < WAVELENGTHS; ++k) {
            const double depth = dot(air_[k], air), lost = -std::expm1(-depth);
            const double mean = light.passing[k] * (depth > 0.0 ? lost / depth : 1.0);
            seen[0][k] = mean * air_[k].x * air.x;
            seen[1][k] = mean * air_[k].y * air.y * AEROSOL_ALBEDO;
            light.passing[k] *= 1.0 - lost;
        }
        step(point, seen);
    }
}

// Light that was scattered at least once, from all sides, times the phase function 1 / (4 pi); all is
// scattered evenly here. Each further time adds the same share.
Spectrum Atmosphere::isotropic(Slant slant) const {
    constexpr int STEPS = 20, HEIGHTS = 12, AZIMUTHS = 4;
    const dvec3 sun(std::sqrt(1.0 - slant.mu * slant.mu), slant.mu, 0.0);
    Spectrum once{}, again{};
    const auto slant_of = [&](dvec3 point) {
        const double radius = glm::length(point);
        return Slant{radius, dot(point, sun) / radius};
    };
    for (int i = 0; i < HEIGHTS * AZIMUTHS; ++i) {
        const int height = i / AZIMUTHS;
        const double mu = 2.0 * (height + 0.5) / HEIGHTS - 1.0, sine = std::sqrt(1.0 - mu * mu);
        const double azimuth =
            std::numbers::pi * (i % AZIMUTHS + 0.5) / AZIMUTHS;  // The other half is alike.
        const dvec3 towards(sine * std::cos(azimuth), mu, sine * std::sin(azimuth));
        dvec3 last(0.0);
        ScatteredLight end;
        follow(slant.radius, towards, STEPS, end, [&](dvec3 point, const std::array<Spectrum, 2>& seen) {
            last = point;
            const Spectrum light = sunlight(slant_of(point));
            for (int k = 0; k < WAVELENGTHS; ++k) {
                const double scattered = seen[0][k] + seen[1][k];
                once[k] += scattered * light[k] / (4.0 * std::numbers::pi);
                again[k] += scattered;
            }
        });
        if (!end.meets_ground) continue;
        const Slant ground{EARTH, slant_of(last).mu};
        const Spectrum light = sunlight(ground);
        for (int k = 0; k < WAVELENGTHS; ++k)
            once[k] += end.passing[k] * light[k] * albedo_ * std::max(ground.mu, 0.0) / std::numbers::pi;
    }
    constexpr double DIRECTIONS = HEIGHTS * AZIMUTHS;
    Spectrum result;
    for (int k = 0; k < WAVELENGTHS; ++k)
        result[k] = once[k] / DIRECTIONS / (1.0 - again[k] / DIRECTIONS);
    return result;
}

ScatteredLight Atmosphere::scattered(dvec3 towards, dvec3 sun) const {
    constexpr int STEPS = 48;
    ScatteredLight light;
    follow(EARTH + EYE_HEIGHT, towards, STEPS, light, [&](dvec3 point, const std::array<Spectrum, 2>& seen) {
        const double radius = glm::length(point);
        const Slant slant{radius, dot(point, sun) / radius};
        const Spectrum sunlit = sunlight(slant), multiple = stored_multiple(slant);
        for (int k = 0; k < WAVELENGTHS; ++k) {
            light.molecules[k] += seen[0][k] * sunlit[k];
            light.aerosol[k] += seen[1][k] * sunlit[k];
            light.multiple[k] += (seen[0][k] + seen[1][k]) * multiple[k];
        }
    });
    return light;
}

Spectrum Atmosphere::transmittance(dvec3 towards) const {
    Spectrum light{};
    if (meets_ground(EARTH + EYE_HEIGHT, towards.y)) return light;
    const dvec3 columns = column(EARTH + EYE_HEIGHT, towards.y);
    for (int k = 0; k < WAVELENGTHS; ++k)
        light[k] = std::exp(-dot(air_[k], columns));
    return light;
}

}  // namespace candela
