// Tangents against those of Blender, an independent implementation of MikkTSpace; tests/unit/scene/tangents
// has its meshes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "base/file.h"
#include "scene/mesh.h"
#include "scene/tangents.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

struct Expected {
    TriangleMesh mesh;                   // Without tangents.
    std::vector<glm::i16vec4> tangents;  // Tangents of the corners; x, y, z times 32767.
};

template <class T>
std::vector<T> take(std::string_view& bytes, size_t count) {
    static_assert(std::endian::native == std::endian::little);
    if (bytes.size() < count * sizeof(T)) throw std::runtime_error("the file ends too early");
    std::vector<T> items(count);
    std::memcpy(items.data(), bytes.data(), count * sizeof(T));
    bytes.remove_prefix(count * sizeof(T));
    return items;
}

// The file that make_tangents.py describes.
Expected read_expected(const std::string& name) {
    const std::string file = read_file(std::filesystem::path(CANDELA_TANGENTS) / (name + ".bin"));
    std::string_view bytes = file;
    const std::vector<uint32_t> counts = take<uint32_t>(bytes, 2);
    Expected expected;
    for (const auto& row : take<std::array<float, 8>>(bytes, counts[0])) {
        expected.mesh.positions.emplace_back(row[0], row[1], row[2]);
        expected.mesh.normals.emplace_back(row[3], row[4], row[5]);
        expected.mesh.uv0.emplace_back(row[6], row[7]);
    }
    for (const auto& t : take<std::array<uint16_t, 3>>(bytes, counts[1]))
        expected.mesh.triangles.emplace_back(t[0], t[1], t[2]);
    expected.tangents = take<glm::i16vec4>(bytes, 3 * size_t(counts[1]));
    EXPECT_TRUE(bytes.empty());
    return expected;
}

// Each corner gets a vertex of its own.
TriangleMesh taken_apart(const TriangleMesh& mesh) {
    TriangleMesh result;
    for (const uvec3 t : mesh.triangles) {
        const uint32_t a = append_vertex(result, mesh, t.x);
        const uint32_t b = append_vertex(result, mesh, t.y);
        result.triangles.emplace_back(a, b, append_vertex(result, mesh, t.z));
    }
    return result;
}

class BlenderTangents : public testing::TestWithParam<const char*> {};

// How far the two may differ [rad]. The file's numbers are off by up to 2^-16 each. Blender weights tangents
// by an arc cosine of its own, in floats, that is off by up to 4.52e-5 rad. That turns a sum of tangents by
// the sum of 4.52e-5 sin(angle to the mean), over the length of the sum: 5.3e-4 at most in these meshes,
// where two thin triangles meet on Suzanne.
constexpr double LARGEST_ANGLE = 1.8 * 0x1p-16 + 5.3e-4;

TEST_P(BlenderTangents, AreTheSameAtEveryCorner) {
    const Expected expected = read_expected(GetParam());
    TriangleMesh mesh = expected.mesh;
    add_tangents(mesh);
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    size_t unknown = 0;
    for (size_t c = 0; c < expected.tangents.size(); ++c) {
        const dvec3 n = normalize(dvec3(mesh.normals[vertex_of(mesh, c)]));
        const vec4 tangent = mesh.tangents[vertex_of(mesh, c)];
        ASSERT_EQ(tangent.w, float(expected.tangents[c].w)) << "corner " << c;
        const dvec3 blender = dvec3(expected.tangents[c]) / 32767.0;
        if (blender == dvec3(0.0)) {
            ++unknown;
            continue;
        }
        // Where the tangent is unknown, Blender's is (1, 0, 0), regardless of the normal.
        const dvec3 wanted = blender - dot(blender, n) * n;
        ASSERT_LT(std::atan2(length(cross(wanted, dvec3(tangent))), dot(wanted, dvec3(tangent))),
                  LARGEST_ANGLE)
            << "corner " << c;
    }
    // Two triangles of Suzanne contain their normals at one corner, so that their angle there is 0.
    EXPECT_EQ(unknown, GetParam() == std::string("monkey") ? 2u : 0u);
}

TEST_P(BlenderTangents, DoNotDependOnWhichCornersShareAVertex) {
    TriangleMesh mesh = read_expected(GetParam()).mesh;
    TriangleMesh apart = taken_apart(mesh);
    add_tangents(mesh);
    add_tangents(apart);
    EXPECT_EQ(apart.positions.size(), 3 * mesh.triangles.size());
    for (size_t c = 0; c < apart.positions.size(); ++c)
        ASSERT_EQ(apart.tangents[vertex_of(apart, c)], mesh.tangents[vertex_of(mesh, c)]) << "corner " << c;
}

TEST_P(BlenderTangents, OnlyTheSplitVerticesAreAdded) {
    const TriangleMesh before = read_expected(GetParam()).mesh;
    TriangleMesh mesh = before;
    add_tangents(mesh);
    std::map<uint32_t, std::set<std::array<float, 4>>> tangents;  // Tangents of each original vertex.
    for (size_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
        const uint32_t old = vertex_of(before, c);
        const uint32_t vertex = vertex_of(mesh, c);
        ASSERT_EQ(mesh.positions[vertex], before.positions[old]);
        ASSERT_EQ(mesh.normals[vertex], before.normals[old]);
        ASSERT_EQ(mesh.uv0[vertex], before.uv0[old]);
        const vec4 t = mesh.tangents[vertex];
        tangents[old].insert({t.x, t.y, t.z, t.w});
    }
    size_t expected = 0;
    for (const auto& [vertex, different] : tangents)
        expected += different.size();
    EXPECT_EQ(mesh.positions.size(), expected);
}

INSTANTIATE_TEST_SUITE_P(Meshes, BlenderTangents,
                         testing::Values("book", "cube", "cylinder", "grid", "icosphere", "monkey", "torus",
                                         "uv-sphere"),
                         [](const auto& mesh) {
                             std::string name = mesh.param;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace candela
