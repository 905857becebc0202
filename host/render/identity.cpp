// See identity.h.
#include "render/identity.h"

#include <charconv>
#include <cstdio>

#include "base/error.h"
#include "base/hash.h"
#include "scene/names.h"

namespace candela {
namespace {

constexpr const char* HASH_ATTRIBUTE = "candela.identity";

// How messages call the settings, and the attributes that hold them; size and crop are the image's own.
struct SettingName {
    const char* word;
    const char* attribute;
};
constexpr std::array<SettingName, Identity::SETTING_COUNT> NAMES{{{"size", nullptr},
                                                                  {"crop", nullptr},
                                                                  {"seed", "candela.seed"},
                                                                  {"sampler", "candela.sampler"},
                                                                  {"estimator", "candela.estimator"},
                                                                  {"max depth", "candela.maxDepth"},
                                                                  {"rr depth", "candela.rrDepth"},
                                                                  {"camera", "candela.camera"}}};

std::string size_text(uvec2 size) {
    return std::to_string(size.x) + 'x' + std::to_string(size.y);
}

std::string crop_text(const PixelRect& crop) {
    return std::to_string(crop.x0) + ',' + std::to_string(crop.y0) + ',' + std::to_string(crop.x1) + ',' +
           std::to_string(crop.y1);
}

// The shortest text that means just that float.
std::string exact(float value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string exact(vec3 v) {
    return exact(v.x) + ' ' + exact(v.y) + ' ' + exact(v.z);
}

std::string camera_text(const Camera& camera) {
    std::string text = "at " + exact(camera.position) + " towards " + exact(camera.look_at) + ", up " +
                       exact(camera.up) + ", field of view " + exact(camera.vertical_fov) + " rad";
    const Lens& lens = camera.lens;
    if (lens.radius > 0.0f) {
        text += ", lens of radius " + exact(lens.radius) + " focused at " + exact(lens.focal_distance);
        if (lens.blades > 0)
            text += ", " + std::to_string(lens.blades) + " blades at " + exact(lens.rotation) + " rad";
    }
    return text;
}

template <class T>
uint64_t add_to_hash(uint64_t hash, const T& array) {
    return hash_words(std::as_bytes(std::span(array)), hash);
}

}  // namespace

std::string hexadecimal(uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

Identity make_identity(const GpuScene& scene, const Camera& camera, const RenderSettings& settings) {
    RenderSettings fixed = settings;
    fixed.first_sample = 0;
    fixed.aovs = false;
    uint64_t hash = FNV1A64_BASIS;
    for (const std::vector<uvec4>& array : scene.arrays)
        hash = add_to_hash(hash, array);
    hash = add_to_hash(hash, pack(make_parameters(scene, camera, fixed)));
    hash = add_to_hash(hash, make_constants(scene, camera, fixed).values);
    hash = add_to_hash(hash, std::array<uint32_t, 2>{settings.crop.x1, settings.crop.y1});
    return {.settings = {size_text(settings.size), crop_text(settings.crop), std::to_string(settings.seed),
                         name_of(settings.sampler, SAMPLER_NAMES),
                         name_of(settings.estimator, ESTIMATOR_NAMES), std::to_string(settings.max_depth),
                         std::to_string(settings.rr_depth), camera_text(camera)},
            .hash = hash};
}

void set_identity(Image& image, const Identity& identity) {
    image.attributes[HASH_ATTRIBUTE] = hexadecimal(identity.hash);
    for (size_t i = 0; i < NAMES.size(); ++i) {
        if (NAMES[i].attribute != nullptr) image.attributes[NAMES[i].attribute] = identity.settings[i];
    }
}

const std::string& text_attribute(const Image& image, const std::string& attribute, const std::string& name) {
    const auto found = image.attributes.find(attribute);
    if (found == image.attributes.end() || !std::holds_alternative<std::string>(found->second)) {
        throw Error(name + ": the attribute " + attribute +
                    " is missing; give a file that candela render wrote, unchanged");
    }
    return std::get<std::string>(found->second);
}

Identity identity_of(const Image& image, const std::string& name) {
    Identity identity;
    const std::string& text = text_attribute(image, HASH_ATTRIBUTE, name);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), identity.hash, 16);
    if (error != std::errc{} || end != text.data() + text.size()) {
        throw Error(name + ": the attribute " + HASH_ATTRIBUTE + " is \"" + text +
                    "\"; give a file that candela render wrote, unchanged");
    }
    for (size_t i = 0; i < NAMES.size(); ++i) {
        if (NAMES[i].attribute != nullptr)
            identity.settings[i] = text_attribute(image, NAMES[i].attribute, name);
    }
    identity.settings[0] = size_text(image.full);
    identity.settings[1] = crop_text(image.data);
    return identity;
}

void set_maker(Image& image, const Maker& maker) {
    image.attributes["candela.device"] = maker.device;
    image.attributes["candela.driver"] = maker.driver;
    image.attributes["candela.version"] = maker.version;
}

Maker maker_of(const Image& image, const std::string& name) {
    return {.device = text_attribute(image, "candela.device", name),
            .driver = text_attribute(image, "candela.driver", name),
            .version = text_attribute(image, "candela.version", name)};
}

std::string to_text(const Maker& maker) {
    return maker.device + ", driver " + maker.driver + ", candela " + maker.version;
}

std::string difference(const Identity& theirs, const Identity& ours) {
    std::string text;
    for (size_t i = 0; i < NAMES.size(); ++i) {
        if (theirs.settings[i] == ours.settings[i]) continue;
        text += (text.empty() ? "its " : ", its ") + std::string(NAMES[i].word) + " is " +
                theirs.settings[i] + ", not " + ours.settings[i];
    }
    if (text.empty() && theirs.hash != ours.hash) text = "it shows another scene, or another version of it";
    return text;
}

}  // namespace candela
