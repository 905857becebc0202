// See lighting_options.h.
#include "cli/lighting_options.h"

#include "cli/arguments.h"

namespace candela {

static std::optional<double> parse_intensity(const std::string& text) {
    const auto value = parse_number(text);
    return value && *value >= 0.0 ? value : std::nullopt;
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
    add_value(app, "--environment-rotation", rotation, parse_number, "a number of degrees, such as 90",
              "Turn the sky or studio about the vertical, counter-clockwise seen from above")
        ->type_name("DEGREES");
    add_value(app, "--environment-intensity", intensity, parse_intensity,
              "a number of at least 0, such as 1.5", "Multiply the radiance of the sky or studio")
        ->type_name("FACTOR");
    app.add_flag("--environment-hidden", hidden,
                 "Hide the sky or studio from the camera; it still gives light");
}

}  // namespace candela
