// One pass over the lines. tinyobjloader could read these files as well, but it takes malformed numbers for 0
// and does not say what is absent.
#include "load/obj/mtl.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "load/obj/mtl_ignored.h"
#include "load/quote.h"
#include "load/text_lines.h"

namespace candela {
namespace {

// The textures that are read; the others are ignored.
constexpr std::array<std::string_view, 12> READ{"map_Kd", "map_Ks", "map_Ke",   "map_Ns",
                                                "map_d",  "map_Pr", "map_Pm",   "norm",
                                                "map_Kn", "bump",   "map_bump", "map_Bump"};
constexpr std::array<std::string_view, 3> NOT_READ{"disp", "decal", "refl"};

template <size_t N>
bool is_one_of(const std::array<std::string_view, N>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

class Reader {
  public:
    explicit Reader(std::string file) : file_(std::move(file)) {}

    MtlLibrary read(std::string_view text) {
        refuse_byte_order_mark(text, file_);
        for_each_line(text, [this](uint64_t line, std::string_view command, std::string_view rest) {
            line_ = line;
            if (!command.empty() && !command.starts_with('#')) read_line(command, rest);
        });
        finish();
        if (library_.materials.empty()) {
            throw Error(file_ + ": the file has no materials (lines \"newmtl name\"); is it an MTL file?");
        }
        std::ranges::copy(ignored_.warnings(file_), std::back_inserter(library_.warnings));
        return std::move(library_);
    }

  private:
    std::string place() const { return file_ + ':' + std::to_string(line_); }

    [[noreturn]] void fail(const std::string& cause) const { throw Error(place() + ": " + cause); }

    void read_line(std::string_view command, std::string_view rest) {
        if (command == "newmtl") {
            finish();
            current_.emplace();
            current_->name = trimmed(rest);
            current_->line = line_;
            if (current_->name.empty()) fail("newmtl needs the name of the material");
        } else if (!current_) {
            fail(shown(quote(command)) + " stands before the first newmtl; is it an MTL file?");
        } else {
            read_statement(*current_, command, rest);
        }
    }

    void read_statement(MtlStatements& s, std::string_view command, std::string_view rest) {
        if (command == "Kd") {
            s.kd = colour(command, rest);
        } else if (command == "Ks") {
            s.ks = colour(command, rest);
        } else if (command == "Ke") {
            s.ke = colour(command, rest);
        } else if (command == "Ns") {
            s.ns = number(command, rest);
            if (s.ns < 0.0) fail("Ns, an exponent, must not be negative");
        } else if (command == "Ni") {
            s.ni = number(command, rest);
            s.ni_line = line_;
        } else if (command == "illum") {
            s.illum = illumination(next_word(rest));
        } else if (command == "d") {
            s.d = number(command, rest);
        } else if (command == "Tr") {
            s.tr = number(command, rest);
        } else if (command == "Pr") {
            s.pr = share(command, rest);
        } else if (command == "Pm") {
            s.pm = share(command, rest);
        } else if (is_one_of(READ, command)) {
            read_texture(s, command, rest);
        } else if (command.starts_with("map_") || is_one_of(NOT_READ, command)) {
            ignored_.add(command, "textures of these kinds are not supported");
        } else if (command != "Ka" && command != "Tf" && command != "sharpness") {
            ignored_.add(command, "unknown statements");
        }
    }

    void read_texture(MtlStatements& s, std::string_view command, std::string_view rest) {
        MtlTexture texture = parse_mtl_texture(command, rest, place());
        for (const std::string& option : texture.ignored)
            ignored_.add(option, "options of textures that are not supported");
        if (command == "map_Kn") command = "norm";
        if (command == "map_bump" || command == "map_Bump") command = "bump";
        s.textures[std::string(command)] = std::move(texture);
    }

    double share(std::string_view command, std::string_view rest) const {
        const double value = number(command, rest);
        if (value >= 0.0 && value <= 1.0) return value;
        fail(std::string(command) + " needs a number from 0 to 1, found " + shown(number_text(value, 6)));
    }

    double number(std::string_view command, std::string_view rest) const {
        std::string_view word = next_word(rest);
        if (command == "d" && word == "-halo") word = next_word(rest);
        if (const auto value = parse_finite(word)) return *value;
        fail(std::string(command) + " needs a finite number, found " + shown(quote(word)));
    }

    // One number for grey, or three; what follows the three is ignored.
    dvec3 colour(std::string_view command, std::string_view rest) const {
        std::vector<double> values;
        for (std::string_view word = next_word(rest);
             values.size() < 3 && !word.empty() && !word.starts_with('#'); word = next_word(rest)) {
            const auto value = parse_finite(word);
            if (!value || *value < 0.0) {
                fail(std::string(command) + " needs finite numbers of at least 0, found " +
                     shown(quote(word)));
            }
            values.push_back(*value);
        }
        if (values.size() == 1) return dvec3(values[0]);
        if (values.size() == 3) return {values[0], values[1], values[2]};
        fail(std::string(command) + " needs one or three numbers, found " + std::to_string(values.size()));
    }

    uint32_t illumination(std::string_view word) const {
        constexpr uint32_t LAST = 10;
        const char* end = word.data() + word.size();
        uint32_t value = 0;
        const auto [stop, error] = std::from_chars(word.data(), end, value);
        if (error == std::errc() && stop == end && value <= LAST) return value;
        fail("illum needs a whole number from 0 to 10, found " + shown(quote(word)));
    }

    // Adds the material that ends here, if there is one.
    void finish() {
        if (!current_) return;
        const MtlStatements s = *std::exchange(current_, std::nullopt);
        if (!library_.materials.contains(s.name)) {
            library_.materials.emplace(s.name, mtl_material(s, file_, ignored_));
        } else {
            library_.warnings.push_back(file_ + ':' + std::to_string(s.line) + ": material " + quote(s.name) +
                                        " is defined again; the first definition counts");
        }
    }

    std::string file_;
    uint64_t line_ = 0;
    std::optional<MtlStatements> current_;
    MtlIgnored ignored_;
    MtlLibrary library_;
};

}  // namespace

MtlLibrary load_mtl(const std::filesystem::path& file, const FileReach& reach) {
    return Reader(file.string()).read(reach.read(file));
}

}  // namespace candela
