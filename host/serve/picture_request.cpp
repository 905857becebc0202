// See picture_request.h.
#include "serve/picture_request.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/limits.h"
#include "denoise/denoise_image.h"
#include "film/id_layers.h"
#include "film/sample_range.h"
#include "load/json/loader_parts.h"
#include "scene/catchers.h"
#include "scene/names.h"

namespace candela::serve {
namespace {

// The keys of a picture, beside the scene's id.
constexpr std::array<std::string_view, 14> KEYS{
    "camera",       "size",       "crop",      "spp",     "seed",      "layers",  "background",
    "target_error", "time_limit", "estimator", "sampler", "max_depth", "denoise", "latency"};

constexpr std::array<std::pair<std::string_view, Backdrop>, 2> BACKGROUND_NAMES{
    {{"environment", Backdrop::environment}, {"transparent", Backdrop::transmitted}}};

PixelRect read_crop(const Node& node, uvec2 size) {
    const std::vector<Node> sides = node.elements();
    if (sides.size() != 4) node.fail_expected("four whole numbers [x0, y0, x1, y1]");
    const auto side = [&](size_t i, uint32_t least, uint32_t most) { return sides[i].integer(least, most); };
    const uint32_t x0 = side(0, 0, size.x - 1), y0 = side(1, 0, size.y - 1);
    return {x0, y0, side(2, x0 + 1, size.x), side(3, y0 + 1, size.y)};
}

Camera read_picture_camera(const Node& parameters, const Scene& scene) {
    const std::optional<Node> camera = parameters.find("camera");
    if (!camera) return scene.cameras.front();
    if (!camera->is_string()) return read_camera(*camera, scene.film);
    return choose_camera(scene, camera->string(), camera->place() + ": ");
}

}  // namespace

std::span<const LayerKind> layer_kinds() {
    static const std::vector<LayerKind> kinds{
        {"rgb", {"R", "G", "B"}, nullptr},
        {"alpha", {"A"}, nullptr},
        {"albedo", {"Albedo.R", "Albedo.G", "Albedo.B"}, &AovSelection::albedo},
        {"normal", {"N.X", "N.Y", "N.Z"}, &AovSelection::normal},
        {"position", {"P.X", "P.Y", "P.Z"}, &AovSelection::position},
        {"depth", {"Z"}, &AovSelection::depth},
        {"distance", {"Depth.V"}, &AovSelection::distance},
        {"variance", {"Variance.R", "Variance.G", "Variance.B"}, &AovSelection::variance},
        {"samples", {"SampleCount.V"}, &AovSelection::sample_count},
        {"denoised", {DENOISED.begin(), DENOISED.end()}, nullptr},
        {"object_id", {OBJECT_ID}, &AovSelection::ids},
        {"instance_id", {INSTANCE_ID}, &AovSelection::ids},
        {"material_id", {MATERIAL_ID}, &AovSelection::ids},
        {"crypto_object00",
         {"CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B", "CryptoObject00.A"},
         &AovSelection::cryptomatte},
        {"crypto_object01",
         {"CryptoObject01.R", "CryptoObject01.G", "CryptoObject01.B", "CryptoObject01.A"},
         &AovSelection::cryptomatte},
        {"crypto_object02",
         {"CryptoObject02.R", "CryptoObject02.G", "CryptoObject02.B", "CryptoObject02.A"},
         &AovSelection::cryptomatte},
        {"crypto_material00",
         {"CryptoMaterial00.R", "CryptoMaterial00.G", "CryptoMaterial00.B", "CryptoMaterial00.A"},
         &AovSelection::cryptomatte},
        {"crypto_material01",
         {"CryptoMaterial01.R", "CryptoMaterial01.G", "CryptoMaterial01.B", "CryptoMaterial01.A"},
         &AovSelection::cryptomatte},
        {"crypto_material02",
         {"CryptoMaterial02.R", "CryptoMaterial02.G", "CryptoMaterial02.B", "CryptoMaterial02.A"},
         &AovSelection::cryptomatte},
    };
    return kinds;
}

AovSelection read_layers(const Node& parameters) {
    AovSelection selection;
    const std::optional<Node> layers = parameters.find("layers");
    if (!layers) return selection;
    const bool all = layers->is_string() && layers->string() == "all";
    std::vector<std::string> names;
    for (const LayerKind& kind : layer_kinds()) {
        if (kind.name != "denoised") names.emplace_back(kind.name);  // See the method `image`.
    }
    if (!all && !layers->is_array()) layers->fail_expected(R"("all" or an array of names)");
    std::vector<std::string> wanted;
    if (all) {
        for (const LayerKind& kind : layer_kinds()) {
            const bool is_of_ids =
                kind.selected == &AovSelection::ids || kind.selected == &AovSelection::cryptomatte;
            if (kind.selected != nullptr && !is_of_ids) wanted.emplace_back(kind.name);
        }
    } else {
        for (const Node& layer : layers->elements())
            wanted.push_back(layer.string());
    }
    for (const std::string& name : wanted) {
        const auto found = std::ranges::find(names, name);
        if (found == names.end()) layers->fail_unknown("layer", name, names);
        const auto member = std::ranges::find(layer_kinds(), name, &LayerKind::name)->selected;
        if (member != nullptr) selection.*member = true;
    }
    return selection;
}

std::optional<uvec2> read_size(const Node& parameters) {
    const std::optional<Node> size = parameters.find("size");
    if (!size) return std::nullopt;
    if (size->size() != 2) size->fail_expected("two whole numbers [width, height]");
    return uvec2((*size)[0].integer(1, MAX_PICTURE_SIZE), (*size)[1].integer(1, MAX_PICTURE_SIZE));
}

RenderJob read_job(const Node& parameters, const Scene& scene) {
    parameters.allow_only({"scene", "progress"}, KEYS);
    const Camera camera = read_picture_camera(parameters, scene);
    RenderSettings settings = proposed_settings(scene, camera);
    settings.size = read_size(parameters).value_or(settings.size);
    settings.crop = {0, 0, settings.size.x, settings.size.y};
    if (const auto crop = parameters.find("crop")) settings.crop = read_crop(*crop, settings.size);
    if (const auto seed = parameters.find("seed")) settings.seed = seed->integer(0, UINT32_MAX);
    if (const auto estimator = parameters.find("estimator"))
        settings.estimator = estimator->choice(ESTIMATOR_NAMES);
    if (const auto sampler = parameters.find("sampler")) settings.sampler = sampler->choice(SAMPLER_NAMES);
    if (const auto depth = parameters.find("max_depth"))
        settings.max_depth = depth->integer(0, DEPTH_SAFETY_LIMIT);
    if (const auto background = parameters.find("background"))
        settings.backdrop = background->choice(BACKGROUND_NAMES);
    RenderJob job{.camera = camera, .settings = settings, .target = scene.integrator.spp};
    if (const auto spp = parameters.find("spp")) job.target = spp->integer(1, MAX_SPP);
    if (const auto error = parameters.find("target_error")) job.target_error = error->positive();
    if (const auto limit = parameters.find("time_limit")) job.time_limit = limit->positive();
    if (const auto latency = parameters.find("latency")) {
        job.settings.latency = latency->positive();
        if (job.time_limit)
            latency->fail(
                "a request with a time limit has no latency, which would lose its samples; leave one out");
    }
    job.aovs = read_layers(parameters);
    if (const auto denoise = parameters.find("denoise"); denoise && denoise->boolean()) {
        job.aovs.denoising = job.aovs.variance = job.aovs.sample_count = true;
        job.settings.guides = true;
    }
    job.aovs.transmission = settings.backdrop == Backdrop::transmitted;
    // Before a sky, they are ordinary surfaces.
    job.aovs.catchers = job.settings.catchers = job.aovs.transmission && has_catchers(scene);
    job.settings.aovs = job.aovs.needs_layers();
    if (job.time_limit) job.settings.pass_growth = EVEN_PASS_GROWTH;
    return job;
}

}  // namespace candela::serve
