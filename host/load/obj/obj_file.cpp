// Two passes over the lines of an OBJ file: one counts the vertices, the other reads.
#include "load/obj/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "load/obj/counted_warnings.h"
#include "load/obj/obj_colors.h"
#include "load/obj/obj_statements.h"
#include "load/quote.h"
#include "scene/polygon.h"
#include "scene/texture.h"

namespace candela {
namespace {

// The indices of a corner, one of each kind.
using Indices = std::array<uint32_t, OBJ_KINDS.size()>;

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& file)
        : text_(without_byte_order_mark(text)), file_(file) {}

    ObjFile read() {
        uint64_t faces = 0;
        for_each_obj_statement(text_, [&](uint64_t, std::string_view command, std::string_view) {
            if (const auto kind = obj_kind_of(command)) ++totals_[*kind];
            if (is_obj_face(command)) ++faces;
            has_objects_ = has_objects_ || command == "o";
            has_groups_ = has_groups_ || command == "o" || command == "g";
        });
        obj_.positions.reserve(size_t(totals_[OBJ_POSITION]));
        obj_.uvs.reserve(size_t(totals_[OBJ_UV]));
        obj_.normals.reserve(size_t(totals_[OBJ_NORMAL]));
        obj_.corners.reserve(3 * faces);
        if (totals_[OBJ_UV] > 0) obj_.corner_uvs.reserve(3 * faces);
        obj_.sizes.reserve(faces);
        obj_.use_of.reserve(faces);
        if (has_groups_) obj_.group_of.reserve(faces);
        for_each_obj_statement(text_, [this](uint64_t line, std::string_view command, std::string_view rest) {
            line_ = line;
            read_line(command, rest);
        });
        if (faces == 0)
            throw Error(file_ + ": the file has no faces (lines \"f 1 2 3\"); is it a Wavefront OBJ file?");
        if (!all_finite_) leave_out_faces_that_are_not_finite();
        if (obj_.sizes.empty()) {
            throw Error(
                file_ +
                ": each face has fewer than three corners, or a vertex that is not finite; export the "
                "file again");
        }
        if (!has_uvs_) {
            obj_.uvs = {};
            obj_.corner_uvs = {};
        }
        obj_.warnings = warnings_.texts();
        std::optional<std::string> warning;
        obj_.colors = colors_.linear(obj_.positions.size(), warning);
        if (warning) obj_.warnings.push_back(file_ + ": " + *warning);
        return std::move(obj_);
    }

  private:
    std::string place() const { return file_ + ':' + std::to_string(line_); }

    [[noreturn]] void fail(const std::string& cause) const { throw Error(place() + ": " + cause); }

    void warn(const std::string& what) { warnings_.add(what, place() + ": " + what); }

    void read_line(std::string_view command, std::string_view rest) {
        if (is_obj_face(command)) {
            read_face(rest);
        } else if (command == "mtllib") {
            obj_.libraries.push_back({std::string(trimmed(rest)), line_});
        } else if (command == "usemtl") {
            obj_.uses.push_back({std::string(trimmed(rest)), line_});
        } else if (command == (has_objects_ ? "o" : "g")) {
            group_name_ = trimmed(rest);
            group_ = NO_GROUP;
        } else if (command == "#MRGB") {
            colors_.add_mrgb(trimmed(rest));
        } else if (command == "l" || command == "p") {
            warn("lines and points have no surface, and are left out");
        } else if (command == "curv" || command == "curv2" || command == "surf") {
            warn("curves and surfaces are left out; export the model as a mesh");
        } else if (const auto kind = obj_kind_of(command)) {
            ++counts_[*kind];
            if (*kind == OBJ_POSITION) read_vertex(rest);
            if (*kind == OBJ_UV) read_uv(rest);
            if (*kind == OBJ_NORMAL) read_normal(rest);
        }
    }

    // The index of the group of the faces that follow.
    uint32_t group() {
        if (group_ != NO_GROUP) return group_;
        const auto [known, is_new] = group_indices_.try_emplace(group_name_, uint32_t(obj_.groups.size()));
        if (is_new) obj_.groups.push_back(group_name_);
        return group_ = known->second;
    }

    void read_vertex(std::string_view rest) {
        obj_.positions.push_back(read_numbers(rest, OBJ_KINDS[OBJ_POSITION]));
        all_finite_ = all_finite_ && is_finite(obj_.positions.back());
        if (!rest.empty()) read_color(rest);
    }

    // The colour after a position. One number is the w of a rational curve.
    void read_color(std::string_view rest) {
        std::array<std::string_view, 3> words;
        for (std::string_view& word : words) {
            word = next_word(rest);
            if (is_obj_end(word)) return;
        }
        vec3 color;
        for (glm::length_t i = 0; i < 3; ++i) {
            const std::optional<double> number = obj_number(words[size_t(i)]);
            if (!number) {
                fail("the colour of a vertex needs three numbers, found " + shown(quote(words[size_t(i)])));
            }
            color[i] = float(*number);
        }
        if (!is_finite(color)) return warn("the colour of a vertex is not finite; white is used");
        colors_.add(obj_.positions.size() - 1, color);
    }

    void read_uv(std::string_view rest) {
        vec2 uv(0.0f);
        for (glm::length_t i = 0; i < 2; ++i) {
            const std::string_view word = next_word(rest);
            if (is_obj_end(word)) {
                if (i == 0) fail("a texture coordinate needs one to three numbers; is the file cut off?");
                break;
            }
            const std::optional<double> number = obj_number(word);
            if (!number) fail("a texture coordinate needs numbers, found " + shown(quote(word)));
            if (std::abs(*number) <= MAX_UV) {
                uv[i] = float(*number);
            } else {
                warn("a texture coordinate is not from -1e30 to 1e30; 0 is used");
            }
        }
        obj_.uvs.push_back(uv);
    }

    void read_normal(std::string_view rest) {
        const glm::dvec3 normal = read_numbers(rest, OBJ_KINDS[OBJ_NORMAL]);
        if (!is_finite(normal)) warn("a normal is not finite; the triangle's is used");
        obj_.normals.emplace_back(is_finite(normal) ? normal : glm::dvec3(0.0));
    }

    // Whether no number is NaN; numbers too large for floats are NaN.
    template <class Vector>
    static bool is_finite(Vector v) {
        return !glm::any(glm::isnan(v));
    }

    // Cuts three numbers off `rest`.
    glm::dvec3 read_numbers(std::string_view& rest, const ObjKind& kind) const {
        glm::dvec3 numbers;
        for (glm::length_t i = 0; i < 3; ++i) {
            const std::string_view word = next_word(rest);
            if (word.empty())
                fail("a " + std::string(kind.name) + " needs three numbers; is the file cut off?");
            const std::optional<double> number = obj_number(word);
            if (!number)
                fail("a " + std::string(kind.name) + " needs three numbers, found " + shown(quote(word)));
            numbers[i] = *number;
        }
        return numbers;
    }

    void read_face(std::string_view rest) {
        const size_t begin = obj_.corners.size();
        uint32_t corners = 0;
        for (std::string_view corner = next_word(rest); !is_obj_end(corner); corner = next_word(rest)) {
            const Indices read = read_corner(corner);
            if (corners++ >= MAX_CORNERS) continue;
            obj_.corners.push_back({read[OBJ_POSITION], read[OBJ_NORMAL]});
            if (totals_[OBJ_UV] > 0) obj_.corner_uvs.push_back(read[OBJ_UV]);
            has_uvs_ = has_uvs_ || read[OBJ_UV] != ObjCorner::NONE;
        }
        ++faces_;
        if (corners < 3) {
            obj_.corners.resize(begin);
            if (totals_[OBJ_UV] > 0) obj_.corner_uvs.resize(begin);
            return warn("a face with fewer than three corners is left out");
        }
        if (corners > MAX_CORNERS) {
            fail("face " + std::to_string(faces_) + " has " + std::to_string(corners) +
                 " corners, but at most " + std::to_string(MAX_CORNERS) + " are read; cut it into triangles");
        }
        obj_.sizes.push_back(corners);
        obj_.use_of.push_back(uint32_t(obj_.uses.size() - 1));
        if (has_groups_) obj_.group_of.push_back(group());
    }

    // `corner` is v, v/vt, v//vn or v/vt/vn; slashes at its end are ignored.
    Indices read_corner(std::string_view corner) {
        Indices indices{ObjCorner::NONE, ObjCorner::NONE, ObjCorner::NONE};
        std::string_view rest = corner;
        for (size_t kind = 0; kind < OBJ_KINDS.size(); ++kind) {
            const size_t slash = rest.find('/');
            const std::string_view word = rest.substr(0, slash);
            if (!word.empty() || kind == OBJ_POSITION) indices[kind] = read_index(word, kind, corner);
            if (slash == std::string_view::npos) return indices;
            rest.remove_prefix(slash + 1);
        }
        fail_malformed(corner);
    }

    // The index in `word`, counted from 0. Negative ones count backwards from the last element so far.
    uint32_t read_index(std::string_view word, size_t kind, std::string_view corner) {
        int64_t index = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc() || stop != word.data() + word.size()) fail_malformed(corner);
        if (index != 0 && index >= -counts_[kind] && index <= totals_[kind])
            return uint32_t(index > 0 ? index - 1 : counts_[kind] + index);
        if (kind == OBJ_POSITION) fail_range(index);
        warn(kind == OBJ_NORMAL ? "a corner has a normal that the file lacks; the triangle's is used"
                                : "a corner has texture coordinates that the file lacks; (0, 0) is used");
        return ObjCorner::NONE;
    }

    // Fails for the index of a vertex that the file lacks.
    [[noreturn]] void fail_range(int64_t index) const {
        const std::string use = face() + " uses vertex " + shown(std::to_string(index));
        if (index == 0) fail(use + "; indices count from 1, or backwards from -1");
        if (index > 0)
            fail(use + ", but the file has " + std::to_string(totals_[OBJ_POSITION]) + " vertices");
        fail(use + ", but only " + std::to_string(counts_[OBJ_POSITION]) + " vertices come before it");
    }

    [[noreturn]] void fail_malformed(std::string_view corner) const {
        fail(face() + " has the malformed corner " + shown(quote(corner)) + "; write 1, 1/2, 1//3 or 1/2/3");
    }

    // The current face, counted from 1.
    std::string face() const { return "face " + std::to_string(faces_ + 1); }

    // A vertex may come after the faces that use it.
    void leave_out_faces_that_are_not_finite() {
        size_t kept = 0, kept_corners = 0, begin = 0;
        const size_t faces = obj_.sizes.size();
        for (size_t face = 0; face < faces; ++face) {
            const size_t end = begin + obj_.sizes[face];
            const auto finite = [&](const ObjCorner& corner) {
                return is_finite(obj_.positions[corner.position]);
            };
            if (std::all_of(&obj_.corners[begin], &obj_.corners[begin] + obj_.sizes[face], finite)) {
                for (size_t i = begin; i < end; ++i, ++kept_corners) {
                    obj_.corners[kept_corners] = obj_.corners[i];
                    if (totals_[OBJ_UV] > 0) obj_.corner_uvs[kept_corners] = obj_.corner_uvs[i];
                }
                obj_.sizes[kept] = obj_.sizes[face];
                if (has_groups_) obj_.group_of[kept] = obj_.group_of[face];
                obj_.use_of[kept++] = obj_.use_of[face];
            }
            begin = end;
        }
        obj_.corners.resize(kept_corners);
        if (totals_[OBJ_UV] > 0) obj_.corner_uvs.resize(kept_corners);
        obj_.sizes.resize(kept);
        obj_.use_of.resize(kept);
        if (has_groups_) obj_.group_of.resize(kept);
        for (size_t i = kept; i < faces; ++i) {
            const std::string what = "a face with a vertex that is not finite is left out";
            warnings_.add(what, file_ + ": " + what);
        }
    }

    std::string_view text_;
    const std::string& file_;
    std::array<int64_t, 3> totals_{};  // Numbers of each kind, in the whole file.
    std::array<int64_t, 3> counts_{};  // Numbers of each kind, so far.
    uint64_t line_ = 0;
    uint64_t faces_ = 0;        // So far.
    bool has_objects_ = false;  // Whether there is an `o`,
    bool has_groups_ = false;   // and whether there is an `o` or a `g`.
    std::string group_name_;    // Of the faces that follow,
    static constexpr uint32_t NO_GROUP = ~0u;
    uint32_t group_ = NO_GROUP;  // and its index, if it is known.
    std::unordered_map<std::string, uint32_t> group_indices_;
    bool has_uvs_ = false;    // Whether a corner has texture coordinates.
    bool all_finite_ = true;  // All positions so far.
    CountedWarnings warnings_;
    ObjColors colors_;
    ObjFile obj_;
};

}  // namespace

ObjFile parse_obj(std::string_view text, const std::string& file) {
    return ObjReader(text, file).read();
}

}  // namespace candela
