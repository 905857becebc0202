// Meshes of glTF files: triangles, and what their vertices have.
// Ref: Khronos, "glTF 2.0 Specification", section 3.7.2.
#include <limits>

#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfMesh : public Gltf {
  protected:
    // Five vertices of a strip that zigzags upwards.
    static const std::vector<float>& zigzag() {
        static const std::vector<float> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
        return points;
    }

    std::vector<uvec3> triangles(const Json& mode, const std::vector<uint16_t>& indices = {}) {
        GltfFile file;
        Json primitive = {{"attributes", {{"POSITION", file.add("VEC3", zigzag())}}}};
        if (!mode.is_null()) primitive["mode"] = mode;
        if (!indices.empty()) primitive["indices"] = file.add("SCALAR", indices);
        file.show(primitive);
        const TriangleMesh mesh = world_mesh(load(file));
        // By the vertices of the file: unused ones are left out.
        std::vector<uint32_t> rows;
        for (const vec3 p : mesh.positions) {
            for (uint32_t i = 0; i < 5; ++i) {
                if (vec3(zigzag()[3 * i], zigzag()[3 * i + 1], 0.0f) == p) rows.push_back(i);
            }
        }
        std::vector<uvec3> result;
        for (const uvec3 t : mesh.triangles)
            result.emplace_back(rows.at(t.x), rows.at(t.y), rows.at(t.z));
        return result;
    }

    // A triangle whose vertices have further attributes, with a material that looks up textures of both sets.
    TriangleMesh mesh_with(const std::function<void(GltfFile&, Json&)>& add, Scene* scene = nullptr) {
        GltfFile file;
        Json attributes = {{"POSITION", file.add_corner()}};
        file.root["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
        file.root["textures"] = {{{"source", 0}}};
        file.root["materials"] = {{{"emissiveFactor", {1, 1, 1}},
                                   {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}},
                                   {"normalTexture", {{"index", 0}}}}};
        add(file, attributes);
        file.show({{"attributes", attributes}, {"material", 0}});
        const Scene loaded = load(file);
        if (scene != nullptr) *scene = loaded;
        return world_mesh(loaded);
    }
};

TEST_F(GltfMesh, ReadsTrianglesStripsAndFans) {
    using List = std::vector<uvec3>;
    EXPECT_EQ(triangles(4, {0, 1, 2, 1, 3, 2}), (List{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(triangles(nullptr, {0, 1, 2, 1, 3, 2}), (List{{0, 1, 2}, {1, 3, 2}}));
    // Section 3.7.2.1: p_i = {v_i, v_(i + 1 + i mod 2), v_(i + 2 - i mod 2)}.
    EXPECT_EQ(triangles(5, {0, 1, 2, 3, 4}), (List{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
    // p_i = {v_(i + 1), v_(i + 2), v_0}.
    EXPECT_EQ(triangles(6, {0, 1, 3, 4}), (List{{1, 3, 0}, {3, 4, 0}}));
    // Without indices, and with corners that are too few for a last triangle.
    EXPECT_EQ(triangles(4), (List{{0, 1, 2}}));
    EXPECT_EQ(triangles(5), (List{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
    EXPECT_EQ(triangles(6), (List{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
}

TEST_F(GltfMesh, PrimitivesThatShareVerticesKeepTheirOwn) {
    GltfFile file;
    const size_t positions = file.add("VEC3", zigzag());
    const size_t first = file.add<uint8_t>("SCALAR", {0, 1, 2}),
                 second = file.add<uint32_t>("SCALAR", {4, 2, 3});
    Json primitives = Json::array();
    for (const size_t indices : {first, second})
        primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    file.push("meshes", {{"primitives", primitives}});
    file.push("nodes", {{"mesh", 0}});
    const Scene scene = load(file);
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(world_mesh(scene, 0).positions, (std::vector<vec3>{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}));
    EXPECT_EQ(world_mesh(scene, 1).positions,
              (std::vector<vec3>{vec3(0, 1, 0), vec3(1, 1, 0), vec3(0, 2, 0)}));
    EXPECT_EQ(world_mesh(scene, 1).triangles, (std::vector<uvec3>{uvec3(2, 0, 1)}));
}

TEST_F(GltfMesh, ReadsNormalsTangentsAndBothSetsOfTextureCoordinates) {
    const TriangleMesh mesh = mesh_with([](GltfFile& file, Json& attributes) {
        attributes["NORMAL"] = file.add<float>("VEC3", {0, 0, 1, 0, 3, 4, 1, 0, 0});
        attributes["TANGENT"] = file.add<float>("VEC4", {1, 0, 0, 1, 0, 2, 0, -1, 0, 0, -1, 1});
        attributes["TEXCOORD_0"] = file.add<float>("VEC2", {0, 0, 0.25f, 1.5f, -2, 1});
        attributes["TEXCOORD_1"] =
            file.add_normalized("VEC2", std::vector<uint16_t>{0, 65535, 13107, 0, 0, 0});
    });
    EXPECT_EQ(mesh.normals, (std::vector<vec3>{vec3(0, 0, 1), vec3(0, 0.6f, 0.8f), vec3(1, 0, 0)}));
    EXPECT_EQ(mesh.tangents, (std::vector<vec4>{vec4(1, 0, 0, 1), vec4(0, 1, 0, -1), vec4(0, 0, -1, 1)}));
    // The file's v grows downwards.
    EXPECT_EQ(mesh.uv0, (std::vector<vec2>{vec2(0, 1), vec2(0.25f, -0.5f), vec2(-2, 0)}));
    EXPECT_EQ(mesh.uv1, (std::vector<vec2>{vec2(0, 0), vec2(0.2f, 1), vec2(0, 1)}));
}

TEST_F(GltfMesh, QuantisedAttributesAreThoseOfTheirIntegers) {
    GltfFile file;
    const Json attributes = {
        {"POSITION", file.add<int16_t>("VEC3", {0, 0, 0, 300, 0, 0, 0, -32768, 7})},
        {"NORMAL", file.add_normalized("VEC3", std::vector<int8_t>{0, 0, 127, 0, 0, -128, 127, 0, 0})}};
    file.show({{"attributes", attributes}});
    const TriangleMesh mesh = world_mesh(load(file));
    EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(0), vec3(300, 0, 0), vec3(0, -32768, 7)}));
    EXPECT_EQ(mesh.normals, (std::vector<vec3>{vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0)}));
}

TEST_F(GltfMesh, WithoutNormalsItIsFlatAndItsTangentsDoNotCount) {
    const TriangleMesh mesh = mesh_with([](GltfFile& file, Json& attributes) {
        attributes["TANGENT"] = file.add<float>("VEC4", {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1});
        attributes["TEXCOORD_0"] = file.add<float>("VEC2", {0, 0, 1, 0, 0, 1});
        attributes["TEXCOORD_1"] = file.add<float>("VEC2", {0, 0, 1, 0, 0, 1});
    });
    EXPECT_TRUE(mesh.normals.empty());
    // Along +u, which is +x.
    for (const vec4 t : mesh.tangents)
        EXPECT_EQ(vec3(t), vec3(1, 0, 0));
    EXPECT_EQ(mesh.tangents.size(), 3u);
}

TEST_F(GltfMesh, CompletesWhatItsMaterialLooksUp) {
    Scene scene;
    const TriangleMesh mesh = mesh_with(
        [](GltfFile& file, Json& attributes) {
            attributes["NORMAL"] = file.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
            attributes["TANGENT"] = file.add<float>("VEC4", {0, 1, 0, 1, 0, 0, 0, 1, 0, 1, 0, 1});
            attributes["TEXCOORD_0"] = file.add<float>("VEC2", {0, 0, 1, 0, 0, 1});
        },
        &scene);
    EXPECT_EQ(vec3(mesh.tangents.at(0)), vec3(1, 0, 0));
    // The image's upper left corner.
    EXPECT_EQ(mesh.uv1, std::vector<vec2>(3, vec2(0, 1)));
    ASSERT_EQ(scene.warnings.size(), 2u);
    EXPECT_EQ(folder_.without_folder(scene.warnings[0]),
              "m.gltf#/meshes/0/primitives/0/attributes/TANGENT: some tangents have no direction; all are "
              "computed from the texture coordinates");
    EXPECT_EQ(
        folder_.without_folder(scene.warnings[1]),
        "m.gltf#/meshes/0/primitives/0: the material has textures, but the primitive has no TEXCOORD_1: "
        "they show their upper left corner everywhere");
}

TEST_F(GltfMesh, WhatNoMaterialLooksUpIsLeftOut) {
    GltfFile file;
    const Json attributes = {{"POSITION", file.add_corner()},
                             {"NORMAL", file.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})},
                             {"TANGENT", file.add<float>("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1})},
                             {"TEXCOORD_0", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})}};
    file.show({{"attributes", attributes}});
    const TriangleMesh mesh = world_mesh(load(file));
    EXPECT_TRUE(mesh.tangents.empty());
    EXPECT_TRUE(mesh.uv0.empty());
}

TEST_F(GltfMesh, TextureCoordinatesStayFinite) {
    const TriangleMesh mesh = mesh_with([](GltfFile& file, Json& attributes) {
        const float inf = INFINITE, nan = std::numeric_limits<float>::quiet_NaN();
        attributes["TEXCOORD_0"] = file.add<float>("VEC2", {nan, 0, FLOAT_MAX, -inf, 0, 1});
        attributes["TEXCOORD_1"] = file.add<float>("VEC2", {0, 0, 1, 0, 0, 1});
    });
    EXPECT_EQ(mesh.uv0, (std::vector<vec2>{vec2(0, 1), vec2(1e30f, 1), vec2(0)}));
}

TEST_F(GltfMesh, ReadsColoursOfEachKind) {
    const auto colors = [&](const char* type, const auto& numbers, const char* alpha_mode) {
        GltfFile file;
        const bool is_float = std::is_same_v<std::decay_t<decltype(numbers[0])>, float>;
        const Json attributes = {{"POSITION", file.add_corner()},
                                 {"COLOR_0", file.add(type, numbers, {{"normalized", !is_float}})}};
        file.root["materials"] = {{{"alphaMode", alpha_mode}}};
        file.show({{"attributes", attributes}, {"material", 0}});
        const Scene scene = load(file);
        EXPECT_TRUE(scene.materials.at(scene.shapes.at(0).material).vertex_colors);
        return world_mesh(scene).colors;
    };
    using Colors = std::vector<vec4>;
    const Colors expected{vec4(1, 0, 0.2f, 1), vec4(0, 0.4f, 0, 1), vec4(0.6f, 1, 1, 1)};
    EXPECT_EQ(colors("VEC3", std::vector<uint8_t>{255, 0, 51, 0, 102, 0, 153, 255, 255}, "BLEND"), expected);
    EXPECT_EQ(
        colors("VEC3", std::vector<uint16_t>{65535, 0, 13107, 0, 26214, 0, 39321, 65535, 65535}, "OPAQUE"),
        expected);
    // Values above 1 become 1, and NaN becomes 0.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(colors("VEC3", std::vector<float>{7, -1, 0.2f, nan, 0.4f, 0, 0.6f, 1, INFINITE}, "OPAQUE"),
              expected);
    // Alpha is used unless the material is opaque (sections 3.9.2 and 3.9.4).
    const std::vector<uint8_t> rgba{255, 0, 51, 255, 0, 102, 0, 0, 153, 255, 255, 51};
    const Colors with_alpha{vec4(1, 0, 0.2f, 1), vec4(0, 0.4f, 0, 0), vec4(0.6f, 1, 1, 0.2f)};
    EXPECT_EQ(colors("VEC4", rgba, "BLEND"), with_alpha);
    EXPECT_EQ(colors("VEC4", rgba, "MASK"), with_alpha);
    EXPECT_EQ(colors("VEC4", rgba, "OPAQUE"), expected);
}

TEST_F(GltfMesh, NotesColoursBeyondTheirRange) {
    for (const float beyond : {-0.1f, 1.1f, INFINITE}) {
        GltfFile file;
        file.show({{"attributes",
                    {{"POSITION", file.add_corner()},
                     {"COLOR_0", file.add<float>("VEC3", {1, 0, 1, 0, 1, 0, 0, beyond, 1})}}}});
        expect_warning(file,
                       "#/meshes/0/primitives/0/attributes/COLOR_0: some colours are not between 0 and 1; "
                       "they are clamped");
    }
}

TEST_F(GltfMesh, NotesTheIndexThatWouldRestartAStrip) {
    GltfFile file;
    std::vector<float> positions;
    for (int i = 0; i < 256; ++i)
        positions.insert(positions.end(), {float(i), float(i * i), 0});
    const size_t many = file.add("VEC3", positions);
    file.show({{"attributes", {{"POSITION", many}}}, {"indices", file.add<uint16_t>("SCALAR", {0, 1, 255})}});
    EXPECT_TRUE(load(file).warnings.empty());
    file.root["meshes"][0]["primitives"][0]["indices"] = file.add<uint8_t>("SCALAR", {0, 1, 255});
    const Scene scene = expect_warning(
        file, "#/accessors/2: index 2 is 255, which may restart a strip elsewhere; here it is a vertex");
    EXPECT_EQ(world_mesh(scene).positions.at(2), vec3(255, 65025, 0));
}

TEST_F(GltfMesh, RefusesCoordinatesThatAreNotFinite) {
    GltfFile file;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float wrong : {nan, INFINITE, -INFINITE}) {
        GltfFile made;
        made.show({{"attributes", {{"POSITION", made.add<float>("VEC3", {0, 0, 0, 1, wrong, 0, 0, 1, 0})}}}});
        expect_error(made,
                     "#/meshes/0/primitives/0/attributes/POSITION: the coordinates of vertex 1 are not "
                     "finite; export the mesh again");
    }
    // Only vertices that a triangle uses are checked; useless normals are completed.
    const size_t positions = file.add<float>("VEC3", {nan, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0});
    const size_t normals = file.add<float>("VEC3", {0, 0, 1, nan, 0, 1, 0, 0, 0, 0, 1, 0});
    file.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
               {"indices", file.add<uint16_t>("SCALAR", {1, 2, 3})}});
    const TriangleMesh mesh = world_mesh(load(file));
    const uvec3 t = mesh.triangles.at(0);
    EXPECT_EQ(mesh.normals.at(t.x), vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals.at(t.y), vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals.at(t.z), vec3(0, 1, 0));
}

TEST_F(GltfMesh, RefusesIndicesAndAttributesThatDoNotFit) {
    const auto expect = [&](const std::vector<uint16_t>& indices, const std::string& message) {
        GltfFile file;
        const size_t positions = file.add_corner();
        file.show({{"attributes", {{"POSITION", positions}}}, {"indices", file.add("SCALAR", indices)}});
        expect_error(file, message);
    };
    expect({0, 1, 3},
           "#/accessors/1: index 2 is 3, but the primitive's vertices are 0 to 2; is the file damaged?");
    // The value of a restart, which must not occur.
    expect({0, 65535, 1},
           "#/accessors/1: index 1 is 65535, but the primitive's vertices are 0 to 2; is the file damaged?");
    GltfFile file;
    const size_t positions = file.add_corner();
    const size_t two = file.add<float>("VEC3", {0, 0, 1, 0, 0, 1});
    file.show({});
    Json& primitive = file.root["meshes"][0]["primitives"][0];
    primitive = {{"attributes", {{"POSITION", positions}, {"NORMAL", two}}}};
    expect_error(file,
                 "#/meshes/0/primitives/0/attributes/NORMAL: the attribute has 2 elements for 3 vertices; "
                 "is the file damaged?");
    primitive["attributes"] = {{"POSITION", 7}};
    expect_error(file,
                 "#/meshes/0/primitives/0/attributes/POSITION: \"accessors\" has no element 7, only 0 to 1; "
                 "name one that the file has");
    primitive["attributes"] = {{"POSITION", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})}};
    expect_error(file, "#/accessors/2/type: \"type\": expected \"VEC3\" for what it is used, found \"VEC2\"");
    primitive["attributes"] = {{"POSITION", positions}};
    primitive["indices"] = two;
    expect_error(file,
                 "#/accessors/1/type: \"type\": expected \"SCALAR\" for what it is used, found \"VEC3\"");
    primitive["indices"] = file.add<float>("SCALAR", {0, 1, 2});
    expect_error(file,
                 "#/accessors/3/componentType: unsigned integers are expected here; export the file again");
    primitive.erase("indices");
    primitive["mode"] = 7;
    expect_error(file,
                 "#/meshes/0/primitives/0/mode: \"mode\": expected a whole number from 0 to 6, found 7");
}

TEST_F(GltfMesh, LeavesOutWhatShowsNoSurface) {
    for (const int mode : {0, 1, 2, 3}) {
        GltfFile file;
        file.show({{"attributes", {{"POSITION", file.add_corner()}}}, {"mode", mode}});
        const Scene scene =
            expect_warning(file, "#/meshes/0/primitives/0: left out points or lines, which have no surface");
        EXPECT_TRUE(scene.shapes.empty());
    }
    GltfFile none;
    none.show({{"attributes", {{"NORMAL", none.add_corner()}}}});
    const std::string message = "#/meshes/0/primitives/0: left out a primitive without positions";
    expect_warning(none, message);
    none.root["meshes"][0]["primitives"][0].erase("attributes");
    expect_warning(none, message);
    none.root["meshes"][0] = Json::object();
    expect_warning(none, "#/meshes/0: left out a mesh without primitives");
    const auto expect_flat = [&](const std::vector<float>& positions) {
        GltfFile file;
        file.show({{"attributes", {{"POSITION", file.add("VEC3", positions)}}}});
        expect_warning(file, "#/meshes/0/primitives/0: left out a primitive without area");
    };
    expect_flat({0, 0, 0, 1, 1, 1, 2, 2, 2});
    expect_flat({0, 0, 0, 1, 1, 1});  // No triangle at all.
    const auto expect_empty = [&](const char* type, int component, bool of_indices) {
        GltfFile file;
        const size_t positions = file.add_corner();
        const size_t empty =
            file.push("accessors", {{"type", type}, {"componentType", component}, {"count", 0}});
        Json primitive = {{"attributes", {{"POSITION", of_indices ? positions : empty}}}};
        if (of_indices) primitive["indices"] = empty;
        file.show(primitive);
        expect_warning(file, "#/meshes/0/primitives/0: left out a primitive without triangles");
    };
    expect_empty("VEC3", 5126, false);
    expect_empty("SCALAR", 5123, true);
}

}  // namespace
}  // namespace candela
