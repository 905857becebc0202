// Sunlight in the Earth's air: how much of it reaches the ground, and how much the air scatters on the way.
#pragma once

#include <array>
#include <vector>

#include "base/math.h"

namespace candela {

// Values at the middles of equal intervals of the visible wavelengths. Light is relative to that of the sun
// outside the atmosphere: its irradiance is 1 at each wavelength, on a surface perpendicular to it.
inline constexpr int WAVELENGTHS = 16;
using Spectrum = std::array<double, WAVELENGTHS>;

// [nm]
double wavelength(int i);

// Linear Rec.709 of a spectrum. That of the sun, all 1, has a luminance of pi, so that white paper which
// faces it has a radiance of 1.
dvec3 rgb_of(const Spectrum& light);

// Optical depth of the air above the sea, straight up: of molecules, aerosol and ozone.
using Air = std::array<dvec3, WAVELENGTHS>;

// The Earth's. The turbidity, at least 1, is the optical depth of molecules and aerosol over that of
// molecules, at 550 nm.
Air clear_air(double turbidity);

// Phase functions [1/sr] by the cosine of the angle between sun and view.
double molecule_phase(double cosine);
double aerosol_phase(double cosine);

// What is seen along a ray, by how it was scattered.
struct ScatteredLight {
    Spectrum molecules{};  // Once, by molecules and aerosol; to be multiplied by the phase function.
    Spectrum aerosol{};
    Spectrum multiple{};  // More often [1/sr].
    Spectrum passing{};   // The share of light from the end of the ray that reaches its beginning.
    bool meets_ground = false;
};

// Air of exponential density over a round Earth, seen from EYE_HEIGHT above its ground. Single scattering is
// integrated along rays; all further is approximated.
// Ref: Nishita et al., "Display of the Earth Taking into Account Atmospheric Scattering", 1993; Hillaire, "A
// Scalable and Production Ready Sky and Atmosphere Rendering Technique", 2020, section 5.
class Atmosphere {
  public:
    static constexpr double EYE_HEIGHT = 0.1;  // [km]

    // `albedo` is the ground's reflectance for light that the air then scatters.
    Atmosphere(const Air& air, double albedo);

    // Both with the world's up, +Y; `towards` and `sun` are unit vectors.
    ScatteredLight scattered(dvec3 towards, dvec3 sun) const;
    // The share of sunlight that arrives from that direction; 0 from below the horizon.
    Spectrum transmittance(dvec3 towards) const;

  private:
    // A point by its distance from the Earth's centre [km], and a direction by its cosine to the vertical.
    struct Slant {
        double radius;
        double mu;
    };

    template <class Step>
    void follow(double radius, dvec3 towards, int steps, ScatteredLight& light, const Step& step) const;
    Spectrum sunlight(Slant slant) const;
    dvec3 stored_columns(Slant slant) const;
    Spectrum stored_multiple(Slant slant) const;
    Spectrum isotropic(Slant slant) const;

    Air air_;
    double albedo_;
    std::vector<dvec3> columns_;
    std::vector<Spectrum> multiple_;
};

}  // namespace candela
