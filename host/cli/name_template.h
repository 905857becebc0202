// The name of a picture's file with fields in braces, such as `out/{stem}/{view:03}.png`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace candela {

// What the fields of a name stand for.
struct NameFields {
    std::string stem{}, name{}, folder{};  // Of the scene's file: without and with its extension; its folder.
    std::optional<std::string> camera{};   // None as long as it is not known.
    std::optional<std::string> scene{};    // As --scene
    std::optional<std::string> variant{};  // and --variant name them.
    uint32_t view = 0;                     // Number of the picture among those of its scene.
    std::optional<uint32_t> frame = 0;     // Number of the frame; none as long as it is not known.
};

// The fields of the pictures of a scene, from the name of its file.
NameFields fields_of(const std::string& scene_file);

class NameTemplate {
  public:
    // Reads `{FIELD}` and, for numbers, `{FIELD:0WIDTH}`; `{{` and `}}` are braces. Throws Error (usage),
    // which names the option, for anything else between braces.
    explicit NameTemplate(const std::string& text, const char* option = "-o");

    const std::string& text() const { return text_; }
    const char* option() const { return option_; }
    bool uses(std::string_view field) const;
    // Whether a field is part of the name of a folder.
    bool names_folders() const;

    // The name for these fields; none if it needs a camera or a frame that is not known yet. In the text of a
    // field, slashes, backslashes and control characters become `_`, and so does a dot at its beginning: no
    // scene can give its pictures a name in another folder. An empty text becomes `_`. Throws Error (usage)
    // for {scene} and {variant} without their options.
    std::optional<std::string> name(const NameFields& fields) const;
    // The same, with the field itself in the place of what is not known yet.
    std::string open_name(const NameFields& fields) const;

  private:
    struct Field {
        std::string name;
        int width = 0;
    };

    [[noreturn]] void refuse(const std::string& message) const;
    Field parse_field(std::string_view field) const;
    std::string text_of(const NameFields& fields, const std::string& field) const;

    std::string text_;
    const char* option_;
    std::vector<std::variant<std::string, Field>> parts_;
};

}  // namespace candela
