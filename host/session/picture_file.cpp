// See picture_file.h.
#include "session/picture_file.h"

#include <string>
#include <variant>

#include "film/catcher_layers.h"
#include "film/id_layers.h"
#include "scene/studio.h"

namespace candela {

const Background* default_background(const Image& image) {
    static const Background grey = vec3(0.5f);  // #bcbcbc.
    if (image.find(CATCHER_ALPHA) != nullptr) return &grey;
    const auto studio = image.attributes.find(STUDIO_ATTRIBUTE);
    if (studio == image.attributes.end()) return nullptr;
    const auto* const name = std::get_if<std::string>(&studio->second);
    return name != nullptr && is_unseen_studio(*name) ? &grey : nullptr;
}

PictureNotes picture_notes(const Image& image) {
    PictureNotes notes;
    for (const auto& [name, attribute] : image.attributes) {
        const auto* const text = std::get_if<std::string>(&attribute);
        const bool is_for_exr = name == "candela.commandLine" || is_label_attribute(name);
        if (text != nullptr && !is_for_exr) notes.texts.emplace_back(name, *text);
    }
    return notes;
}

}  // namespace candela
