// Two passes over the lines of an OBJ file: one counts what faces may refer to, one checks. All else is left
// to tinyobjloader.
#include "load/obj/obj_check.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "load/quote.h"
#include "load/text_lines.h"
#include "scene/polygon.h"

namespace candela {
namespace {

constexpr size_t MOST_CHARACTERS = 64;  // In a number. tinyobjloader overflows inside longer ones.

// What a face refers to, in the order of `1/2/3`.
struct Kind {
    std::string_view command;
    const char* singular;
    const char* plural;
};
constexpr std::array<Kind, 3> KINDS{{{"v", "vertex", "vertices"},
                                     {"vt", "texture coordinate", "texture coordinates"},
                                     {"vn", "normal", "normals"}}};

class Checker {
  public:
    Checker(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    void run() {
        refuse_byte_order_mark(text_, file_);
        for_each_line(text_, [this](uint64_t, std::string_view command, std::string_view) {
            if (const auto kind = kind_of(command)) ++totals_[*kind];
        });
        for_each_line(text_, [this](uint64_t line, std::string_view command, std::string_view rest) {
            line_ = line;
            check_line(command, rest);
        });
        if (faces_ == 0)
            throw Error(file_ + ": the file has no faces (lines \"f 1 2 3\"); is it a Wavefront OBJ file?");
    }

  private:
    static std::optional<size_t> kind_of(std::string_view command) {
        for (size_t i = 0; i < KINDS.size(); ++i) {
            if (KINDS[i].command == command) return i;
        }
        return std::nullopt;
    }

    [[noreturn]] void fail(const std::string& cause) const {
        throw Error(file_ + ':' + std::to_string(line_) + ": " + cause);
    }

    void check_line(std::string_view command, std::string_view rest) {
        if (command == "f") return check_face(rest);
        const auto kind = kind_of(command);
        if (!kind) return;
        ++counts_[*kind];
        if (command == "vt") return;  // Not used.
        for (int i = 0; i < 3; ++i)
            check_number(next_word(rest), KINDS[*kind]);
    }

    void check_number(std::string_view word, const Kind& kind) const {
        if (word.empty())
            fail("a " + std::string(kind.singular) + " needs three numbers; is the file cut off?");
        if (word.size() <= MOST_CHARACTERS && parse_finite(word)) return;
        fail("a " + std::string(kind.singular) + " needs three finite numbers, found " + quote(word));
    }

    void check_face(std::string_view rest) {
        ++faces_;
        size_t corners = 0;
        for (std::string_view corner = next_word(rest); !corner.empty(); corner = next_word(rest)) {
            check_corner(corner);
            ++corners;
        }
        if (corners < 3)
            fail(face() + " has " + std::to_string(corners) + " corners; a face needs at least 3");
        if (corners > MOST_CORNERS) {
            fail(face() + " has " + std::to_string(corners) + " corners, but at most " +
                 std::to_string(MOST_CORNERS) + " are read; cut it into triangles");
        }
    }

    // `corner` is v, v/vt, v//vn or v/vt/vn.
    void check_corner(std::string_view corner) const {
        std::string_view rest = corner;
        for (size_t kind = 0; kind < KINDS.size(); ++kind) {
            const size_t slash = rest.find('/');
            const bool may_be_empty = KINDS[kind].command == "vt" && slash != std::string_view::npos;
            if (slash != 0 || !may_be_empty) check_index(rest.substr(0, slash), kind, corner);
            if (slash == std::string_view::npos) return;
            rest.remove_prefix(slash + 1);
        }
        fail_malformed(corner);
    }

    void check_index(std::string_view word, size_t kind, std::string_view corner) const {
        int64_t index = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc() || stop != word.data() + word.size()) fail_malformed(corner);
        if (index != 0 && index >= -counts_[kind] && index <= totals_[kind]) return;
        const std::string use = face() + " uses " + KINDS[kind].singular + ' ' + std::to_string(index);
        const std::string plural = KINDS[kind].plural;
        if (index == 0) fail(use + "; indices count from 1, or backwards from -1");
        if (index > 0) fail(use + ", but the file has " + std::to_string(totals_[kind]) + ' ' + plural);
        fail(use + ", but only " + std::to_string(counts_[kind]) + ' ' + plural + " stand before it");
    }

    [[noreturn]] void fail_malformed(std::string_view corner) const {
        fail(face() + " has the malformed corner " + quote(corner) + "; write 1, 1/2, 1//3 or 1/2/3");
    }

    std::string face() const { return "face " + std::to_string(faces_); }

    std::string_view text_;
    const std::string& file_;
    std::array<int64_t, 3> totals_{};  // Of each kind, in the whole file.
    std::array<int64_t, 3> counts_{};  // Of each kind, so far.
    uint64_t faces_ = 0;               // So far, the current one included.
    uint64_t line_ = 0;
};

}  // namespace

void check_obj(std::string_view text, const std::string& file) {
    Checker(text, file).run();
}

}  // namespace candela
