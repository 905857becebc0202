// Accessors: typed arrays in the bytes of a glTF file.
// Ref: Khronos, "glTF 2.0 Specification", section 3.6.2.
#include <limits>

#include "load/gltf/accessor.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfAccessor : public Gltf {
  protected:
    // Calls use(accessor) with the last accessor of a file.
    void with_accessor(const GltfFile& made, const auto& use) {
        GltfFile made_so = made;
        made_so.root["extras"] = made.root["accessors"].size() - 1;
        const std::filesystem::path path = folder_.path() / "m.gltf";
        folder_.write("m.gltf", made_so.gltf());
        gltf::Contents contents(path, FileReach(path), no_progress);
        gltf::File file(contents, no_progress);
        use(gltf::Accessor(file, file.root().require("extras"), {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"}));
    }

    std::vector<float> floats(const GltfFile& made) {
        std::vector<float> result;
        with_accessor(made, [&](const gltf::Accessor& accessor) { result = accessor.floats(); });
        return result;
    }

    std::vector<uint32_t> integers(const GltfFile& made) {
        std::vector<uint32_t> result;
        with_accessor(made, [&](const gltf::Accessor& accessor) { result = accessor.integers(); });
        return result;
    }

    void expect_refused(const GltfFile& made, const std::string& message) {
        SCOPED_TRACE(made.root.dump());
        EXPECT_EQ(folder_.without_folder(error_of([&] { floats(made); })), "m.gltf" + message);
    }

    // The smallest and greatest values of a type, and some between: as they are, and normalised by the
    // specification's equations: c / max, and for signed types max(c / max, -1).
    template <class T>
    void expect_type() {
        constexpr T MAX = std::numeric_limits<T>::max(), MIN = std::numeric_limits<T>::lowest();
        const std::vector<T> values{T(0), T(1), MAX, MIN, T(MAX / 3), T(MIN + T(1))};
        GltfFile plain, normalized;
        plain.add("SCALAR", values);
        normalized.add_normalized("SCALAR", values);
        std::vector<float> as_is, scaled;
        for (const T c : values) {
            as_is.push_back(float(c));
            scaled.push_back(float(std::max(double(c) / double(MAX), -1.0)));
        }
        EXPECT_EQ(floats(plain), as_is);
        EXPECT_EQ(floats(normalized), scaled);
    }
};

TEST_F(GltfAccessor, ReadsEachTypeOfComponent) {
    expect_type<int8_t>();
    expect_type<uint8_t>();
    expect_type<int16_t>();
    expect_type<uint16_t>();
    GltfFile file;
    file.add<uint32_t>("SCALAR", {0, 5, 1u << 24, UINT32_MAX});
    EXPECT_EQ(floats(file), (std::vector<float>{0.0f, 5.0f, 16777216.0f, 4294967296.0f}));
    EXPECT_EQ(integers(file), (std::vector<uint32_t>{0, 5, 1u << 24, UINT32_MAX}));
    file.add<float>("SCALAR", {-1.5f, 1e-40f, FLOAT_MAX});
    EXPECT_EQ(floats(file), (std::vector<float>{-1.5f, 1e-40f, FLOAT_MAX}));
    file.add<uint8_t>("SCALAR", {3, 255});
    EXPECT_EQ(integers(file), (std::vector<uint32_t>{3, 255}));
    file.add<uint16_t>("SCALAR", {3, 65535});
    EXPECT_EQ(integers(file), (std::vector<uint32_t>{3, 65535}));
}

TEST_F(GltfAccessor, ReadsEachWidth) {
    std::vector<float> numbers(48);
    for (size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = float(i) - 7.25f;
    for (const std::string type : {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"}) {
        GltfFile file;
        file.add(type, numbers);
        EXPECT_EQ(floats(file), numbers) << type;
        with_accessor(file, [&](const gltf::Accessor& accessor) {
            EXPECT_EQ(accessor.width(), width_of(type));
            EXPECT_EQ(accessor.count(), 48 / width_of(type));
        });
    }
}

TEST_F(GltfAccessor, StridesAndOffsetsLeadToInterleavedElements) {
    // Two vertices of 12 bytes, 4 bytes into the view, which is 4 bytes into the buffer.
    GltfFile file;
    file.add_view<uint8_t>({9, 9, 9, 9});
    const size_t view = file.add_view<uint8_t>({9, 9, 9, 9,                                //
                                                1, 2, 3, 9, 10, 0, 20, 0, 255, 128, 9, 9,  //
                                                4, 5, 6, 9, 30, 0, 44, 1, 0,   51,  9, 9});
    file.root["bufferViews"][view]["byteStride"] = 12;
    const auto accessor = [&](size_t offset, int component, const char* type) {
        file.push("accessors", {{"bufferView", view},
                                {"byteOffset", offset},
                                {"componentType", component},
                                {"count", 2},
                                {"type", type}});
    };
    accessor(4, 5121, "VEC3");
    EXPECT_EQ(floats(file), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    accessor(8, 5123, "VEC2");
    EXPECT_EQ(floats(file), (std::vector<float>{10, 20, 30, 300}));
    accessor(12, 5121, "VEC2");
    EXPECT_EQ(integers(file), (std::vector<uint32_t>{255, 128, 0, 51}));
    // Some rows, in any order.
    with_accessor(file, [](const gltf::Accessor& a) {
        const std::vector<uint32_t> rows{1, 0, 1};
        EXPECT_EQ(a.floats(rows), (std::vector<float>{0, 51, 255, 128, 0, 51}));
    });
    // The last element ends with the view, and may be shorter than the stride.
    file.root["bufferViews"][view]["byteLength"] = 26;
    EXPECT_EQ(floats(file), (std::vector<float>{255, 128, 0, 51}));
    file.root["bufferViews"][view]["byteLength"] = 25;
    expect_refused(file,
                   "#/accessors/2: 2 elements end at byte 26 of their view, which has 25; is the file "
                   "damaged?");
}

Json sparse_of(size_t indices, int index_type, size_t values, size_t count) {
    return {{"count", count},
            {"indices", {{"bufferView", indices}, {"componentType", index_type}}},
            {"values", {{"bufferView", values}}}};
}

TEST_F(GltfAccessor, SparseElementsReplaceThoseOfTheBase) {
    const auto expect = [&](auto zero, const std::string& type, bool with_base) {
        SCOPED_TRACE(concat(component_type<decltype(zero)>(), type, with_base));
        using Index = decltype(zero);
        GltfFile file;
        const size_t indices = file.add_view<Index>({Index(1), Index(3)});
        const size_t values = file.add_view<int16_t>({-7, 8, 9, 10});
        const std::vector<int16_t> base{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
        file.add(type, base, {{"sparse", sparse_of(indices, component_type<Index>(), values, 2)}});
        if (!with_base) file.root["accessors"][0].erase("bufferView");
        std::vector<float> expected(with_base ? std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}
                                              : std::vector<float>(10, 0.0f));
        expected[2] = -7, expected[3] = 8, expected[6] = 9, expected[7] = 10;
        EXPECT_EQ(floats(file), expected);
        with_accessor(file, [&](const gltf::Accessor& accessor) {
            const std::vector<uint32_t> rows{3, 0, 1};
            EXPECT_EQ(accessor.floats(rows), (std::vector<float>{9, 10, expected[0], expected[1], -7, 8}));
        });
    };
    for (const bool with_base : {true, false}) {
        expect(uint8_t(), "VEC2", with_base);
        expect(uint16_t(), "VEC2", with_base);
        expect(uint32_t(), "VEC2", with_base);
    }
    GltfFile file;
    const size_t indices = file.add_view<uint8_t>({0, 2}), values = file.add_view<uint16_t>({7, 9});
    file.add<uint16_t>("SCALAR", {1, 2, 3}, {{"sparse", sparse_of(indices, 5121, values, 2)}});
    EXPECT_EQ(integers(file), (std::vector<uint32_t>{7, 2, 9}));
    // Further offsets and strides.
    file.root["accessors"][0]["sparse"]["values"]["byteOffset"] = 2;
    file.root["accessors"][0]["sparse"]["count"] = 1;
    EXPECT_EQ(integers(file), (std::vector<uint32_t>{9, 2, 3}));
    const size_t spread = file.add_view<uint16_t>({70, 0, 90});
    file.root["bufferViews"][spread]["byteStride"] = 4;
    file.root["accessors"][0]["sparse"] = sparse_of(indices, 5121, spread, 2);
    EXPECT_EQ(integers(file), (std::vector<uint32_t>{70, 2, 90}));
    EXPECT_EQ(floats(file), (std::vector<float>{70, 2, 90}));
}

TEST_F(GltfAccessor, RefusesSparseElementsThatAreNotThere) {
    GltfFile file;
    const size_t indices = file.add_view<uint8_t>({0, 3}), values = file.add_view<float>({7, 9});
    file.add<float>("SCALAR", {1, 2, 3}, {{"sparse", sparse_of(indices, 5121, values, 2)}});
    Json& sparse = file.root["accessors"][0]["sparse"];
    expect_refused(file,
                   "#/accessors/0/sparse/indices: number 1 replaces an element beyond the accessor's "
                   "3; is the file damaged?");
    sparse["count"] = 4;
    expect_refused(file,
                   "#/accessors/0/sparse/count: \"count\": expected a whole number from 1 to 3, found 4");
    sparse["count"] = 3;
    expect_refused(file,
                   "#/accessors/0/sparse/indices: 3 elements end at byte 3 of their view, which has 2; is "
                   "the file damaged?");
    file.root["accessors"][0]["count"] = 2;
    file.root["bufferViews"][values]["byteLength"] = 7;
    sparse["count"] = 2;
    sparse["indices"]["bufferView"] = file.add_view<uint8_t>({0, 1});
    expect_refused(file,
                   "#/accessors/0/sparse/values: 2 elements end at byte 8 of their view, which has 7; is "
                   "the file damaged?");
    sparse["indices"] = {{"bufferView", file.add_view<int8_t>({0, -1})}, {"componentType", 5120}};
    expect_refused(file,
                   "#/accessors/0/sparse/indices/componentType: \"componentType\": expected 5121, 5123 or "
                   "5125, found 5120");
    sparse["indices"]["componentType"] = 5121;
    expect_refused(file,
                   "#/accessors/0/sparse/indices: number 1 replaces an element beyond the accessor's "
                   "2; is the file damaged?");
    sparse.erase("values");
    sparse["count"] = 1;
    expect_refused(file, "#/accessors/0/sparse: the key \"values\" is missing here; add it");
}

TEST_F(GltfAccessor, RefusesElementsBeyondTheirView) {
    GltfFile file;
    file.add<float>("VEC3", {1, 2, 3, 4, 5, 6});
    const auto expect = [&](const char* key, const Json& value, const std::string& message) {
        GltfFile changed = file;
        changed.root[std::string(key) == "byteStride" ? "bufferViews" : "accessors"][0][key] = value;
        expect_refused(changed, message);
    };
    const auto ends = [](const std::string& count, const std::string& byte) {
        return "#/accessors/0: " + count + " elements end at byte " + byte +
               " of their view, which has 24; is the file damaged?";
    };
    expect("count", 3, ends("3", "36"));
    expect("byteOffset", 1, ends("2", "25"));
    expect("byteOffset", 4294967295, ends("2", "4294967319"));
    // 12 * 357913942 is 2^32 + 8.
    expect("count", 357913942, ends("357913942", "4294967304"));
    expect("count", 4294967295, ends("4294967295", "51539607540"));
    expect("byteStride", 4294967295, ends("2", "4294967307"));
    expect("byteStride", 13, ends("2", "25"));
    expect(
        "byteStride", 11,
        "#/bufferViews/0/byteStride: \"byteStride\": expected at least 12, the size of an element, found 11");
    GltfFile close = corner_file();
    close.root["bufferViews"][0]["byteStride"] = 0;
    const Scene scene = expect_warning(
        close, "#/bufferViews/0/byteStride: a stride of 0 is read as none: elements follow each other");
    EXPECT_EQ(world_mesh(scene).positions.at(2), vec3(0, 1, 0));
    expect("count", 0,
           "#/accessors/0/count: \"count\": expected a whole number from 1 to 4294967295, found 0");
    expect("count", 1.5,
           "#/accessors/0/count: \"count\": expected a whole number from 1 to 4294967295, found 1.5");
    expect("bufferView", 1,
           "#/accessors/0/bufferView: \"bufferViews\" has no element 1, only 0 to 0; name one that the "
           "file has");
    // The greatest product: (2^32 - 2) (2^32 - 1) + 12 + 2^32 - 1 is below 2^64.
    file.root["accessors"][0]["count"] = file.root["bufferViews"][0]["byteStride"] = 4294967295;
    file.root["accessors"][0]["byteOffset"] = 4294967295;
    expect_refused(file, ends("4294967295", "18446744065119617037"));
}

TEST_F(GltfAccessor, RefusesTypesThatAreUnknownOrOfNoUse) {
    GltfFile file;
    file.add<float>("VEC3", {1, 2, 3});
    const auto expect = [&](const char* key, const Json& value, const std::string& message) {
        GltfFile changed = file;
        changed.root["accessors"][0][key] = value;
        expect_refused(changed, message);
    };
    for (const int type : {5119, 5124, 5127, 0}) {
        expect(
            "componentType", type,
            "#/accessors/0/componentType: \"componentType\": expected 5120, 5121, 5122, 5123, 5125 or 5126, "
            "found " +
                std::to_string(type));
    }
    for (const char* type : {"MAT3", "vec3", "VEC5"}) {
        expect("type", type,
               "#/accessors/0/type: \"type\": expected \"SCALAR\" or \"VEC2\" or \"VEC3\" or \"VEC4\" or "
               "\"MAT4\" for what it is used, found \"" +
                   std::string(type) + "\"");
    }
    expect("normalized", 1, "#/accessors/0/normalized: \"normalized\": expected true or false, found 1");
    const auto expect_no_integers = [&](const GltfFile& made) {
        EXPECT_EQ(folder_.without_folder(error_of([&] { integers(made); })),
                  "m.gltf#/accessors/0/componentType: unsigned integers are expected here; export the file "
                  "again");
    };
    expect_no_integers(file);
    GltfFile normalized, negative;
    normalized.add_normalized("SCALAR", std::vector<uint8_t>{1});
    expect_no_integers(normalized);
    negative.add<int8_t>("SCALAR", {1});
    expect_no_integers(negative);
}

TEST_F(GltfAccessor, FloatsCannotBeNormalised) {
    GltfFile file;
    const size_t positions = file.add_normalized("VEC3", std::vector<float>{0, 0, 0, 4, 0, 0, 0, 4, 0});
    file.show({{"attributes", {{"POSITION", positions}}}});
    const Scene scene = expect_warning(
        file, "#/accessors/0: \"normalized\" does not apply to floats or 32-bit integers, and is ignored");
    EXPECT_EQ(world_mesh(scene).positions[1], vec3(4, 0, 0));
}

// Zeros take no bytes in a file, so they must not take unlimited memory: an attribute has as many elements as
// they, and so not more than the file has bytes.
TEST_F(GltfAccessor, AsManyZerosAsTheFileHasBytesAreAllowed) {
    GltfFile file;
    file.push("accessors", {{"componentType", 5121}, {"count", 3}, {"type", "VEC2"}});
    EXPECT_EQ(floats(file), std::vector<float>(6, 0.0f));
    EXPECT_EQ(integers(file), std::vector<uint32_t>(6, 0));
    const auto message = [](size_t bytes) {
        return concat(
            "#/accessors/0/count: an accessor without a bufferView is all zeros, and may not have more "
            "elements than the ",
            bytes, " bytes that were read; name the view of its bytes");
    };
    // As long as the file, to the byte.
    file.root["extras"] = 0;
    file.root["accessors"][0]["count"] = 100;
    const size_t size = file.gltf().size();
    file.root["accessors"][0]["count"] = size;
    EXPECT_EQ(floats(file).size(), 2 * size);
    file.root["accessors"][0]["count"] = size + 1;
    expect_refused(file, message(size));
    file.root["accessors"][0]["count"] = 4294967295;
    expect_refused(file, message(file.gltf().size()));
}

TEST_F(GltfAccessor, BytesThatWereReadAllowZeros) {
    GltfFile file;
    const size_t positions = file.add("VEC3", std::vector<float>(3 * 5000, 1.0f));
    const size_t normals =
        file.push("accessors", {{"componentType", 5126}, {"count", 5000}, {"type", "VEC3"}});
    file.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    folder_.write("b.bin", file.bytes);
    load_text(file.document("b.bin"));
}

}  // namespace
}  // namespace candela
