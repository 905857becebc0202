// See identity.h.
#include "film/identity.h"

#include <charconv>
#include <cstdio>

#include "base/error.h"
#include "base/printable.h"

namespace candela {
namespace {

constexpr const char* HASH_ATTRIBUTE = "candela.identity";
constexpr const char* FRAME_ATTRIBUTE = "candela.frame";
constexpr const char* OLDER = "that of an older candela";
constexpr const char* ANOTHER_SCENE = "it shows another scene, or another version of it";

// The settings' names in messages, and the attributes that hold them; size and crop are the image's own.
struct SettingName {
    const char* word;
    const char* attribute;
    const char* older = nullptr;  // What it is where an older candela did not write the attribute.
};
constexpr std::array<SettingName, Identity::SETTING_COUNT> NAMES{
    {{"size", nullptr},
     {"crop", nullptr},
     {"seed", "candela.seed"},
     {"sampler", "candela.sampler"},
     {"estimator", "candela.estimator"},
     {"light sampler", "candela.lightSampler"},
     {"terminator", "candela.terminator"},
     {"max depth", "candela.maxDepth"},
     {"rr depth", "candela.rrDepth"},
     {"filter", "candela.filter", "box,1"},
     {"clamp of indirect light", "candela.clampIndirect", NO_CLAMP_TEXT},
     {"camera", "candela.camera"},
     {"frame", FRAME_ATTRIBUTE, OLDER}}};

}  // namespace

std::string size_text(uvec2 size) {
    return std::to_string(size.x) + 'x' + std::to_string(size.y);
}

std::string crop_text(const PixelRect& crop) {
    return std::to_string(crop.x0) + ',' + std::to_string(crop.y0) + ',' + std::to_string(crop.x1) + ',' +
           std::to_string(crop.y1);
}

std::string hexadecimal(uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

void set_identity(Image& image, const Identity& identity) {
    image.attributes[HASH_ATTRIBUTE] = hexadecimal(identity.hash);
    for (size_t i = 0; i < NAMES.size(); ++i) {
        if (NAMES[i].attribute != nullptr) image.attributes[NAMES[i].attribute] = identity.settings[i];
    }
}

std::string text_attribute(const Image& image, const std::string& attribute, const std::string& name) {
    const auto found = image.attributes.find(attribute);
    if (found == image.attributes.end() || !std::holds_alternative<std::string>(found->second)) {
        throw Error(name + ": the attribute " + attribute +
                    " is missing; give a file that candela render wrote, unchanged");
    }
    return std::get<std::string>(found->second);
}

Identity identity_of(const Image& image, const std::string& name) {
    Identity identity;
    const std::string text = text_attribute(image, HASH_ATTRIBUTE, name);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), identity.hash, 16);
    if (error != std::errc{} || end != text.data() + text.size()) {
        throw Error(name + ": the attribute " + HASH_ATTRIBUTE + " is \"" + printable(text, MAX_NAME_BYTES) +
                    "\"; give a file that candela render wrote, unchanged");
    }
    for (size_t i = 0; i < NAMES.size(); ++i) {
        if (NAMES[i].attribute == nullptr) continue;
        const bool is_older = NAMES[i].older != nullptr && !image.attributes.contains(NAMES[i].attribute);
        identity.settings[i] = is_older ? NAMES[i].older : text_attribute(image, NAMES[i].attribute, name);
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
    return printable(maker.device, MAX_NAME_BYTES) + ", driver " + printable(maker.driver, MAX_NAME_BYTES) +
           ", candela " + printable(maker.version, MAX_NAME_BYTES);
}

std::string difference(const Identity& theirs, const Identity& ours) {
    std::string text;
    for (size_t i = 0; i < NAMES.size(); ++i) {
        if (theirs.settings[i] == ours.settings[i]) continue;
        // The frame is determined by the scene.
        const bool older = theirs.settings[i] == OLDER || ours.settings[i] == OLDER;
        if (NAMES[i].attribute == FRAME_ATTRIBUTE && !older && text.empty()) text = ANOTHER_SCENE;
        text += (text.empty() ? "its " : ", its ") + std::string(NAMES[i].word) + " is " +
                printable(theirs.settings[i], MAX_NAME_BYTES) + ", not " +
                printable(ours.settings[i], MAX_NAME_BYTES);
    }
    if (text.empty() && theirs.hash != ours.hash) text = ANOTHER_SCENE;
    return text;
}

}  // namespace candela
