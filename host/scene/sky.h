// A clear sky with its sun, from a few numbers.
#pragma once

#include "scene/scene.h"

namespace candela {

// The least and greatest that a sky may have. Below MIN_SUN_ELEVATION [degrees], civil twilight ends.
inline constexpr double MIN_SUN_ELEVATION = -6.0;
inline constexpr double MAX_SUN_ELEVATION = 90.0;
inline constexpr double MIN_TURBIDITY = 1.0;
inline constexpr double MAX_TURBIDITY = 10.0;

struct Sky {
    double sun_elevation = 0.0;  // Of the sun's middle, above the horizon [rad].
    double sun_azimuth = 0.0;    // From +Z towards +X [rad], as of ViewDirection.
    double turbidity = 2.0;      // As of clear_air().
    vec3 ground{0.3f};           // Reflectance of what lies below the horizon.

    bool operator==(const Sky&) const = default;
};

// The angle from the sun's middle to its edge [rad].
inline constexpr double SUN_RADIUS = 0.5 * 0.533 * double(PI) / 180.0;

// The sky as an image, relative to the sun: white paper that faces the sun outside the atmosphere has a
// radiance of 1 (luminance). The sun's disk is evenly bright but for the air below, and covers its exact
// solid angle. Colours beyond Rec.709 lose their negative channels.
Environment sky_environment(const Sky& sky);

}  // namespace candela
