// Two passes over the lines of an OBJ file: one counts what faces may refer to, the other reads.
#include "load/obj/obj_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "load/quote.h"
#include "load/text_lines.h"
#include "scene/polygon.h"
#include "scene/texture.h"

namespace candela {
namespace {

// What the corner of a face refers to, in the order of `1/2/3`.
struct Kind {
    std::string_view command;
    const char* singular;
    const char* plural;
};
constexpr std::array<Kind, 3> KINDS{{{"v", "vertex", "vertices"},
                                     {"vt", "texture coordinate", "texture coordinates"},
                                     {"vn", "normal", "normals"}}};
constexpr size_t POSITION = 0;
constexpr size_t UV = 1;
constexpr size_t NORMAL = 2;

// The indices of a corner, one of each kind.
using Indices = std::array<uint32_t, KINDS.size()>;

// Whether a statement ends before this word.
bool is_end(std::string_view word) {
    return word.empty() || word.starts_with('#');
}

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    ObjFile read() {
        refuse_byte_order_mark(text_, file_);
        uint64_t faces = 0;
        for_each_line(text_, [&](uint64_t, std::string_view command, std::string_view) {
            if (const auto kind = kind_of(command)) ++totals_[*kind];
            if (command == "f") ++faces;
        });
        obj_.positions.reserve(size_t(totals_[POSITION]));
        obj_.uvs.reserve(size_t(totals_[UV]));
        obj_.normals.reserve(size_t(totals_[NORMAL]));
        obj_.corners.reserve(3 * faces);
        if (totals_[UV] > 0) obj_.corner_uvs.reserve(3 * faces);
        obj_.sizes.reserve(faces);
        obj_.use_of.reserve(faces);
        for_each_line(text_, [this](uint64_t line, std::string_view command, std::string_view rest) {
            line_ = line;
            read_line(command, rest);
        });
        if (faces == 0)
            throw Error(file_ + ": the file has no faces (lines \"f 1 2 3\"); is it a Wavefront OBJ file?");
        if (!has_uvs_) {
            obj_.uvs = {};
            obj_.corner_uvs = {};
        }
        return std::move(obj_);
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

    void read_line(std::string_view command, std::string_view rest) {
        if (command == "f") {
            read_face(rest);
        } else if (command == "mtllib") {
            obj_.libraries.push_back({std::string(trimmed(rest)), line_});
        } else if (command == "usemtl") {
            obj_.uses.push_back({std::string(trimmed(rest)), line_});
        } else if (const auto kind = kind_of(command)) {
            ++counts_[*kind];
            if (*kind == POSITION) read_vertex(rest);
            if (*kind == UV) read_uv(rest);
            if (*kind == NORMAL) obj_.normals.emplace_back(read_numbers(rest, KINDS[*kind]));
        }
    }

    void read_vertex(std::string_view rest) {
        const vec3 white(1.0f);
        obj_.positions.push_back(read_numbers(rest, KINDS[POSITION]));
        const std::optional<vec3> color = rest.empty() ? std::nullopt : read_color(rest);
        if (color && obj_.colors.empty()) {
            obj_.colors.reserve(size_t(totals_[POSITION]));
            obj_.colors.resize(obj_.positions.size() - 1, white);
        }
        if (color || !obj_.colors.empty()) obj_.colors.push_back(color.value_or(white));
    }

    // The colour after a position. One number is the w of a rational curve.
    std::optional<vec3> read_color(std::string_view rest) const {
        std::array<std::string_view, 3> words;
        for (std::string_view& word : words) {
            word = next_word(rest);
            if (is_end(word)) return std::nullopt;
        }
        vec3 color;
        for (glm::length_t i = 0; i < 3; ++i) {
            const std::optional<double> number = parse_finite(words[size_t(i)]);
            if (!number || *number < 0.0 || *number > 1.0) {
                fail("the colour of a vertex needs three numbers from 0 to 1, found " +
                     shown(quote(words[size_t(i)])) + "; scale the colours, or leave them out");
            }
            color[i] = float(*number);
        }
        return color;
    }

    void read_uv(std::string_view rest) {
        vec2 uv(0.0f);
        for (glm::length_t i = 0; i < 2; ++i) {
            const std::string_view word = next_word(rest);
            if (is_end(word)) {
                if (i == 0) fail("a texture coordinate needs one to three numbers; is the file cut off?");
                break;
            }
            const std::optional<double> number = parse_finite(word);
            if (!number || std::abs(*number) > MAX_UV)
                fail("a texture coordinate needs finite numbers from -1e30 to 1e30, found " +
                     shown(quote(word)));
            uv[i] = float(*number);
        }
        obj_.uvs.push_back(uv);
    }

    // Cuts three numbers off `rest`.
    glm::dvec3 read_numbers(std::string_view& rest, const Kind& kind) const {
        glm::dvec3 numbers;
        for (glm::length_t i = 0; i < 3; ++i) {
            const std::string_view word = next_word(rest);
            if (word.empty())
                fail("a " + std::string(kind.singular) + " needs three numbers; is the file cut off?");
            const std::optional<double> number = parse_finite(word);
            if (!number)
                fail("a " + std::string(kind.singular) + " needs three finite numbers, found " +
                     shown(quote(word)));
            numbers[i] = *number;
        }
        return numbers;
    }

    void read_face(std::string_view rest) {
        uint32_t corners = 0;
        for (std::string_view corner = next_word(rest); !corner.empty(); corner = next_word(rest)) {
            const Indices read = read_corner(corner);
            if (corners++ >= MOST_CORNERS) continue;
            obj_.corners.push_back({read[POSITION], read[NORMAL]});
            if (totals_[UV] > 0) obj_.corner_uvs.push_back(read[UV]);
            has_uvs_ = has_uvs_ || read[UV] != ObjCorner::NONE;
        }
        if (corners < 3)
            fail(face() + " has " + std::to_string(corners) + " corners; a face needs at least 3");
        if (corners > MOST_CORNERS) {
            fail(face() + " has " + std::to_string(corners) + " corners, but at most " +
                 std::to_string(MOST_CORNERS) + " are read; cut it into triangles");
        }
        obj_.sizes.push_back(corners);
        obj_.use_of.push_back(uint32_t(obj_.uses.size() - 1));
    }

    // `corner` is v, v/vt, v//vn or v/vt/vn.
    Indices read_corner(std::string_view corner) const {
        Indices indices{ObjCorner::NONE, ObjCorner::NONE, ObjCorner::NONE};
        std::string_view rest = corner;
        for (size_t kind = 0; kind < KINDS.size(); ++kind) {
            const size_t slash = rest.find('/');
            const bool may_be_empty = KINDS[kind].command == "vt" && slash != std::string_view::npos;
            if (slash != 0 || !may_be_empty) indices[kind] = read_index(rest.substr(0, slash), kind, corner);
            if (slash == std::string_view::npos) return indices;
            rest.remove_prefix(slash + 1);
        }
        fail_malformed(corner);
    }

    // The index in `word`, counted from 0. Negative ones count backwards from the last element so far.
    uint32_t read_index(std::string_view word, size_t kind, std::string_view corner) const {
        int64_t index = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc() || stop != word.data() + word.size()) fail_malformed(corner);
        if (index != 0 && index >= -counts_[kind] && index <= totals_[kind])
            return uint32_t(index > 0 ? index - 1 : counts_[kind] + index);
        const std::string use = face() + " uses " + KINDS[kind].singular + ' ' + shown(std::to_string(index));
        const std::string plural = KINDS[kind].plural;
        if (index == 0) fail(use + "; indices count from 1, or backwards from -1");
        if (index > 0) fail(use + ", but the file has " + std::to_string(totals_[kind]) + ' ' + plural);
        fail(use + ", but only " + std::to_string(counts_[kind]) + ' ' + plural + " stand before it");
    }

    [[noreturn]] void fail_malformed(std::string_view corner) const {
        fail(face() + " has the malformed corner " + shown(quote(corner)) + "; write 1, 1/2, 1//3 or 1/2/3");
    }

    // The current face, counted from 1.
    std::string face() const { return "face " + std::to_string(obj_.sizes.size() + 1); }

    std::string_view text_;
    const std::string& file_;
    std::array<int64_t, 3> totals_{};  // Of each kind, in the whole file.
    std::array<int64_t, 3> counts_{};  // Of each kind, so far.
    uint64_t line_ = 0;
    bool has_uvs_ = false;  // Whether a corner has texture coordinates.
    ObjFile obj_;
};

}  // namespace

ObjFile parse_obj(std::string_view text, const std::string& file) {
    return ObjReader(text, file).read();
}

}  // namespace candela
