// See name_template.h.
#include "cli/name_template.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/error.h"
#include "base/text.h"
#include "cli/arguments.h"

namespace candela {
namespace {

constexpr std::array<std::string_view, 6> TEXTS{"stem", "name", "folder", "camera", "scene", "variant"};
constexpr std::array<std::string_view, 2> NUMBERS{"view", "frame"};
constexpr const char* FIELDS = "{stem}, {name}, {folder}, {camera}, {view}, {frame}, {scene}, {variant}";

// The largest width of a number.
constexpr uint32_t MAX_WIDTH = 9;

// The text as a part of the name of a file.
std::string harmless(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c == '/' || c == '\\' || c < ' ' || c == 127; }, '_');
    if (text.empty()) return "_";
    if (text.front() == '.') text.front() = '_';
    return text;
}

std::string padded(uint32_t number, int width) {
    const std::string digits = std::to_string(number);
    return std::string(size_t(std::max(0, width - int(digits.size()))), '0') + digits;
}

}  // namespace

NameFields fields_of(const std::string& scene_file) {
    const std::filesystem::path path(scene_file);
    std::error_code ignored;
    return {
        .stem = path.stem().string(),
        .name = path.filename().string(),
        .folder =
            std::filesystem::absolute(path, ignored).lexically_normal().parent_path().filename().string()};
}

void NameTemplate::refuse(const std::string& message) const {
    throw Error(concat(option_, ": ", message), ErrorKind::request);
}

NameTemplate::NameTemplate(const std::string& text, const char* option) : text_(text), option_(option) {
    std::string literal;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c != '{' && c != '}') {
            literal += c;
        } else if (i + 1 < text.size() && text[i + 1] == c) {
            literal += c;
            ++i;
        } else {
            const size_t end = c == '{' ? text.find('}', i) : std::string::npos;
            if (end == std::string::npos) {
                refuse("\"" + text +
                       "\" has a single brace; write {{ or }} for a brace of the name, or one of " + FIELDS);
            }
            parts_.emplace_back(std::move(literal));
            parts_.emplace_back(parse_field(std::string_view(text).substr(i + 1, end - i - 1)));
            literal.clear();
            i = end;
        }
    }
    parts_.emplace_back(std::move(literal));
}

NameTemplate::Field NameTemplate::parse_field(std::string_view field) const {
    const size_t colon = field.find(':');
    const std::string name(field.substr(0, colon));
    const bool is_number = std::ranges::find(NUMBERS, name) != NUMBERS.end();
    if (!is_number && std::ranges::find(TEXTS, name) == TEXTS.end())
        refuse("\"" + text_ + "\" has the unknown field {" + std::string(field) + "}; the fields are " +
               FIELDS);
    if (colon == std::string_view::npos) return {name};
    const std::string format(field.substr(colon + 1));
    const auto width = format.starts_with('0') ? parse_uint(format.substr(1), 1, MAX_WIDTH) : std::nullopt;
    if (!is_number || !width) {
        refuse("cannot use {" + std::string(field) +
               "}; only {view} and {frame} can have a number of digits, from {view:01} to {view:09}");
    }
    return {name, int(*width)};
}

std::string NameTemplate::text_of(const NameFields& fields, const std::string& field) const {
    if (field == "stem") return fields.stem;
    if (field == "name") return fields.name;
    if (field == "folder") return fields.folder;
    if (field == "camera") return *fields.camera;
    const std::optional<std::string>& value = field == "scene" ? fields.scene : fields.variant;
    if (!value)
        refuse('{' + field + "} is what --" + field + " names; give --" + field + ", or leave it out");
    return *value;
}

bool NameTemplate::uses(std::string_view field) const {
    return std::ranges::any_of(parts_, [&](const auto& part) {
        const auto* const used = std::get_if<Field>(&part);
        return used != nullptr && used->name == field;
    });
}

bool NameTemplate::names_folders() const {
    bool field = false;
    for (const auto& part : parts_) {
        const auto* const literal = std::get_if<std::string>(&part);
        field = field || literal == nullptr;
        if (field && literal != nullptr && literal->find('/') != std::string::npos) return true;
    }
    return false;
}

std::optional<std::string> NameTemplate::name(const NameFields& fields) const {
    if ((!fields.camera && uses("camera")) || (!fields.frame && uses("frame"))) return std::nullopt;
    return open_name(fields);
}

std::string NameTemplate::open_name(const NameFields& fields) const {
    std::string name;
    for (const auto& part : parts_) {
        if (const auto* const literal = std::get_if<std::string>(&part)) {
            name += *literal;
            continue;
        }
        const Field& field = std::get<Field>(part);
        const bool is_open =
            (field.name == "camera" && !fields.camera) || (field.name == "frame" && !fields.frame);
        const bool is_number = std::ranges::find(NUMBERS, field.name) != NUMBERS.end();
        name += is_open     ? '{' + field.name + '}'
                : is_number ? padded(field.name == "view" ? fields.view : *fields.frame, field.width)
                            : harmless(text_of(fields, field.name));
    }
    return name;
}

}  // namespace candela
