// See rendering_options.h.
#include "cli/rendering_options.h"

#include <algorithm>
#include <vector>

#include "scene/default_filter.h"
#include "session/job.h"
#include "shared/constants.h"

namespace candela {

static std::optional<uint32_t> parse_spp(const std::string& text) {
    return parse_uint(text, 1, MAX_SPP);
}

static std::optional<uint32_t> parse_seed(const std::string& text) {
    return parse_uint(text, 0, UINT32_MAX);
}

static std::optional<uint32_t> parse_depth(const std::string& text) {
    return parse_uint(text, 0, DEPTH_SAFETY_LIMIT);
}

static std::optional<uint32_t> parse_max_depth(const std::string& text) {
    return text == "unlimited" ? DEPTH_SAFETY_LIMIT : parse_depth(text);
}

// "tent" or "tent,2.5".
static std::optional<PixelFilter> parse_filter(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    const auto named =
        std::ranges::find(FILTER_SHAPE_NAMES, parts[0], &decltype(FILTER_SHAPE_NAMES)::value_type::first);
    if (named == FILTER_SHAPE_NAMES.end() || parts.size() > 2) return std::nullopt;
    PixelFilter filter = default_filter(named->second);
    if (parts.size() == 1) return filter;
    const auto width = parse_number(parts[1]);
    if (!width) return std::nullopt;
    filter.width = float(*width);
    if (!(filter.width >= MIN_FILTER_WIDTH && filter.width <= MAX_FILTER_WIDTH)) return std::nullopt;
    return filter;
}

static std::optional<float> parse_clamp(const std::string& text) {
    const auto limit = parse_number(text);
    if (!limit || !(*limit >= double(FLOAT_MIN) && *limit <= double(FLOAT_MAX))) return std::nullopt;
    return float(*limit);
}

CLI::Option* SceneOptions::add_file_to(CLI::App& app) {
    return app.add_option("SCENE", file, SCENE_FILES)->required()->type_name("");
}

void SceneOptions::add_camera_to(CLI::App& app) {
    app.option_defaults()->group("Picture");
    app.add_option("--camera", camera, "Camera by name (default: the scene's first)")->type_name("NAME");
}

const Camera& SceneOptions::choose_camera(const Scene& scene) const {
    return candela::choose_camera(scene, camera, "--camera: ");
}

void SamplingOptions::add_to(CLI::App& app) {
    app.option_defaults()->group(SAMPLING_GROUP);
    add_value(app, "--spp", spp, parse_spp, "a whole number from 1 to " + std::to_string(MAX_SPP),
              "Samples per pixel")
        ->type_name("N");
    add_value(app, "--seed", seed, parse_seed, "a whole number from 0 to 4294967295",
              "Seed of the random numbers; each gives different noise")
        ->type_name("S");
    const std::string depths = "a whole number from 0 to " + std::to_string(DEPTH_SAFETY_LIMIT);
    add_value(app, "--max-depth", max_depth, parse_max_depth, depths + ", or unlimited",
              "Maximum number of bounces, or unlimited; 0 shows only lights")
        ->type_name("D");
    add_value(app, "--rr-depth", rr_depth, parse_depth, depths, "Bounces before Russian roulette begins")
        ->type_name("N");
    add_choice(app, "--estimator", estimator, ESTIMATOR_NAMES,
               "How direct light is sampled; mis has the least noise, bsdf misses lights without a surface");
    add_choice(app, "--sampler", sampler, SAMPLER_NAMES, "Random numbers; sobol has the least noise");
    add_choice(
        app, "--light-sampler", light_sampler, LIGHT_SAMPLER_NAMES,
        "How a light is chosen: by power, by what it may send to the lit point (tree), or by the better of "
        "the two (auto)");
    add_choice(app, "--terminator", terminator, TERMINATOR_NAMES,
               "Where light ends on meshes with smooth normals: along the smooth surface, or along the flat "
               "triangles");
    add_value(app, "--filter", filter, parse_filter,
              "box, tent, gaussian or blackman-harris, also with a comma and a width from 0.01 to 10 pixels",
              "How samples are spread around a pixel's centre: box, tent, gaussian or blackman-harris, and "
              "the filter's full width in pixels")
        ->type_name("NAME[,WIDTH]");
    add_value(app, "--clamp-indirect", clamp_indirect, parse_clamp, "a number above 0, such as 10",
              "Scale down contributions of light that has bounced more than once to this radiance: removes "
              "fireflies, and some of the light (default: never)")
        ->type_name("L");
}

void DeviceOptions::add_to(CLI::App& app) {
    app.option_defaults()->group("Device");
    app.add_option("--device", name, "Index or part of the name (default: the best; see candela devices)")
        ->type_name("D");
    add_choice(app, "--scene-buffers", scene_access, SCENE_ACCESS_NAMES,
               "How kernels read the scene; the image is the same (default: auto)");
}

void RenderingOptions::add_to(CLI::App& app) {
    app.option_defaults()->group("Picture");
    picture.add_to(app);
    loading.add_to(app);
    sampling.add_to(app);
    device.add_to(app);
}

RenderSettings RenderingOptions::settings(const Scene& scene, const Camera& camera) const {
    RenderSettings result = proposed_settings(scene, camera);
    result.size = picture.size.value_or(result.size);
    result.crop = picture.crop_within(result.size);
    result.estimator = sampling.estimator.value_or(result.estimator);
    result.sampler = sampling.sampler.value_or(result.sampler);
    result.light_sampler = sampling.light_sampler.value_or(result.light_sampler);
    result.terminator = sampling.terminator.value_or(result.terminator);
    result.filter = sampling.filter.value_or(result.filter);
    if (sampling.clamp_indirect) result.clamp_indirect = sampling.clamp_indirect;
    result.seed = sampling.seed.value_or(result.seed);
    result.max_depth = sampling.max_depth.value_or(result.max_depth);
    result.rr_depth = sampling.rr_depth.value_or(result.rr_depth);
    result.scene_access = device.scene_access;
    return result;
}

}  // namespace candela
