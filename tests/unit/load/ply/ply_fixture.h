// What the tests of PLY files share: a square in the three formats, and changes of it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load/ply/ply.h"
#include "unit/load/scene_fixture.h"

namespace candela {

// The bytes of a number, in the order of the file.
template <class T>
std::string bytes_of(T value, bool big_endian) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
    return {raw.begin(), raw.end()};
}

inline const std::string VERTEX = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
inline const std::string FACE = "element face 2\nproperty list uchar int vertex_indices\n";
inline const std::string POINTS = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

inline std::string header(const std::string& format, const std::string& elements) {
    return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

// A square of two triangles; its last line has no end.
inline std::string ascii_square() {
    return header("ascii", VERTEX + FACE) + POINTS + "3 0 1 2\n3 0 2 3";
}

inline std::string binary_square(bool big_endian) {
    std::string text = header(big_endian ? "binary_big_endian" : "binary_little_endian", VERTEX + FACE);
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
        text += bytes_of(x, big_endian);
    for (const auto& triangle : {uvec3(0, 1, 2), uvec3(0, 2, 3)}) {
        text += char(3);
        for (glm::length_t i = 0; i < 3; ++i)
            text += bytes_of(int32_t(triangle[i]), big_endian);
    }
    return text;
}

inline std::string replaced(std::string text, const std::string& old, const std::string& by) {
    const size_t at = text.find(old);
    if (at == std::string::npos) throw std::logic_error("no " + old);
    return text.replace(at, old.size(), by);
}

class Ply : public testing::Test {
  protected:
    TriangleMesh load(const std::string& text, MeshNormals normals = MeshNormals::file) {
        folder_.write("m.ply", text);
        warnings_.clear();
        return placed(
            load_ply(folder_.path() / "m.ply", normals, FileReach(folder_.path() / "m.ply"), warnings_),
            Transform());
    }

    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { load(text); })), message);
    }

    // The only warning, without the folder.
    std::string warning() {
        EXPECT_EQ(warnings_.size(), 1u);
        return warnings_.empty() ? "" : folder_.without_folder(warnings_[0]);
    }

    void expect_square(const TriangleMesh& mesh) {
        EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)}));
        EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{uvec3(0, 1, 2), uvec3(0, 2, 3)}));
        EXPECT_TRUE(mesh.normals.empty());
        EXPECT_TRUE(warnings_.empty());
    }

    SceneFolder folder_;
    std::vector<std::string> warnings_;
};

}  // namespace candela
