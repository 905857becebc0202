// KHR_draco_mesh_compression: primitives that Draco has compressed, without loss here, are those that were.
// The library's own encoder makes the data.
#include <algorithm>
#include <memory>

#include <draco/compression/encode.h>

#include "base/file.h"
#include "base/memory_limit.h"
#include "load/gltf/draco_header.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

constexpr const char* EXTENSION = "KHR_draco_mesh_compression";

// A mesh in the making, of attributes whose identifiers count from 0.
class DracoSource {
  public:
    explicit DracoSource(uint32_t vertices) { mesh_->set_num_points(vertices); }

    template <class T>
    int add(draco::GeometryAttribute::Type kind, draco::DataType type, int width,
            const std::vector<T>& numbers) {
        draco::GeometryAttribute attribute;
        attribute.Init(kind, nullptr, int8_t(width), type, false, int64_t(sizeof(T)) * width, 0);
        const int id = mesh_->AddAttribute(attribute, true, mesh_->num_points());
        for (uint32_t i = 0; i < mesh_->num_points(); ++i)
            mesh_->attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                                    &numbers[i * size_t(width)]);
        return id;
    }
    void add_face(uint32_t a, uint32_t b, uint32_t c) {
        mesh_->AddFace({draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
    }
    // Without bits of positions, these are exact.
    std::string encoded(int method, int speed = 5, int position_bits = 0) const {
        draco::Encoder encoder;
        encoder.SetEncodingMethod(method);
        encoder.SetSpeedOptions(speed, speed);
        if (position_bits > 0)
            encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, position_bits);
        draco::EncoderBuffer buffer;
        EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh_, &buffer).ok());
        return {buffer.data(), buffer.size()};
    }

  private:
    std::unique_ptr<draco::Mesh> mesh_ = std::make_unique<draco::Mesh>();
};

class GltfDraco : public Gltf {
  protected:
    // Two triangles, with a colour and texture coordinates for each vertex.
    static DracoSource square() {
        DracoSource source(4);
        source.add<float>(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3,
                          {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        source.add<uint8_t>(draco::GeometryAttribute::COLOR, draco::DT_UINT8, 4,
                            {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 51, 51, 51, 255});
        source.add_face(0, 1, 2);
        source.add_face(0, 2, 3);
        return source;
    }

    // A file whose primitive has these data and an accessor without bytes for each attribute.
    static GltfFile file_of(const std::string& data, uint32_t vertices = 4, uint32_t corners = 6) {
        GltfFile file;
        const auto accessor = [&](const char* type, int component, uint32_t count, bool normalized) {
            return file.push(
                "accessors",
                {{"type", type}, {"componentType", component}, {"count", count}, {"normalized", normalized}});
        };
        Json primitive = {{"attributes",
                           {{"POSITION", accessor("VEC3", 5126, vertices, false)},
                            {"COLOR_0", accessor("VEC4", 5121, vertices, true)}}}};
        primitive["indices"] = accessor("SCALAR", 5123, corners, false);
        const size_t view = file.add_view(std::vector<char>(data.begin(), data.end()));
        primitive["extensions"][EXTENSION] = {{"bufferView", view},
                                              {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
        file.show(primitive);
        file.root["extensionsUsed"] = file.root["extensionsRequired"] = Json::array({EXTENSION});
        return file;
    }
    static GltfFile square_file() { return file_of(square().encoded(draco::MESH_SEQUENTIAL_ENCODING)); }

    static Json& primitive_of(GltfFile& file) { return file.root["meshes"][0]["primitives"][0]; }

    // The corners of all triangles, in an order of their own.
    static std::vector<std::vector<double>> corners_of(const Scene& scene) {
        std::vector<std::vector<double>> corners;
        for (const TriangleMesh& mesh : scene.meshes) {
            for (const uvec3 t : mesh.triangles) {
                for (const int i : {0, 1, 2}) {
                    const dvec3 p = mesh.origin + dvec3(mesh.positions[t[i]]);
                    corners.push_back({p.x, p.y, p.z});
                    for (const int k : {0, 1, 2, 3})
                        corners.back().push_back(mesh.colors.empty() ? 0.0 : double(mesh.colors[t[i]][k]));
                }
            }
        }
        std::ranges::sort(corners);
        return corners;
    }

    // The same of a file that holds the square plainly.
    std::vector<std::vector<double>> plain_square() {
        GltfFile file;
        Json primitive = {
            {"attributes",
             {{"POSITION", file.add<float>("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})},
              {"COLOR_0", file.add_normalized("VEC4", std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0,
                                                                           0, 255, 255, 51, 51, 51, 255})}}}};
        primitive["indices"] = file.add<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
        file.show(primitive);
        return corners_of(load(file));
    }

    void expect_damaged(const GltfFile& file, const std::string& message) {
        expect_error(file, "#/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: " + message +
                               "; copy or export the file again");
    }
};

TEST_F(GltfDraco, BothMethodsGiveTheTrianglesThatWereCompressed) {
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        for (const int speed : {0, 5, 10}) {
            const Scene scene = load(file_of(square().encoded(method, speed)));
            EXPECT_TRUE(scene.warnings.empty());
            EXPECT_EQ(corners_of(scene), plain_square()) << method << ", " << speed;
        }
    }
}

TEST_F(GltfDraco, PlainDataBesideItAreUsedForTheyAreExact) {
    GltfFile file = corner_file();
    Json& primitive = primitive_of(file);
    primitive["extensions"][EXTENSION] = {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
    EXPECT_EQ(load(file).shapes.size(), 1u);
    file.root["extensionsUsed"] = Json::array({EXTENSION});
    EXPECT_TRUE(load(file).warnings.empty());
}

TEST_F(GltfDraco, SparseAndPlainAccessorsStandBesideIt) {
    // The first vertex moves, and a morph target moves the second.
    GltfFile file = square_file();
    const size_t indices = file.add_view(std::vector<uint8_t>{0}),
                 values = file.add_view(std::vector<float>{0, 0, 3});
    file.root["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                           {"values", {{"bufferView", values}}}};
    const size_t moves = file.add<float>("VEC3", {0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0});
    primitive_of(file)["targets"] = Json::array({{{"POSITION", moves}}});
    file.root["meshes"][0]["weights"] = {0.5};
    const auto corners = corners_of(load(file));
    EXPECT_EQ(corners.front(), (std::vector<double>{0, 0, 3, 1, 0, 0, 1}));
    const auto second =
        std::ranges::find_if(corners, [](const auto& c) { return c[0] == 1.0 && c[1] == 0.0; });
    ASSERT_NE(second, corners.end());
    EXPECT_EQ((*second)[2], 2.5);
}

TEST_F(GltfDraco, MoreZerosThanCompressedBytesMayStandBesideIt) {
    // A morph target without a view may have as many elements as the vertices that were decoded: here a grid
    // at whole numbers, which takes few bytes.
    constexpr uint32_t SIDE = 128, VERTICES = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1);
    DracoSource source(VERTICES);
    std::vector<float> positions;
    for (uint32_t i = 0; i < VERTICES; ++i)
        positions.insert(positions.end(), {float(i % SIDE), float(i / SIDE), 0.0f});
    source.add<float>(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, positions);
    source.add<uint8_t>(draco::GeometryAttribute::COLOR, draco::DT_UINT8, 4,
                        std::vector<uint8_t>(4 * VERTICES));
    for (uint32_t i = 0; i + SIDE < VERTICES; ++i) {
        if (i % SIDE + 1 == SIDE) continue;
        source.add_face(i, i + 1, i + SIDE + 1);
        source.add_face(i, i + SIDE + 1, i + SIDE);
    }
    const std::string data = source.encoded(draco::MESH_EDGEBREAKER_ENCODING, 0, 7);
    GltfFile file = file_of(data, VERTICES, 3 * TRIANGLES);
    const size_t zeros =
        file.push("accessors", {{"type", "VEC3"}, {"componentType", 5126}, {"count", VERTICES}});
    primitive_of(file)["targets"] = Json::array({{{"POSITION", zeros}}});
    file.root["meshes"][0]["weights"] = {1};
    ASSERT_LT(file.gltf().size() + data.size(), VERTICES);
    EXPECT_EQ(load(file).meshes.at(0).triangles.size(), TRIANGLES);
}

TEST_F(GltfDraco, ASkinAndAnAnimationPoseIt) {
    DracoSource source = square();
    source.add<uint16_t>(draco::GeometryAttribute::GENERIC, draco::DT_UINT16, 4, std::vector<uint16_t>(16));
    std::vector<float> weights(16);
    for (size_t i = 0; i < 16; i += 4)
        weights[i] = 1.0f;
    source.add<float>(draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 4, weights);
    GltfFile file = file_of(source.encoded(draco::MESH_EDGEBREAKER_ENCODING));
    const auto add = [&](const char* name, int component, int id) {
        primitive_of(file)["attributes"][name] =
            file.push("accessors", {{"type", "VEC4"}, {"componentType", component}, {"count", 4}});
        primitive_of(file)["extensions"][EXTENSION]["attributes"][name] = id;
    };
    add("JOINTS_0", 5123, 2);
    add("WEIGHTS_0", 5126, 3);
    const size_t joint = file.push("nodes", {{"translation", {0, 0, 7}}});
    file.root["skins"] = {{{"joints", {joint}}}};
    file.root["nodes"][0]["skin"] = 0;
    for (const auto& corner : corners_of(load(file)))
        EXPECT_EQ(corner[2], 7.0);
}

TEST_F(GltfDraco, NumbersOfAnotherTypeAreConvertedIfTheyFit) {
    GltfFile file = square_file();
    file.root["accessors"][1]["componentType"] = 5123;  // 255 of 65535; alpha does not count.
    EXPECT_EQ(load(file).meshes.at(0).colors.at(0), vec4(255.0f / 65535.0f, 0, 0, 1));
    file.root["accessors"][1]["componentType"] = 5120;
    expect_damaged(file, "the attribute \"COLOR_0\" has numbers that do not fit into its accessor's type");
}

TEST_F(GltfDraco, FewerElementsThanStatedAreSaid) {
    GltfFile file = square_file();
    file.root["accessors"][0]["count"] = 5;
    file.root["accessors"][2]["count"] = 12;
    const Scene scene = expect_warning(
        file,
        "#/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: the data hold 4 vertices "
        "and 2 triangles, fewer than the primitive's accessors, which state 5 and 4");
    EXPECT_EQ(corners_of(scene), plain_square());
}

TEST_F(GltfDraco, MoreElementsThanStatedAreRefusedBeforeTheyAreDecoded) {
    GltfFile file = square_file();
    file.root["accessors"][2]["count"] = 3;
    expect_damaged(file,
                   "the data hold 4 vertices and 2 triangles, but the primitive's accessors only 4 and 1");
    // An absurd number of triangles, as the header states it: five groups of seven bits.
    std::string data = square().encoded(draco::MESH_EDGEBREAKER_ENCODING);
    data.replace(13, 1, "\xFF\xFF\xFF\xFF\x0F");
    expect_damaged(
        file_of(data),
        "the data hold 4 vertices and 4294967295 triangles, but the primitive's accessors only 4 and 2");
}

TEST_F(GltfDraco, AbsurdNumbersThatAccessorsRepeatAreRefused) {
    // 20 million vertices and 40 million triangles, all of whose symbols would follow.
    const std::string vertices = "\x80\xDA\xC4\x09", triangles = "\x80\xB4\x89\x13";
    const std::string data = std::string("DRACO\x02\x02\x01\x01\0\0\0", 12) + vertices + triangles +
                             std::string("\x01", 1) + triangles;
    expect_damaged(file_of(data, 20'000'000, 120'000'000),
                   "25 compressed bytes cannot hold 40000000 triangles");
    // Enough bytes for them meet the limit on memory.
    const GltfFile file = file_of(data + std::string(80'000, '\0'), 20'000'000, 120'000'000);
    set_memory_limit(memory_in_use() + (uint64_t(64) << 20));
    const LimitedMemory limited;
    const std::string message = error_of([&] { load(file); });
    set_memory_limit(UINT64_MAX);
    EXPECT_NE(
        message.find("KHR_draco_mesh_compression: there is not enough memory for the mesh that Draco has "
                     "compressed, which needs at least"),
        std::string::npos)
        << message;
}

TEST_F(GltfDraco, LoopsThatNoMeshNeedsEndForTheirMemory) {
    // A finding of the fuzzer: two thousand million bits, in a mesh of a few triangles.
    const std::string data = read_file(CANDELA_CORPORA "/draco/orientations_without_end");
    expect_damaged(file_of(data, 3000, 9000), "Draco needs more memory for the data than such a mesh takes");
}

TEST_F(GltfDraco, DamagedDataAreRefused) {
    const std::string good = square().encoded(draco::MESH_EDGEBREAKER_ENCODING);
    const auto with = [&](size_t at, char byte) {
        std::string data = good;
        data[at] = byte;
        return file_of(data);
    };
    expect_damaged(with(0, 'B'), "the data do not begin with \"DRACO\"");
    expect_damaged(with(5, 1), "the data are in version 1.2 of Draco's format, not 2.2");
    expect_damaged(with(7, 0), "the data do not hold a mesh of triangles");
    expect_damaged(file_of(good.substr(0, 12)), "the data end within their header");
    const std::string message = error_of([&] { load(file_of(good.substr(0, good.size() - 20))); });
    EXPECT_NE(message.find("Draco cannot decode the data (\""), std::string::npos) << message;
}

TEST_F(GltfDraco, AttributesThatTheDataLackAreNamed) {
    GltfFile file = square_file();
    primitive_of(file)["extensions"][EXTENSION]["attributes"]["COLOR_0"] = 7;
    expect_damaged(file, "the data have no attribute 7 for \"COLOR_0\"");
    file = square_file();
    file.root["accessors"][1]["type"] = "VEC3";
    expect_damaged(file, "the attribute \"COLOR_0\" has 4 numbers for a vertex, but its accessor 3");
}

TEST_F(GltfDraco, PrimitivesThatCannotBeCompressedAreRefused) {
    GltfFile file = square_file();
    primitive_of(file)["mode"] = 6;
    expect_error(
        file,
        "#/meshes/0/primitives/0/mode: Draco holds triangles or strips, and no fans; export the file "
        "again");
    primitive_of(file)["mode"] = 5;
    EXPECT_EQ(corners_of(load(file)), plain_square());
    primitive_of(file).erase("indices");
    expect_error(
        file,
        "#/meshes/0/primitives/0: a primitive with KHR_draco_mesh_compression needs indices; export the "
        "file again");
}

TEST(DracoHeader, ItsCountsStandBehindMetadata) {
    // An attribute's metadata with one entry; the mesh's with no entry, and one object below that has two.
    const std::string entry =
        "\x01"
        "k"
        "\x02"
        "vv";
    const std::string metadata = std::string("\x01\x00\x01", 3) + entry + std::string(1, '\0') +
                                 std::string(
                                     "\x00\x01\x03"
                                     "sub"
                                     "\x02",
                                     7) +
                                 entry + entry + std::string(1, '\0');
    const std::string data = std::string("DRACO\x02\x02\x01\x01\x00\x80", 11) + metadata +
                             std::string("\x00\x85\x01\x07", 4) + "rest";
    std::string problem;
    const auto header = gltf::read_draco_header(std::as_bytes(std::span(data)), problem);
    ASSERT_TRUE(header) << problem;
    EXPECT_EQ(header->vertices, 133u);
    EXPECT_EQ(header->faces, 7u);
}

}  // namespace
}  // namespace candela
