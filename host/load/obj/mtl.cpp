// One pass over the lines. tinyobjloader could read these files as well, but it reads malformed numbers as 0
// and does not report what is absent.
#include "load/obj/mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "load/obj/counted_warnings.h"
#include "load/obj/mtl_ignored.h"
#include "load/quote.h"
#include "load/text_lines.h"

namespace candela {
namespace {

// Statements that are read, or ignored without a warning.
constexpr std::array<std::string_view, 33> KNOWN{
    "newmtl", "Ka",     "Kd",     "Ks",       "Ke",       "Tf",       "Ns",     "Ni",     "illum",
    "d",      "Tr",     "Pr",     "Pm",       "Ps",       "Pc",       "Pcr",    "aniso",  "anisor",
    "map_Ka", "map_Kd", "map_Ks", "map_Ke",   "map_Ns",   "map_d",    "map_Pr", "map_Pm", "norm",
    "map_Kn", "bump",   "refl",   "map_bump", "map_refl", "sharpness"};
constexpr std::array<std::string_view, 13> TEXTURES{"map_Kd",   "map_Ks", "map_Ke",  "map_Ns", "map_d",
                                                    "map_Pr",   "map_Pm", "norm",    "map_Kn", "bump",
                                                    "map_bump", "refl",   "map_refl"};
constexpr std::array<std::string_view, 2> OTHER_TEXTURES{"disp", "decal"};

template <size_t N>
bool is_one_of(const std::array<std::string_view, N>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

// A command in the spelling of the format.
std::string_view spelled(std::string_view command) {
    if (is_one_of(KNOWN, command)) return command;
    const std::string lower = lower_case(command);
    const auto* const known = std::ranges::find(KNOWN, lower, [](auto name) { return lower_case(name); });
    return known == KNOWN.end() ? command : *known;
}

class Reader {
  public:
    explicit Reader(std::string file) : file_(std::move(file)) {}

    MtlLibrary read(std::string_view text) {
        text = without_byte_order_mark(text);
        by_blender_ = text.starts_with("# Blender");
        for_each_line(text, [this](uint64_t line, std::string_view command, std::string_view rest) {
            line_ = line;
            if (!command.empty() && !command.starts_with('#')) read_line(spelled(command), rest);
        });
        finish();
        if (library_.materials.empty()) library_.warnings.push_back(file_ + ": the file has no materials");
        std::ranges::move(warnings_.texts(), std::back_inserter(library_.warnings));
        std::ranges::move(ignored_.warnings(file_), std::back_inserter(library_.warnings));
        return std::move(library_);
    }

  private:
    std::string place() const { return file_ + ':' + std::to_string(line_); }

    [[noreturn]] void fail(const std::string& cause) const { throw Error(place() + ": " + cause); }

    void warn(const std::string& kind, const std::string& what) {
        warnings_.add(kind, place() + ": " + what);
    }

    void read_line(std::string_view command, std::string_view rest) {
        if (command == "newmtl") {
            finish();
            current_.emplace();
            current_->name = trimmed(rest);
            current_->line = line_;
            current_->by_blender = by_blender_;
        } else if (!current_) {
            fail(shown(quote(command)) + " comes before the first newmtl; is it an MTL file?");
        } else {
            read_statement(*current_, command, rest);
        }
    }

    void read_statement(MtlStatements& s, std::string_view command, std::string_view rest) {
        constexpr double NONE = -std::numeric_limits<double>::infinity();
        constexpr double MAX = std::numeric_limits<double>::infinity();
        if (command == "Kd") {
            set(s.kd, colour(command, rest));
        } else if (command == "Ks") {
            set(s.ks, colour(command, rest));
        } else if (command == "Ke") {
            set(s.ke, colour(command, rest));
        } else if (command == "Ka" || command == "Tf") {
            // Spectra are ignored here.
            std::string_view words = rest;
            if (parse_number(next_word(words))) set(command == "Ka" ? s.ka : s.tf, colour(command, rest));
        } else if (command == "Ns") {
            set(s.ns, number(command, rest, 0.0, MAX));
        } else if (command == "Ni") {
            set(s.ni, number(command, rest, NONE, MAX));
        } else if (command == "illum") {
            s.illum = illumination(next_word(rest));
        } else if (command == "d") {
            set(s.d, number(command, rest, NONE, MAX));
        } else if (command == "Tr") {
            set(s.tr, number(command, rest, NONE, MAX));
        } else if (command.starts_with('P')) {
            read_fraction(s, command, rest);
        } else if (command == "aniso" || command == "anisor") {
            if (command == "aniso" && number(command, rest, NONE, MAX).value_or(0.0) != 0.0)
                ignored_.add(command, "brushed metal is not supported");
        } else {
            read_other(s, command, rest);
        }
    }

    // Statements of the PBR extension, from 0 to 1.
    void read_fraction(MtlStatements& s, std::string_view command, std::string_view rest) {
        using Member = std::optional<double> MtlStatements::*;
        constexpr std::array<std::pair<std::string_view, Member>, 5> FRACTIONS{
            {{"Pr", &MtlStatements::pr},
             {"Pm", &MtlStatements::pm},
             {"Ps", &MtlStatements::ps},
             {"Pc", &MtlStatements::pc},
             {"Pcr", &MtlStatements::pcr}}};
        for (const auto& [name, member] : FRACTIONS) {
            if (command == name) return set(s.*member, number(command, rest, 0.0, 1.0));
        }
        ignored_.add(command, "unknown statements");
    }

    void read_other(MtlStatements& s, std::string_view command, std::string_view rest) {
        // Blender writes its metalness in a texture of that name.
        const bool is_reflection = command == "refl" || command == "map_refl";
        if (is_reflection && by_blender_) {
            read_texture(s, "map_Pm", rest);
        } else if (is_one_of(TEXTURES, command) && !is_reflection) {
            read_texture(s, command, rest);
        } else if (is_one_of(OTHER_TEXTURES, command) || is_reflection ||
                   (command.starts_with("map_") && command != "map_Ka")) {
            ignored_.add(command, "textures of these kinds are not supported");
        } else if (command != "map_Ka" && command != "sharpness") {
            ignored_.add(command, "unknown statements");
        }
    }

    void read_texture(MtlStatements& s, std::string_view command, std::string_view rest) {
        MtlTexture texture = parse_mtl_texture(command, rest, place());
        for (const std::string& option : texture.ignored)
            ignored_.add(option, "options of textures that are not supported");
        if (texture.file.empty()) {
            return warn(std::string(command) + " without a file",
                        std::string(command) + " names no file, and is ignored");
        }
        if (command == "map_Kn") command = "norm";
        if (command == "map_bump") command = "bump";
        s.textures[std::string(command)] = std::move(texture);
    }

    // Keeps the earlier value if there is no new one.
    template <class Value>
    static void set(std::optional<Value>& value, const std::optional<Value>& stated) {
        if (stated) value = stated;
    }

    // A word's number. Nothing, with a warning, if it is missing or not finite.
    std::optional<double> finite(std::string_view command, std::string_view word) {
        const auto value = parse_number(word);
        if (!value && !word.empty() && !word.starts_with('#') && word.find(".#") == std::string_view::npos)
            fail(std::string(command) + " needs a number, found " + shown(quote(word)));
        if (value && parse_finite(word)) return value;
        warn(std::string(command) + " without a number",
             std::string(command) + " has no finite number, and is ignored");
        return std::nullopt;
    }

    std::optional<double> number(std::string_view command, std::string_view rest, double min, double max) {
        std::string_view word = next_word(rest);
        if (command == "d" && word == "-halo") word = next_word(rest);
        const auto value = finite(command, word);
        if (!value || (*value >= min && *value <= max)) return value;
        const double nearest = std::clamp(*value, min, max);
        warn(std::string(command) + " out of range",
             concat(command, ' ', shown(number_text(*value, 6)), " is read as ", number_text(nearest, 6)));
        return nearest;
    }

    // One number for grey, or three; what follows the three is ignored.
    std::optional<dvec3> colour(std::string_view command, std::string_view rest) {
        std::vector<double> values;
        for (std::string_view word = next_word(rest);
             values.size() < 3 && !word.empty() && !word.starts_with('#'); word = next_word(rest)) {
            auto value = finite(command, word);
            if (!value) return std::nullopt;
            if (*value < 0.0)
                warn(std::string(command) + " below 0", std::string(command) + " is negative; 0 is used");
            values.push_back(std::max(*value, 0.0));
        }
        if (values.size() == 1) return dvec3(values[0]);
        if (values.size() == 3) return dvec3(values[0], values[1], values[2]);
        fail(std::string(command) + " needs one or three numbers, found " + std::to_string(values.size()));
    }

    uint32_t illumination(std::string_view word) {
        constexpr double LAST = 10.0;
        constexpr uint32_t USUAL = 2;
        const auto value = parse_finite(word);
        if (value && *value >= 0.0 && *value <= LAST && std::trunc(*value) == *value) return uint32_t(*value);
        warn("illum",
             "illum " + shown(quote(word)) + " is not a whole number from 0 to 10, and is read as 2");
        return USUAL;
    }

    // Adds the material that ends here, if there is one that faces may name.
    void finish() {
        if (!current_) return;
        const MtlStatements s = *std::exchange(current_, std::nullopt);
        if (s.name.empty()) return;
        if (!library_.materials.contains(s.name)) {
            library_.materials.emplace(s.name, mtl_material(s, file_, ignored_));
        } else {
            warnings_.add("again", concat(file_, ':', s.line, ": material ", quote(s.name),
                                          " is defined again; the first definition is used"));
        }
    }

    std::string file_;
    uint64_t line_ = 0;
    bool by_blender_ = false;
    std::optional<MtlStatements> current_;
    CountedWarnings warnings_;
    MtlIgnored ignored_;
    MtlLibrary library_;
};

}  // namespace

MtlLibrary load_mtl(const std::filesystem::path& file, const FileReach& reach) {
    return Reader(file.string()).read(reach.read(file));
}

}  // namespace candela
