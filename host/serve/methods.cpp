// See methods.h.
#include "serve/methods.h"

#include <array>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/memory_limit.h"
#include "base/printable.h"
#include "denoise/denoise_image.h"
#include "film/id_layers.h"
#include "image/image_io.h"
#include "serve/describe.h"
#include "serve/describe_parts.h"
#include "serve/describe_views.h"
#include "serve/picture_request.h"
#include "serve/save_image.h"
#include "session/version.h"

namespace candela::serve {
namespace {

Json to_json(const std::vector<std::string>& warnings) {
    return Json(summary_of(warnings));
}

// The value of an optional parameter that is a text.
std::optional<std::string> text_of(const Node& parameters, std::string_view key) {
    const std::optional<Node> found = parameters.find(key);
    return found ? std::optional(found->string()) : std::nullopt;
}

std::optional<double> number_of(const Node& parameters, std::string_view key) {
    const std::optional<Node> found = parameters.find(key);
    return found ? std::optional(found->number()) : std::nullopt;
}

// The arrays of a request, if it has some. Throws Error if there is not enough memory for them.
std::unique_ptr<SharedArrays> read_arrays(const Node& parameters) {
    const std::optional<Node> found = parameters.find("arrays");
    if (!found) return nullptr;
    auto arrays = std::make_unique<SharedArrays>(*found);
    const LimitedMemory limited;
    with_memory_for(
        "a scene of these arrays", [&] { return found->place(); },
        [&] { const MemoryCharge estimate(arrays->needed()); });
    return arrays;
}

// The names of the elements of a map.
template <class Things>
std::vector<std::string> known_in(const Things& things) {
    std::vector<std::string> names;
    for (const auto& [name, thing] : things)
        names.push_back(name);
    return names;
}

// The element of a map that the parameter `key` names.
template <class Things>
auto& find(const Node& parameters, const char* key, Things& things) {
    return checked([&]() -> auto& {
        const Node id = parameters.require(key);
        const auto found = things.find(id.string());
        if (found == things.end()) id.fail_unknown(key, id.string(), known_in(things));
        return found->second;
    });
}

}  // namespace

Json Methods::operator()(const Request& request, const Call& call) {
    static const std::vector<std::pair<std::string, Method>> methods{
        {"version", &Methods::version}, {"devices", &Methods::devices}, {"load", &Methods::load},
        {"scene", &Methods::scene},     {"object", &Methods::object},   {"material", &Methods::material},
        {"set", &Methods::set},         {"views", &Methods::views},     {"render", &Methods::render},
        {"image", &Methods::image},     {"labels", &Methods::labels},   {"save", &Methods::save},
        {"release", &Methods::release}, {"close", &Methods::close}};
    for (const auto& [name, method] : methods) {
        if (name == request.method) return (this->*method)(request.parameters(), call);
    }
    std::vector<std::string> names = known_in(methods);
    names.emplace_back("cancel");
    throw RequestError(Code::unknown_method, "request: unknown method \"" +
                                                 printable(request.method, MAX_NAME_BYTES) +
                                                 "\" (known: " + joined(names) + ')');
}

Json Methods::version(const Node& parameters, const Call&) {
    checked([&] {
        parameters.allow_only({"protocol"});
        const std::optional<Node> protocol = parameters.find("protocol");
        if (protocol && protocol->integer(0, UINT32_MAX) != PROTOCOL) {
            protocol->fail("the client speaks version " + protocol->text() +
                           " of the protocol, and candela " CANDELA_VERSION " speaks version " +
                           std::to_string(PROTOCOL) + "; update the older of the two");
        }
    });
    return {{"program", "candela"}, {"version", CANDELA_VERSION}, {"protocol", PROTOCOL}};
}

const vk::Instance& Methods::instance() {
    if (!instance_) instance_ = std::make_unique<vk::Instance>(options_.instance());
    return *instance_;
}

Json Methods::devices(const Node& parameters, const Call&) {
    checked([&] { parameters.allow_only({}); });
    return {{"devices", describe_devices(instance().devices())}};
}

LoadedScene& Methods::find_scene(const Node& parameters) {
    return *find(parameters, "scene", scenes_);
}

SharedImage& Methods::find_image(const Node& parameters) {
    return *find(parameters, "image", images_);
}

// The parameters of `load`, and what the scene is called.
Methods::LoadRequest Methods::read_load(const Node& parameters) const {
    parameters.allow_only({"scene", "file", "text", "folder", "folders", "arrays", "time", "animation"});
    const std::optional<Node> file = parameters.find("file"), text = parameters.find("text");
    if (file.has_value() == text.has_value())
        parameters.fail(R"(give either "file", or "text" and "folder")");
    LoadRequest request{.options = options_.loading};
    LoadOptions& options = request.options;
    options.gltf.time = number_of(parameters, "time");
    options.gltf.animation = text_of(parameters, "animation");
    if (const auto folders = parameters.find("folders")) {
        for (const Node& folder : folders->elements())
            options.reach.folders.emplace_back(folder.file_name());
    }
    if (text) {
        request.path = std::filesystem::path(parameters.require("folder").file_name()) / "scene";
        options.text = text->string();
        request.arrays = read_arrays(parameters);
        options.arrays = request.arrays.get();
    } else {
        if (const auto arrays = parameters.find("arrays")) arrays->fail(R"("arrays" go with "text")");
        request.path = file->file_name();
    }
    uint64_t number = 1;
    while (scenes_.contains(std::to_string(number)))
        ++number;
    request.id = text_of(parameters, "scene").value_or(std::to_string(number));
    return request;
}

DeviceSlot Methods::take_device() {
    if (idle_) return *std::exchange(idle_, std::nullopt);
    return {instance(), vk::select_device(instance().devices(), options_.device), options_.kernel_cache};
}

// Frees a scene, if there is one of that name.
void Methods::remove_scene(const std::string& id) {
    const auto found = scenes_.find(id);
    if (found == scenes_.end()) return;
    idle_ = LoadedScene::device_of(std::move(found->second));
    scenes_.erase(found);
}

Json Methods::load(const Node& parameters, const Call& call) {
    LoadRequest request = checked([&] { return read_load(parameters); });
    auto loaded =
        std::make_unique<LoadedScene>(take_device(), request.path, std::move(request.options), call);
    Json result = describe_scene(loaded->scene());
    result["scene"] = request.id;
    result["warnings"] = to_json(loaded->take_warnings());
    remove_scene(request.id);
    scenes_[request.id] = std::move(loaded);
    return result;
}

Json Methods::scene(const Node& parameters, const Call&) {
    checked([&] { parameters.allow_only({"scene"}); });
    return describe_scene(find_scene(parameters).scene());
}

Json Methods::set(const Node& parameters, const Call&) {
    LoadedScene& scene = find_scene(parameters);
    checked([&] {
        parameters.allow_only({"scene", "change", "arrays", "time", "animation"});
        if (parameters.find("change").has_value() == parameters.find("time").has_value())
            parameters.fail(R"(give either "change" or "time")");
        if (parameters.find("change") && parameters.find("animation"))
            parameters.fail(R"("animation" goes with "time")");
        if (parameters.find("time") && parameters.find("arrays"))
            parameters.fail(R"("arrays" go with "change")");
    });
    if (const auto change = parameters.find("change")) {
        const auto arrays = checked([&] { return read_arrays(parameters); });
        scene.change(change->text(), arrays.get());
    } else {
        const Node time = parameters.require("time");
        const auto [seconds, animation] = checked([&] {
            return std::pair(time.is_null() ? std::nullopt : std::optional(time.number()),
                             text_of(parameters, "animation"));
        });
        scene.pose(seconds, animation);
    }
    return {{"warnings", to_json(scene.take_warnings())}};
}

Json Methods::object(const Node& parameters, const Call&) {
    checked([&] { parameters.allow_only({"scene", "object"}); });
    const Scene& scene = find_scene(parameters).scene();
    return checked([&] { return describe_object(parameters.require("object"), scene); });
}

Json Methods::material(const Node& parameters, const Call&) {
    checked([&] { parameters.allow_only({"scene", "material"}); });
    const Scene& scene = find_scene(parameters).scene();
    return checked([&] { return describe_material(parameters.require("material"), scene); });
}

Json Methods::labels(const Node& parameters, const Call&) {
    checked([&] { parameters.allow_only({"image"}); });
    const Labels* const labels = find_image(parameters).labels();
    if (labels == nullptr)
        throw RequestError(Code::failed,
                           "the image has no layers of ids; render it with the layer object_id");
    return describe_labels(*labels);
}

Json Methods::views(const Node& parameters, const Call&) {
    const Scene& scene = find_scene(parameters).scene();
    const LimitedMemory limited;
    return checked([&] {
        return with_memory_for(
            "the cameras", [] { return std::string("request"); },
            [&] { return describe_views(parameters, scene); });
    });
}

Json Methods::render(const Node& parameters, const Call& call) {
    LoadedScene& scene = find_scene(parameters);
    auto [job, tells_progress] = checked([&] {
        const std::optional<Node> progress = parameters.find("progress");
        return std::pair(read_job(parameters, scene.scene()), progress && progress->boolean());
    });
    scene.render(std::move(job), call, tells_progress);
    Json result = scene.outcome();
    result["cancelled"] = call.is_cancelled();
    result["warnings"] = to_json(scene.take_warnings());
    return result;
}

void Methods::denoise(Image& image, DenoiserChoice choice, LoadedScene& scene) {
    denoised_ = &scene;
    std::unique_ptr<Denoiser>& denoiser = denoisers_[choice];
    if (denoiser == nullptr) {
        denoiser = choose_denoiser(choice, DenoiserQuality::high,
                                   [this]() -> const vk::Device& { return denoised_->open_device(); });
    }
    add_denoised(image, *denoiser, false, "the picture");
}

Json Methods::image(const Node& parameters, const Call&) {
    const std::optional<DenoiserChoice> way = checked([&] {
        parameters.allow_only({"scene", "denoise"});
        const auto denoise = parameters.find("denoise");
        return denoise ? std::optional(denoise->choice(DENOISER_NAMES)) : std::nullopt;
    });
    LoadedScene& scene = find_scene(parameters);
    const LimitedMemory limited;
    auto shared = with_memory_for(
        "the image", [] { return std::string("request"); },
        [&] {
            Image image = scene.image(options_.command_line);
            if (way) denoise(image, *way, scene);
            auto labels = image.find(OBJECT_ID) == nullptr ? nullptr : scene.labels();
            return std::make_unique<SharedImage>(std::move(image), std::move(labels));
        });
    Json result = scene.outcome();
    result.update(shared->describe());
    const std::string id = std::to_string(next_image_++);
    result["image"] = id;
    images_[id] = std::move(shared);
    return result;
}

Json Methods::save(const Node& parameters, const Call&) {
    const SharedImage& image = find_image(parameters);
    const SaveRequest request = checked([&] { return read_save(parameters); });
    const LimitedMemory limited;
    with_memory_for(
        "the image", [] { return std::string("request"); }, [&] { save_image(image.image(), request); });
    return Json::object();
}

Json Methods::release(const Node& parameters, const Call&) {
    checked([&] { parameters.allow_only({"image"}); });
    find_image(parameters);
    images_.erase(parameters.require("image").string());
    return Json::object();
}

Json Methods::close(const Node& parameters, const Call&) {
    checked([&] { parameters.allow_only({"scene"}); });
    if (!parameters.find("scene")) return Json::object();  // The server ends.
    find_scene(parameters);
    remove_scene(parameters.require("scene").string());
    return Json::object();
}

}  // namespace candela::serve
