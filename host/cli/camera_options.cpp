// See camera_options.h.
#include "cli/camera_options.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "base/file.h"
#include "base/memory_limit.h"
#include "cli/arguments.h"
#include "load/quote.h"
#include "scene/lens_shift.h"
#include "scene/names.h"

namespace candela {
namespace {

constexpr uint32_t MAX_VIEWS = 65536;

std::optional<double> parse_within(const std::string& text, double min, double max) {
    const auto value = parse_number(text);
    return value && *value >= min && *value <= max ? value : std::nullopt;
}

std::optional<double> parse_elevation(const std::string& text) {
    const auto degrees = parse_within(text, -90.0, 90.0);
    return degrees ? std::optional(glm::radians(*degrees)) : std::nullopt;
}

// "AZIMUTH,ELEVATION" or "AZIMUTH,ELEVATION,ROLL", in degrees.
std::optional<std::pair<std::string, ViewDirection>> parse_view(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 2 && parts.size() != 3) return std::nullopt;
    const auto azimuth = parse_number(parts[0]), elevation = parse_elevation(parts[1]);
    const auto roll = parts.size() == 3 ? parse_number(parts[2]) : 0.0;
    if (!azimuth || !elevation || !roll) return std::nullopt;
    const auto angle = [](double degrees) { return glm::radians(std::remainder(degrees, 360.0)); };
    return std::pair(text, ViewDirection{angle(*azimuth), *elevation, angle(*roll)});
}

// "N" or "N,ELEVATION".
std::optional<CameraOptions::Turntable> parse_turntable(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() > 2) return std::nullopt;
    const auto count = parse_uint(parts[0], 1, MAX_VIEWS);
    const auto elevation = parse_elevation(parts.size() == 2 ? parts[1] : "20");
    if (!count || !elevation) return std::nullopt;
    return CameraOptions::Turntable{*count, *elevation};
}

// "40", "40deg" or "35mm".
std::optional<decltype(ViewStyle::lens)> parse_lens(const std::string& text) {
    const auto without = [&](const char* unit) {
        return text.substr(0, text.size() - std::string(unit).size());
    };
    if (text.ends_with("mm")) {
        const auto length = parse_within(without("mm"), 1.0, 10000.0);
        return length ? std::optional<decltype(ViewStyle::lens)>(FocalLength{*length}) : std::nullopt;
    }
    const auto degrees = parse_within(text.ends_with("deg") ? without("deg") : text, 0.1, 179.0);
    return degrees ? std::optional<decltype(ViewStyle::lens)>(VerticalFov{glm::radians(*degrees)})
                   : std::nullopt;
}

// "equirectangular", "fisheye" or "equisolid", the last two also with ",DEGREES".
std::optional<Panorama> parse_projection(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    Panorama panorama;
    const auto named =
        std::ranges::find(MAPPING_NAMES, parts[0], &decltype(MAPPING_NAMES)::value_type::first);
    if (named == MAPPING_NAMES.end() || parts.size() > 2) return std::nullopt;
    panorama.mapping = named->second;
    if (parts.size() == 1) return panorama;
    const auto degrees = parse_within(parts[1], double(MIN_FISHEYE_DEGREES), double(MAX_FISHEYE_DEGREES));
    if (!degrees || panorama.mapping == Mapping::equirectangular) return std::nullopt;
    panorama.fisheye_fov = float(glm::radians(*degrees));
    return panorama;
}

// "X,Y".
std::optional<glm::dvec2> parse_shift(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 2) return std::nullopt;
    const auto x = parse_number(parts[0]), y = parse_number(parts[1]);
    return x && y ? std::optional(glm::dvec2(*x, *y)) : std::nullopt;
}

// Throws Error if the camera cannot be shifted.
void shift_camera(Camera& camera, glm::dvec2 shift, uvec2 size) {
    const bool sees_all = camera.panorama && camera.panorama->mapping == Mapping::equirectangular;
    if (camera.ortho_height || sees_all) {
        throw Error("--shift: the camera " + quote(camera.name) + " is " +
                        (sees_all ? "equirectangular; turn it" : "orthographic; move it") + " instead",
                    ErrorKind::request);
    }
    const auto offset = shifted_offset(shift, size);
    if (!offset) throw Error(std::string("--shift: ") + SHIFT_TOO_LARGE, ErrorKind::request);
    camera.principal_offset = *offset;
}

// A path as one below another folder, if it can be.
std::string relative_to(const std::filesystem::path& folder, const std::string& path) {
    std::error_code failure;
    const std::filesystem::path relative = std::filesystem::proximate(path, folder, failure);
    return failure ? path : relative.generic_string();
}

}  // namespace

void CameraOptions::add_to(CLI::App& app) {
    app.option_defaults()->group("Cameras around the scene, or from a file (see docs/cameras.md)");
    const auto store_view = [this](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
            const auto view = parse_view(text);
            if (!view) {
                throw Error(
                    "--view: cannot use \"" + text +
                        "\"; expected AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,ROLL in degrees, such as "
                        "30,20, with an elevation from -90 to 90",
                    ErrorKind::request);
            }
            views.push_back(*view);
        }
    };
    CLI::Option* const view =
        app.add_option_function<std::vector<std::string>>(
               "--view", store_view,
               "Look from there at all that the scene shows: azimuth 0 is the front (+Z), 90 the side of +X; "
               "repeat it for several")
            ->type_name("AZIMUTH,ELEVATION[,ROLL]")
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
            ->allow_extra_args(false);
    CLI::Option* const around =
        add_value(app, "--turntable", turntable, parse_turntable,
                  "N or N,ELEVATION: a whole number from 1 to " + std::to_string(MAX_VIEWS) +
                      ", and degrees from -90 to 90",
                  "N views at even azimuths, from the front on (default elevation: 20)")
            ->type_name("N[,ELEVATION]");
    CLI::Option* const above =
        add_value(
            app, "--dome", dome, [](const std::string& text) { return parse_uint(text, 1, MAX_VIEWS); },
            "a whole number from 1 to " + std::to_string(MAX_VIEWS),
            "N views from directions spread evenly over the upper half sphere")
            ->type_name("N");
    add_value(
        app, "--lens", lens, parse_lens,
        "a vertical field of view from 0.1deg to 179deg, or a focal length from 1mm to 10000mm",
        "Vertical field of view, or focal length where the picture's longer side is 36 mm (default: 50mm)")
        ->type_name("40deg|35mm");
    add_value(
        app, "--margin", margin, [](const std::string& text) { return parse_within(text, 0.0, 0.45); },
        "a number from 0 to 0.45",
        "Share of the picture's shorter side to leave free along each edge (default: 0.05)")
        ->type_name("M");
    add_value(
        app, "--projection", projection, parse_projection,
        "equirectangular, fisheye or equisolid; the last two also with a comma and the full angle, from 1 to "
        "360 degrees",
        "See to all sides from the camera's place: equirectangular, or a fisheye of 180 degrees or that "
        "angle, equidistant or equisolid")
        ->type_name("NAME[,DEGREES]");
    add_value(app, "--shift", shift, parse_shift, "two numbers X,Y, such as 0,0.1",
              "Show what is farther to the right and upwards, by shares of the picture's longer side")
        ->type_name("X,Y");
    app.add_option("--camera-file", file, "Cameras of NeRF's transforms.json, or K, R and t of OpenCV")
        ->type_name("FILE")
        ->excludes(view)
        ->excludes(around)
        ->excludes(above);
    app.add_option(
           "--write-cameras", written,
           "Write the pictures' cameras, as OpenCV's if FILE ends with opencv.json, otherwise as NeRF's")
        ->type_name("FILE");
}

void CameraOptions::check(CommandFiles& files) const {
    if ((lens || margin) && views.empty() && !turntable && !dome) {
        throw Error(std::string(lens ? "--lens" : "--margin") +
                        ": only cameras around the scene have it; also give --view, --turntable or --dome",
                    ErrorKind::request);
    }
    if ((projection || shift) && (!views.empty() || turntable || dome)) {
        throw Error(
            std::string(projection ? "--projection" : "--shift") +
                ": cameras around the scene are placed for a view in perspective without a shift; leave out "
                "--view, --turntable and --dome",
            ErrorKind::request);
    }
    if (file) files.read("--camera-file", *file);
}

std::vector<Camera> CameraOptions::cameras(const Scene& scene, std::optional<uvec2> size) const {
    ViewStyle style{.size = size.value_or(scene.film.size)};
    style.lens = lens.value_or(style.lens);
    style.margin = margin.value_or(style.margin);
    const LimitedMemory limited;
    return with_memory_for(
        "the cameras", [&] { return file.value_or("the scene"); },
        [&] {
            if (file) return read_camera_file(*file, style.size);
            std::vector<Camera> result;
            if (views.empty() && !turntable && !dome) return result;
            const Surroundings surroundings(scene);
            for (const auto& [name, direction] : views)
                result.push_back(surroundings.view(name, direction, style));
            if (turntable) {
                std::ranges::move(surroundings.turntable(turntable->count, turntable->elevation, style),
                                  std::back_inserter(result));
            }
            if (dome) std::ranges::move(surroundings.dome(*dome, style), std::back_inserter(result));
            return result;
        });
}

Camera CameraOptions::changed(Camera camera, uvec2 size) const {
    if (projection) {
        camera.panorama = projection;
        camera.vertical_fov = 0.0f;
        camera.principal_offset = vec2(0.0f);
        camera.focal_ratio = 1.0f;
        camera.ortho_height.reset();
        camera.lens = {};
    }
    if (shift) shift_camera(camera, *shift, size);
    return camera;
}

void write_cameras(const std::string& file, std::vector<PictureCamera> pictures) {
    for (PictureCamera& picture : pictures)
        picture.file = relative_to(std::filesystem::path(file).parent_path(), picture.file);
    write_file_atomically(file, camera_file_text(file, pictures));
}

}  // namespace candela
