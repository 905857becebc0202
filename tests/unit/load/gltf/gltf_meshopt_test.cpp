// EXT_meshopt_compression: views that are compressed give the bytes that were. The library's own encoder
// makes the streams.
#include <cmath>

#include <meshoptimizer.h>

#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

constexpr const char* EXT = "EXT_meshopt_compression";

template <class T>
std::string vertex_stream(const std::vector<T>& numbers, size_t stride) {
    const size_t count = numbers.size() * sizeof(T) / stride;
    std::string stream(meshopt_encodeVertexBufferBound(count, stride), '\0');
    stream.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(stream.data()), stream.size(),
                                             numbers.data(), count, stride));
    return stream;
}

std::string index_stream(const std::vector<uint32_t>& indices, bool of_triangles) {
    std::string stream(1000, '\0');
    auto* bytes = reinterpret_cast<unsigned char*>(stream.data());
    stream.resize(of_triangles
                      ? meshopt_encodeIndexBuffer(bytes, stream.size(), indices.data(), indices.size())
                      : meshopt_encodeIndexSequence(bytes, stream.size(), indices.data(), indices.size()));
    return stream;
}

class GltfMeshopt : public Gltf {
  protected:
    // Compresses view `view` of the file's only buffer: `stream` replaces its bytes.
    static void compress(GltfFile& file, size_t view, const std::string& stream, const Json& keys,
                         const char* name = EXT) {
        Json extension = {{"buffer", 0}, {"byteOffset", file.bytes.size()}, {"byteLength", stream.size()}};
        extension.update(keys);
        Json& element = file.root["bufferViews"][view];
        element["buffer"] = 1;
        element["extensions"][name] = extension;
        file.bytes += stream;
    }

    // A triangle whose three views are compressed: positions, colours, and indices in this mode.
    static GltfFile compressed(const char* mode = "TRIANGLES", bool wide = false) {
        GltfFile file;
        const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
        const std::vector<uint8_t> colors{255, 0, 0, 255, 0, 255, 0, 255, 51, 0, 255, 255};
        const std::vector<uint32_t> indices{0, 1, 2};
        Json primitive = {{"attributes",
                           {{"POSITION", file.add<float>("VEC3", positions)},
                            {"COLOR_0", file.add_normalized("VEC4", colors)}}}};
        primitive["indices"] =
            wide ? file.add<uint32_t>("SCALAR", indices) : file.add<uint16_t>("SCALAR", {0, 1, 2});
        file.show(primitive);
        const size_t fallback = file.bytes.size();
        file.bytes.clear();
        compress(file, 0, vertex_stream(positions, 12),
                 {{"byteStride", 12}, {"count", 3}, {"mode", "ATTRIBUTES"}});
        compress(file, 1, vertex_stream(colors, 4),
                 {{"byteStride", 4}, {"count", 3}, {"mode", "ATTRIBUTES"}, {"filter", "NONE"}});
        compress(file, 2, index_stream(indices, std::string_view(mode) == "TRIANGLES"),
                 {{"byteStride", wide ? 4 : 2}, {"count", 3}, {"mode", mode}});
        file.root["extensionsUsed"] = file.root["extensionsRequired"] = Json::array({EXT});
        set_buffers(file, {{"byteLength", fallback}, {"extensions", {{EXT, {{"fallback", true}}}}}});
        return file;
    }

    // States the file's buffer, of the bytes that it has by now, and a second one.
    static void set_buffers(GltfFile& file, const Json& second) {
        const std::string uri = "data:application/octet-stream;base64," + base64(file.bytes);
        file.root["buffers"] = Json::array({{{"byteLength", file.bytes.size()}, {"uri", uri}}, second});
    }

    static Json& extension(GltfFile& file, size_t view) {
        return file.root["bufferViews"][view]["extensions"][EXT];
    }

    // The normals that the file gives a triangle if its view of normals holds these filtered numbers.
    template <class T>
    std::vector<vec3> unfiltered_normals(const std::vector<T>& filtered, const char* filter) {
        GltfFile file;
        const size_t positions = file.add_corner();
        const size_t normals = file.add_normalized("VEC3", std::vector<T>(9));
        file.root["bufferViews"][1] = {
            {"buffer", 1}, {"byteLength", filtered.size() * sizeof(T)}, {"byteStride", 4 * sizeof(T)}};
        file.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
        compress(file, 1, vertex_stream(filtered, 4 * sizeof(T)),
                 {{"byteStride", 4 * sizeof(T)}, {"count", 3}, {"mode", "ATTRIBUTES"}, {"filter", filter}});
        set_buffers(file, {{"byteLength", 100}});
        const Scene scene = load(file);
        EXPECT_EQ(scene.meshes.size(), 1u);
        return scene.meshes.at(0).normals;
    }
};

TEST_F(GltfMeshopt, EachModeGivesTheBytesThatWereCompressed) {
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
        for (const bool wide : {false, true}) {
            const Scene scene = load(compressed(mode, wide));
            ASSERT_EQ(scene.meshes.size(), 1u) << mode;
            EXPECT_TRUE(scene.warnings.empty());
            const TriangleMesh& mesh = scene.meshes[0];
            ASSERT_EQ(mesh.triangles.size(), 1u);
            std::vector<dvec3> corners;
            std::vector<vec4> colors;
            for (const int i : {0, 1, 2}) {
                corners.push_back(mesh.origin + dvec3(mesh.positions[mesh.triangles[0][i]]));
                colors.push_back(mesh.colors[mesh.triangles[0][i]]);
            }
            EXPECT_EQ(corners, (std::vector<dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
            EXPECT_EQ(colors, (std::vector<vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0.2f, 0, 1, 1}}));
        }
    }
}

// Ref: EXT_meshopt_compression, "Filters": x and y of an octahedron unfolded into a square, and what 1 is.
template <class T>
static vec3 octahedral(T x, T y, T one) {
    double a = double(x) / one, b = double(y) / one;
    const double z = 1.0 - std::abs(a) - std::abs(b), t = std::min(z, 0.0);
    a += a >= 0.0 ? t : -t;
    b += b >= 0.0 ? t : -t;
    return vec3(normalize(dvec3(a, b, z)));
}

template <class T>
static void expect_octahedral(const std::vector<vec3>& normals, const std::vector<T>& filtered) {
    ASSERT_EQ(normals.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        const T* n = &filtered[4 * i];
        // The decoder rounds each number to an integer of this type.
        const float rounding = 1.0f / float(std::numeric_limits<T>::max());
        EXPECT_LT(length(normals[i] - octahedral(n[0], n[1], n[2])), rounding) << i;
    }
}

TEST_F(GltfMeshopt, TheOctahedralFilterGivesUnitVectors) {
    const std::vector<int8_t> bytes{100, 20, 127, 0, -90, -80, 127, 0, 0, 0, 127, 0};
    expect_octahedral(unfiltered_normals(bytes, "OCTAHEDRAL"), bytes);
    const std::vector<int16_t> words{1000, 200, 2047, 0, -1900, -1800, 2047, 0, 0, 1, 2047, 0};
    expect_octahedral(unfiltered_normals(words, "OCTAHEDRAL"), words);
}

TEST_F(GltfMeshopt, TheExponentialFilterGivesFloats) {
    // A mantissa of 24 bits, and an exponent of 8 above it.
    const auto number = [](int mantissa, int exponent) {
        return uint32_t(mantissa & 0xFFFFFF) | uint32_t(exponent & 0xFF) << 24;
    };
    GltfFile file = corner_file();
    const std::vector<uint32_t> filtered{
        0, 0, number(3, -1), number(5, 1), 0, number(3, -1), 0, number(-7, 2), number(6, -2)};
    compress(file, 0, vertex_stream(filtered, 12),
             {{"byteStride", 12}, {"count", 3}, {"mode", "ATTRIBUTES"}, {"filter", "EXPONENTIAL"}});
    set_buffers(file, {{"byteLength", 36}});
    const TriangleMesh mesh = load(file).meshes.at(0);
    std::vector<dvec3> positions;
    for (const vec3 p : mesh.positions)
        positions.push_back(mesh.origin + dvec3(p));
    EXPECT_EQ(positions, (std::vector<dvec3>{{0, 0, 1.5}, {10, 0, 1.5}, {0, -28, 1.5}}));
}

TEST_F(GltfMeshopt, TheQuaternionFilterGivesRotations) {
    // Three numbers of 16 bits, over the root of 2; the last says what 1 is and, in its two lowest bits,
    // which number of the quaternion is missing, the greatest: here w, after x, y and z.
    constexpr int16_t ONE = 32767;
    const auto scaled = int16_t(std::lround(std::sin(0.3) * std::sqrt(2.0) * ONE));
    GltfFile file = corner_file();
    const size_t times = file.add<float>("SCALAR", {0, 1});
    const size_t turns = file.add_normalized("VEC4", std::vector<int16_t>(8));
    const std::vector<int16_t> filtered{0, 0, scaled, ONE | 3, 0, 0, scaled, ONE | 3};
    const size_t view = file.root["accessors"][turns]["bufferView"];
    compress(file, view, vertex_stream(filtered, 8),
             {{"byteStride", 8}, {"count", 2}, {"mode", "ATTRIBUTES"}, {"filter", "QUATERNION"}});
    set_buffers(file, {{"byteLength", 16}});
    file.root["bufferViews"][view]["byteOffset"] = 0;
    file.push("animations",
              {{"samplers", {{{"input", times}, {"output", turns}}}},
               {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}});
    const Scene scene = load(file, {.time = 0.5});
    const auto& instance = std::get<MeshInstance>(scene.shapes.at(0).geometry);
    const dvec3 turned = instance.transform.vector(dvec3(1, 0, 0));
    // A rotation about z by twice the angle; integers of 15 bits.
    EXPECT_NEAR(turned.x, std::cos(0.6), 1e-4);
    EXPECT_NEAR(turned.y, std::sin(0.6), 1e-4);
}

TEST_F(GltfMeshopt, TheNewNameOfTheExtensionIsReadInVersion0) {
    GltfFile file = compressed();
    for (Json& view : file.root["bufferViews"])
        view["extensions"] = {{"KHR_meshopt_compression", view["extensions"][EXT]}};
    file.root["extensionsRequired"] = Json::array({"KHR_meshopt_compression"});
    EXPECT_EQ(load(file).shapes.size(), 1u);
}

TEST_F(GltfMeshopt, StreamsOfAnotherVersionAreRefusedByName) {
    GltfFile file = compressed();
    file.bytes[0] = char(0xAF);
    set_buffers(file, {{"byteLength", 100}});
    expect_error(
        file,
        "#/bufferViews/0/extensions/EXT_meshopt_compression: the data are compressed by meshopt's "
        "format 15 (KHR_meshopt_compression), which the library that candela was built with does not "
        "read; export the file with EXT_meshopt_compression, or uncompressed");
    file = compressed();
    extension(file, 1)["filter"] = "COLOR";
    expect_error(file,
                 "#/bufferViews/1/extensions/EXT_meshopt_compression/filter: the filter COLOR of "
                 "KHR_meshopt_compression is not read; export the file with EXT_meshopt_compression");
}

TEST_F(GltfMeshopt, DamagedStreamsAreRefused) {
    const std::string at = "#/bufferViews/0/extensions/EXT_meshopt_compression";
    GltfFile file = compressed();
    file.bytes[0] = 'x';
    set_buffers(file, {{"byteLength", 100}});
    expect_error(file,
                 at + ": the compressed data do not begin as those of the mode ATTRIBUTES do; is the file "
                      "damaged?");
    file = compressed();
    extension(file, 0)["byteLength"] = 20;
    expect_error(file, at + ": the compressed data are damaged; copy or export the file again");
    extension(file, 0)["byteLength"] = 1;
    extension(file, 0)["count"] = 86;
    file.root["bufferViews"][0]["byteLength"] = 1032;
    expect_error(file, at + ": 1 compressed bytes cannot hold 1032; is the file damaged?");
    file.root["bufferViews"][0]["byteLength"] = 1031;
    expect_error(file,
                 at + ": the extension describes 1032 bytes, but the view has 1031; export the file again");
}

TEST_F(GltfMeshopt, IndicesAreCheckedAfterwards) {
    GltfFile file = compressed("INDICES", true);
    const std::string stream = index_stream({0, 1, 1u << 20}, false);
    compress(file, 2, stream, {{"byteStride", 4}, {"count", 3}, {"mode", "INDICES"}});
    set_buffers(file, {{"byteLength", 100}});
    expect_error(
        file,
        "#/accessors/2: index 2 is 1048576, but the primitive's vertices are 0 to 2; is the file damaged?");
}

TEST_F(GltfMeshopt, WhatTheExtensionStatesIsChecked) {
    const auto expect = [&](size_t view, const char* key, const Json& value, const std::string& message) {
        GltfFile file = compressed();
        extension(file, view)[key] = value;
        expect_error(file, concat("#/bufferViews/", view, "/extensions/EXT_meshopt_compression/", message));
    };
    expect(0, "mode", "VERTICES", "mode: unknown mode \"VERTICES\" (known: ATTRIBUTES, TRIANGLES, INDICES)");
    expect(0, "byteStride", 10, "byteStride: \"byteStride\": expected a multiple of 4 up to 256, found 10");
    expect(0, "byteStride", 260, "byteStride: \"byteStride\": expected a multiple of 4 up to 256, found 260");
    expect(2, "byteStride", 3, "byteStride: \"byteStride\": expected 2 or 4, the size of an index, found 3");
    expect(0, "filter", "OCTAHEDRAL",
           "byteStride: \"byteStride\": expected 4 or 8 for the filter OCTAHEDRAL, found 12");
    expect(0, "filter", "QUATERNION",
           "byteStride: \"byteStride\": expected 8 for the filter QUATERNION, found 12");
    expect(2, "filter", "EXPONENTIAL", "filter: only the mode ATTRIBUTES has filters; export the file again");
    expect(2, "count", 4, "count: \"count\": expected a multiple of 3 for the mode TRIANGLES, found 4");
}

TEST_F(GltfMeshopt, ViewsThatAreNotCompressedNeedABufferWithBytes) {
    for (const std::string name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        GltfFile file = corner_file();
        file.root["buffers"] = {{{"byteLength", 36}, {"extensions", {{name, {{"fallback", true}}}}}}};
        expect_error(
            file,
            "#/buffers/0: the buffer has no bytes, as only views that meshopt compresses may refer to "
            "it, but another does; export the file again");
    }
}

}  // namespace
}  // namespace candela
