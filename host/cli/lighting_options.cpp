// See lighting_options.h.
#include "cli/lighting_options.h"

#include <cmath>

#include "cli/arguments.h"

namespace candela {

static std::optional<double> parse_intensity(const std::string& text) {
    const auto value = parse_number(text);
    return value && *value >= 0.0 ? value : std::nullopt;
}

// "ELEVATION,AZIMUTH" or "ELEVATION,AZIMUTH,TURBIDITY", angles in degrees.
static std::optional<Sky> parse_sky(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 2 && parts.size() != 3) return std::nullopt;
    const auto elevation = parse_number(parts[0]), azimuth = parse_number(parts[1]);
    const auto turbidity = parts.size() == 3 ? parse_number(parts[2]) : Sky().turbidity;
    if (!elevation || !(*elevation >= MIN_SUN_ELEVATION && *elevation <= MAX_SUN_ELEVATION) || !azimuth ||
        !turbidity || !(*turbidity >= MIN_TURBIDITY && *turbidity <= MAX_TURBIDITY))
        return std::nullopt;
    return Sky{.sun_elevation = glm::radians(*elevation),
               .sun_azimuth = glm::radians(std::remainder(*azimuth, 360.0)),
               .turbidity = *turbidity};
}

void LightingArguments::add_to(CLI::App& app) {
    app.option_defaults()->group("Light");
    add_choice(
        app, "--studio", studio, STUDIO_NAMES,
        "Studio, in place of the sky: auto (default; only for glTF files that nothing else lights), off, or "
        "one by name");
    add_value(
        app, "--environment", environment,
        [](const std::string& text) { return std::optional<std::filesystem::path>(text); }, "a file",
        "Image of a sky (.exr, .hdr), in place of the scene's")
        ->type_name("FILE");
    add_value(app, "--sky", sky, parse_sky,
              "ELEVATION,AZIMUTH or ELEVATION,AZIMUTH,TURBIDITY: where the sun stands in degrees, with an "
              "elevation from -6 to 90 (below 0 is twilight), and a turbidity from 1 to 10, such as 30,120,2",
              "Clear sky with the sun there (azimuths as for --view), in place of the scene's; hazy with a "
              "turbidity of 6 (default: 2)")
        ->type_name("ELEVATION,AZIMUTH[,TURBIDITY]");
    add_value(app, "--environment-rotation", rotation, parse_number, "a number of degrees, such as 90",
              "Turn the sky or studio about the vertical, counter-clockwise seen from above")
        ->type_name("DEGREES");
    add_value(app, "--environment-intensity", intensity, parse_intensity,
              "a number of at least 0, such as 1.5", "Multiply the radiance of the sky or studio")
        ->type_name("FACTOR");
    app.add_flag("--environment-hidden", hidden,
                 "Hide the sky or studio from the camera; it still gives light");
    add_choice(
        app, "--ground", catchers.ground, GROUND_NAMES,
        "Ground just below the scene: show, or catch, to see only the shadows on it, before --background, or "
        "catch-reflections, with reflections");
    const auto add_names = [&app](const char* option, std::vector<std::string>& names, const char* text) {
        app.add_option(option, names, text)
            ->type_name("MATERIAL")
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
            ->allow_extra_args(false);
    };
    add_names("--shadow-catcher", catchers.shadows,
              "See only the shadows on surfaces of this material; repeat it for several");
    add_names("--reflection-catcher", catchers.reflections, "The same, with reflections");
    add_names("--holdout", catchers.holdouts,
              "See what is behind the picture in place of surfaces of this material; repeat it for several");
}

}  // namespace candela
