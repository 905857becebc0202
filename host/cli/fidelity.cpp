// `candela fidelity`: scenarios of Khronos' render-fidelity generator, rendered by the options of `candela
// render` that say the same.
// Ref: Khronos, "glTF Render Fidelity Generator", test/config.json and src/common.ts.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/limits.h"
#include "base/temporary_folder.h"
#include "base/text.h"
#include "cli/camera_options.h"
#include "cli/command.h"
#include "load/json.h"
#include "load/node.h"
#include "load/quote.h"

namespace candela {
namespace {

// What the generator has for a scenario that does not say.
constexpr double FIELD_OF_VIEW = 45.0, PHI = 90.0, RADIUS = 1.0;
constexpr uint32_t SIDE = 768;
constexpr const char* LIGHTING = "../../../environments/lightroom_14b.hdr";

constexpr uint32_t SCALE = 2;  // Pixels per point, as on the generator's screen.
// As three.js has it before the curve of ACES: log2(1 / 0.6) stops.
constexpr const char* EXPOSURE = "0.737";
// Degrees: the middle of the generator's environments is +X, ours is -Z.
constexpr const char* ROTATION = "-90";

struct FidelityArguments {
    std::string file;
    std::optional<std::string> scenario;
    std::optional<std::string> root;
};

// The scenario in a document that is one, holds it as "scenario", or holds a list of them by their names.
Node scenario_in(const Node& root, const std::optional<std::string>& name) {
    if (const auto own = root.find("scenario")) return *own;
    const auto list = root.find("scenarios");
    if (!list) return root;
    std::vector<std::string> names;
    for (const Node& scenario : list->elements()) {
        names.push_back(scenario.require("name").string());
        if (name && names.back() == *name) return scenario;
    }
    if (!name) list->fail("the file has several scenarios; choose one by --scenario NAME");
    list->fail_unknown("scenario", *name, names);
}

double number_in(const Node& scenario, const char* object, const char* key, double otherwise) {
    const auto found = scenario.find(object);
    const auto value = found ? found->find(key) : std::nullopt;
    return value ? value->number() : otherwise;
}

uvec2 size_of(const Node& scenario) {
    const auto side = [&](const char* key) {
        const auto found = scenario.find("dimensions");
        const auto value = found ? found->find(key) : std::nullopt;
        return SCALE * (value ? value->integer(1, MAX_PICTURE_SIZE / SCALE) : SIDE);
    };
    return {side("width"), side("height")};
}

// The camera is at theta from +Z towards +X and at phi from +Y, at a radius around the target.
Camera camera_of(const Node& scenario) {
    const auto orbit = [&](const char* key, double otherwise) {
        return number_in(scenario, "orbit", key, otherwise);
    };
    const double theta = glm::radians(orbit("theta", 0.0)), phi = glm::radians(orbit("phi", PHI));
    const double radius = orbit("radius", RADIUS);
    const dvec3 target(number_in(scenario, "target", "x", 0.0), number_in(scenario, "target", "y", 0.0),
                       number_in(scenario, "target", "z", 0.0));
    const dvec3 outwards(std::sin(phi) * std::sin(theta), std::cos(phi), std::sin(phi) * std::cos(theta));
    Camera camera;
    camera.name = "orbit";
    camera.position = target + radius * outwards;
    // A radius of 0 looks around from the target.
    camera.look_at = camera.position - (radius > 0.0 ? radius : 1.0) * outwards;
    const bool is_vertical = std::abs(std::sin(phi)) < 1e-6;
    if (is_vertical)  // What is behind the model is up.
        camera.up = vec3(dvec3(-std::sin(theta) * outwards.y, 0.0, -std::cos(theta) * outwards.y));
    const auto fov = scenario.find("verticalFoV");
    camera.vertical_fov = glm::radians(fov ? fov->number(0.1f, 179.0f) : float(FIELD_OF_VIEW));
    return camera;
}

// The words of `candela render` for a scenario. Options of the user's come after them, and replace them.
std::vector<std::string> words_of(const Node& scenario, const std::filesystem::path& root,
                                  const std::filesystem::path& camera_file,
                                  const std::vector<std::string>& own) {
    const auto path = [&](const std::string& name) { return (root / name).lexically_normal().string(); };
    const uvec2 size = size_of(scenario);
    write_cameras(camera_file.string(), {{camera_of(scenario), size, "orbit"}});
    const auto lighting = scenario.find("lighting");
    const auto sky = scenario.find("renderSkybox");
    std::vector<std::string> words{path(scenario.require("model").file_name())};
    const auto add = [&](const std::string& option, const std::string& value) {
        const auto is_own = [&](const std::string& word) {
            return word == option || word.starts_with(option + "=");
        };
        if (std::ranges::none_of(own, is_own)) words.insert(words.end(), {option, value});
    };
    add("--camera-file", camera_file.string());
    add("--size", concat(size.x, 'x', size.y));
    add("--environment", path(lighting ? lighting->file_name() : LIGHTING));
    add("--environment-rotation", ROTATION);
    add("--tonemap", "aces");
    add("--exposure", EXPOSURE);
    if (!sky || !sky->boolean()) {
        words.emplace_back("--environment-hidden");
        add("--background", "transparent");
    }
    words.insert(words.end(), own.begin(), own.end());
    return words;
}

ExitCode run(const FidelityArguments& arguments, std::vector<std::string> own,
             const std::string& command_line) {
    const json::Document document{arguments.file, json::parse(read_file(arguments.file), arguments.file)};
    const Node scenario = scenario_in(Node(document), arguments.scenario);
    const std::filesystem::path root = arguments.root ? std::filesystem::path(*arguments.root)
                                                      : std::filesystem::path(arguments.file).parent_path();
    const TemporaryFolder folder(arguments.file);
    std::vector<std::string> words = words_of(scenario, root, folder.path() / "transforms.json", own);
    std::ranges::reverse(words);  // As CLI11 has it.
    CLI::App app;
    app.allow_windows_style_options(false);  // As in program.cpp.
    const Command render = add_render_command(app, command_line);
    words.emplace_back("render");
    try {
        app.parse(std::move(words));
    } catch (const CLI::ParseError& error) {
        throw Error(std::string(error.what()) + "; see candela render --help", ErrorKind::request);
    }
    return render.run();
}

}  // namespace

Command add_fidelity_command(CLI::App& app, const std::string& command_line) {
    CLI::App* const command =
        app.add_subcommand("fidelity", "Render a scenario of Khronos' render-fidelity generator");
    const auto arguments = std::make_shared<FidelityArguments>();
    command
        ->add_option("SCENARIO", arguments->file, "JSON: a scenario, or a list of them as config.json has it")
        ->required()
        ->type_name("");
    command->add_option("--scenario", arguments->scenario, "The scenario of that name")->type_name("NAME");
    command
        ->add_option("--root", arguments->root,
                     "What its paths are relative to (default: the folder of the file)")
        ->type_name("FOLDER");
    command->allow_extras();
    command->footer(
        "All other options are those of candela render, and replace what the scenario says:\n"
        "  candela fidelity test/config.json --scenario khronos-Fox --root test/renderers/candela -o fox.png "
        "--spp 256\n\n"
        "The scenario gives model, camera (target, orbit, verticalFoV), size (dimensions, of two pixels "
        "each),\n"
        "lighting and, with renderSkybox, the background, which is transparent otherwise. Pictures have the\n"
        "curve aces and the exposure that three.js has with it.");
    return {command, [arguments, command, command_line] {
                return run(*arguments, command->remaining(), command_line);
            }};
}

}  // namespace candela
