// The nodes of glTF files: where they put meshes, and which of them a scene shows.
// Ref: Khronos, "glTF 2.0 Specification", section 3.5.
#include <cmath>

#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfNode : public Gltf {
  protected:
    // Where the corners of add_corner() end up.
    void expect_corners(const Scene& scene, size_t shape, const std::vector<dvec3>& expected) {
        const std::vector<vec3> positions = world_mesh(scene, shape).positions;
        ASSERT_EQ(positions.size(), expected.size());
        for (size_t i = 0; i < expected.size(); ++i) {
            // A few roundings of numbers of that size.
            EXPECT_LE(distance(dvec3(positions[i]), expected[i]), 4e-7 * (1.0 + length(expected[i]))) << i;
        }
    }
    void expect_corners(const Json& node, const std::vector<dvec3>& expected) {
        SCOPED_TRACE(node.dump());
        expect_corners(load(corner_file(node)), 0, expected);
    }

    // The x of the first corner of each shape.
    static std::vector<float> places(const Scene& scene) {
        std::vector<float> result;
        for (size_t i = 0; i < scene.shapes.size(); ++i)
            result.push_back(world_mesh(scene, i).positions.at(0).x);
        return result;
    }

    // Nodes with these children, each with the same triangle, and 10^index further along x than its parent.
    static GltfFile tree(const std::vector<std::vector<int>>& children) {
        GltfFile file;
        file.push("meshes", {{"primitives", {{{"attributes", {{"POSITION", file.add_corner()}}}}}}});
        double step = 1.0;
        for (const std::vector<int>& of : children) {
            const size_t i = file.push("nodes", {{"mesh", 0}, {"translation", {step, 0, 0}}});
            if (!of.empty()) file.root["nodes"][i]["children"] = of;
            step *= 10.0;
        }
        return file;
    }
};

// EXT_mesh_gpu_instancing with these attributes.
Json instanced(const Json& attributes) {
    return {{"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}};
}

TEST_F(GltfNode, ShowsItsMeshManyTimes) {
    GltfFile file;
    Json node =
        instanced({{"TRANSLATION", file.add<float>("VEC3", {1, 0, 0, 0, 2, 0})},
                   {"ROTATION", file.add_normalized("VEC4", std::vector<int8_t>{0, 0, 0, 127, 0, 0, 90, 90})},
                   {"SCALE", file.add<float>("VEC3", {1, 1, 1, 2, 3, 4})},
                   {"_COLOR", 99}});
    node["translation"] = {0, 0, 5};
    file.show_corner(node);
    const Scene scene = load(file);
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_TRUE(scene.warnings.empty());
    expect_corners(scene, 0, {dvec3(1, 0, 5), dvec3(2, 0, 5), dvec3(1, 1, 5)});
    expect_corners(scene, 1, {dvec3(0, 2, 5), dvec3(0, 4, 5), dvec3(-3, 2, 5)});
}

TEST_F(GltfNode, SaysWhatIsWrongWithItsInstances) {
    GltfFile file;
    const size_t two = file.add<float>("VEC3", {1, 0, 0, 0, 2, 0}), one = file.add<float>("VEC3", {1, 1, 1});
    file.show_corner(instanced({{"TRANSLATION", two}, {"SCALE", one}}));
    expect_error(
        file,
        "#/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes: the accessors have 2 and 1 elements; "
        "each must have one for each instance");
    GltfFile none = corner_file(instanced(Json::object()));
    EXPECT_EQ(expect_warning(none,
                             "#/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes: there is none of "
                             "TRANSLATION, ROTATION and SCALE; the mesh is shown once")
                  .shapes.size(),
              1u);
    GltfFile flat;
    flat.show_corner(instanced({{"SCALE", flat.add<float>("VEC3", {1, 1, 1, 0, 0, 0})}}));
    EXPECT_EQ(
        expect_warning(flat, "#/nodes/0: left out a mesh that its transform shrinks to a line or a point")
            .shapes.size(),
        1u);
}

TEST_F(GltfNode, RotationsOfItsInstancesAreDividedByTheirLengths) {
    GltfFile file;
    file.show_corner(
        instanced({{"ROTATION", file.add<float>("VEC4", {0, 0, 0, 1, 0, 0, 3, 3, 0, 0, 0, 0})}}));
    const Scene scene = expect_warning(
        file,
        "#/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION: the rotation of instance 1 is a "
        "quaternion whose length is not 1; all are normalised, and length 0 means no rotation");
    ASSERT_EQ(scene.shapes.size(), 3u);
    expect_corners(scene, 1, {dvec3(0), dvec3(0, 1, 0), dvec3(-1, 0, 0)});
    expect_corners(scene, 2, {dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)});
}

TEST_F(GltfNode, ScalesThenRotatesThenMoves) {
    expect_corners(Json::object(), {dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)});
    expect_corners({{"translation", {1, 2, 3}}}, {dvec3(1, 2, 3), dvec3(2, 2, 3), dvec3(1, 3, 3)});
    expect_corners({{"scale", {2, 3, 4}}}, {dvec3(0), dvec3(2, 0, 0), dvec3(0, 3, 0)});
    // A quarter turn about z takes x to y, and y to -x.
    expect_corners({{"rotation", {0, 0, ROOT, ROOT}}}, {dvec3(0), dvec3(0, 1, 0), dvec3(-1, 0, 0)});
    expect_corners({{"translation", {1, 2, 3}}, {"rotation", {0, 0, ROOT, ROOT}}, {"scale", {2, 3, 4}}},
                   {dvec3(1, 2, 3), dvec3(1, 4, 3), dvec3(-2, 2, 3)});
    // About x: y to z. About y: x to -z.
    expect_corners({{"rotation", {ROOT, 0, 0, ROOT}}}, {dvec3(0), dvec3(1, 0, 0), dvec3(0, 0, 1)});
    expect_corners({{"rotation", {0, ROOT, 0, ROOT}}}, {dvec3(0), dvec3(0, 0, -1), dvec3(0, 1, 0)});
}

TEST_F(GltfNode, MatricesStandColumnByColumn) {
    expect_corners({{"matrix", {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1}}},
                   {dvec3(11, 12, 13), dvec3(12, 14, 16), dvec3(15, 17, 19)});
    expect_warning(corner_file({{"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1}},
                                {"translation", {1, 2, 3}}}),
                   "#/nodes/0: the node has a matrix; its translation, rotation and scale are ignored");
    const Scene scene =
        expect_warning(corner_file({{"matrix", {2, 0, 0, 9, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 0, 2}}}),
                       "#/nodes/0/matrix: the matrix is not affine; its last row is read as 0, 0, 0, 1");
    expect_corners(scene, 0, {dvec3(1, 0, 0), dvec3(3, 0, 0), dvec3(1, 2, 0)});
    // Rounded to floats, which needs no warning.
    EXPECT_TRUE(load(corner_file({{"matrix", {1, 0, 0, 1e-8, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.99999994}}}))
                    .warnings.empty());
}

TEST_F(GltfNode, RotationsThatAreNoUnitQuaternionsAreMadeSome) {
    const Scene scene = expect_warning(
        corner_file({{"rotation", {0, 0, 3, 3}}}),
        "#/nodes/0/rotation: the rotation is a quaternion of length 4.24264, not 1; it is normalised");
    expect_corners(scene, 0, {dvec3(0), dvec3(0, 1, 0), dvec3(-1, 0, 0)});
    // Rounded to three digits, which needs no warning.
    const Scene rounded = load(corner_file({{"rotation", {0, 0, 0.707, 0.707}}}));
    EXPECT_TRUE(rounded.warnings.empty());
    expect_corners(rounded, 0, {dvec3(0), dvec3(0, 1, 0), dvec3(-1, 0, 0)});
    const Scene none =
        expect_warning(corner_file({{"rotation", {0, 0, 0, 0}}}),
                       "#/nodes/0/rotation: the rotation is a quaternion of length 0, and is ignored");
    expect_corners(none, 0, {dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)});
}

TEST_F(GltfNode, ChildrenStandInTheSpaceOfTheirParents) {
    GltfFile file = corner_file();
    file.push("nodes", {{"children", {0}}, {"rotation", {0, 0, ROOT, ROOT}}, {"translation", {5, 0, 0}}});
    file.push("nodes", {{"children", {1}}, {"scale", {1, 10, 1}}});
    file.root["nodes"][0]["translation"] = {1, 0, 0};
    // Moved by x, turned to y, moved by 5 along x, then stretched along y.
    expect_corners(load(file), 0, {dvec3(5, 10, 0), dvec3(5, 20, 0), dvec3(4, 10, 0)});
}

TEST_F(GltfNode, NegativeDeterminantsTurnTheTrianglesRound) {
    const TriangleMesh mesh = world_mesh(load(corner_file({{"scale", {-1, 1, 1}}})));
    const uvec3 t = mesh.triangles.at(0);
    // Counter-clockwise from +z, as before: its front is the same.
    const vec3 n =
        cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    EXPECT_GT(n.z, 0.0f);
    const TriangleMesh turned = world_mesh(load(corner_file({{"scale", {-1, -1, 1}}})));
    EXPECT_EQ(turned.triangles, (std::vector<uvec3>{uvec3(0, 1, 2)}));
}

// As shadows and labels are: the side of a body that is pressed into a plane.
TEST_F(GltfNode, FlattenedMeshesArePlaneFigures) {
    expect_corners({{"scale", {2, 1, 0}}, {"translation", {0, 0, 5}}},
                   {dvec3(0, 0, 5), dvec3(2, 0, 5), dvec3(0, 1, 5)});
    // What stands upright on that plane gets the least height that tells its ends apart.
    const TriangleMesh mesh = world_mesh(load(corner_file({{"scale", {0, 1, 1}}})));
    ASSERT_EQ(mesh.positions.size(), 3u);
    EXPECT_GT(mesh.positions[1].x, 0.0f);
    EXPECT_LE(mesh.positions[1].x, 2e-5f);
    // Sheared along the way: (x, y, z) to (x + z, y, 0). The front of a square across stays in front.
    GltfFile file;
    const size_t positions = file.add<float>("VEC3", {0, 0, 0, 1, 0, 1, 0, 1, 0});
    const size_t normals = file.add<float>("VEC3", {-1, 0, 1, -1, 0, 1, -1, 0, 1});
    file.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}},
              {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1}}});
    const Scene scene = load(file);
    const TriangleMesh sheared = world_mesh(scene);
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(sheared.positions.size(), 3u);
    EXPECT_LE(distance(sheared.positions[1], vec3(2, 0, 0)), 4e-5f);
    for (const vec3 n : sheared.normals)
        EXPECT_LE(distance(normalize(n), vec3(0, 0, 1)), 1e-4f);
}

TEST_F(GltfNode, LeavesOutMeshesThatAreShrunkToNothing) {
    const std::string message = "#/nodes/0: left out a mesh that its transform shrinks to a line or a point";
    EXPECT_TRUE(expect_warning(corner_file({{"scale", {0, 0, 0}}}), message).shapes.empty());
    expect_warning(corner_file({{"matrix", {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}}}), message);
    // Another instance of the mesh is there.
    GltfFile file = corner_file({{"scale", {0, 1, 0}}});
    file.push("nodes", {{"mesh", 0}});
    EXPECT_EQ(expect_warning(file, message).shapes.size(), 1u);
    // So large that numbers end.
    GltfFile large = corner_file({{"scale", {1e38, 1e38, 1e38}}});
    for (int i = 0; i < 4; ++i)
        large.push("nodes", {{"children", {i}}, {"scale", {1e38, 1e38, 1e38}}});
    expect_warning(large, message);
    expect_error(
        corner_file({{"translation", {2e37, 0, 0}}}),
        "#/meshes/0/primitives/0: the shape reaches beyond 1e37 along an axis; check its numbers and its "
        "transform");
    GltfFile second = corner_file();
    second.push("nodes", {{"mesh", 0}, {"translation", {2e37, 0, 0}}});
    expect_error(second,
                 "#/nodes/1: the shape reaches beyond 1e37 along an axis; check its numbers and its "
                 "transform");
}

TEST_F(GltfNode, AMeshOfTwoNodesIsOneMeshWithTwoInstances) {
    const Scene scene = load(tree({{}, {}}));
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(places(scene), (std::vector<float>{1, 10}));
    EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
}

TEST_F(GltfNode, ShowsTheSceneThatIsAskedFor) {
    GltfFile file = tree({{}, {2}, {}, {}});
    file.root["scenes"] = {{{"nodes", {0}}, {"name", "day"}}, {{"nodes", {3, 1}}}, {{"name", "empty"}}};
    const auto shown = [&](const std::optional<std::string>& name) {
        return places(load(file, {.scene = name}));
    };
    EXPECT_EQ(shown({}), (std::vector<float>{1}));
    EXPECT_EQ(shown("day"), (std::vector<float>{1}));
    EXPECT_EQ(shown("1"), (std::vector<float>{1000, 10, 110}));
    EXPECT_EQ(shown("empty"), std::vector<float>{});
    EXPECT_EQ(shown("2"), std::vector<float>{});
    file.root["scene"] = 1;
    EXPECT_EQ(shown({}), (std::vector<float>{1000, 10, 110}));
    EXPECT_EQ(shown("0"), (std::vector<float>{1}));
    file.root["scenes"][2]["name"] = "0";  // A name comes before an index.
    EXPECT_EQ(shown("0"), std::vector<float>{});
    file.root["scenes"][2]["name"] = "empty";
    const std::string known = " among its scenes (known: day, 1, empty)";
    for (const std::string wrong : {"night", "3", "-1", "1.0", ""}) {
        expect_text_error(file.gltf(), "--scene: m.gltf has nothing called \"" + wrong + "\"" + known,
                          "m.gltf", {.scene = wrong});
    }
    file.root["scene"] = 3;
    expect_error(file, "#/scene: \"scenes\" has no element 3, only 0 to 2; name one that the file has");
    file.root.erase("scene");
    file.root.erase("scenes");
    // Without scenes, all nodes.
    EXPECT_EQ(shown({}), (std::vector<float>{1, 10, 110, 1000}));
    expect_text_error(file.gltf(),
                      "--scene: m.gltf has nothing called \"day\" among its scenes (it has none)", "m.gltf",
                      {.scene = "day"});
    for (int i = 0; i < 21; ++i)
        file.push("scenes", Json::object());
    expect_text_error(
        file.gltf(),
        "--scene: m.gltf has nothing called \"x\" among its scenes (known: 0, 1, 2, 3, 4, 5, 6, 7, "
        "8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19 and 1 more)",
        "m.gltf", {.scene = "x"});
}

TEST_F(GltfNode, RefusesNodesThatFormNoTrees) {
    expect_error(tree({{2}, {2}, {}}),
                 "#/nodes/1/children/0: node 2 has a parent already, node 0; copy the "
                 "node, so that each has one");
    expect_error(tree({{}, {1}}), "#/nodes/1: the node is its own descendant; nodes must form trees");
    expect_error(tree({{}, {3}, {1}, {2}}),
                 "#/nodes/1: the node is its own descendant; nodes must form trees");
    // A tree that hangs on a cycle has two parents; so does a cycle that hangs on a tree.
    expect_error(tree({{4}, {}}),
                 "#/nodes/0/children/0: \"nodes\" has no element 4, only 0 to 1; name one "
                 "that the file has");
    GltfFile file = tree({{1}, {}});
    for (const Json& roots : {Json{0, 1}, Json{1, 0}}) {
        file.root["scenes"] = {{{"nodes", roots}}};
        expect_error(
            file,
            "#/nodes/1: the node is a root of the scene and a child of node 0, which moves it: it would "
            "be at two places; leave one of them out");
    }
    GltfFile cyclic = tree({{1}, {0}});
    cyclic.root["scenes"] = {{{"nodes", {0}}}};
    expect_error(cyclic, "#/nodes/0: the node is its own descendant; nodes must form trees");
    file.root["scenes"] = {{{"nodes", {2}}}};
    expect_error(file,
                 "#/scenes/0/nodes/0: \"nodes\" has no element 2, only 0 to 1; name one that the file "
                 "has");
}

// Only what the scene shows must be a tree.
TEST_F(GltfNode, RootsMayHaveParentsOutsideOfTheScene) {
    GltfFile file = tree({{1, 2}, {}, {}, {1}});
    file.root["scenes"] = {{{"nodes", {1}}}, {{"nodes", {3}}}, {{"nodes", {0}}}};
    const auto shown = [&](const char* scene) {
        const Scene loaded = load(file, {.scene = scene});
        EXPECT_TRUE(loaded.warnings.empty());
        return places(loaded);
    };
    EXPECT_EQ(shown("0"), std::vector<float>{10});
    EXPECT_EQ(shown("1"), (std::vector<float>{1000, 1010}));
    EXPECT_EQ(shown("2"), (std::vector<float>{1, 11, 101}));
    file.root["nodes"][2]["children"] = {2};  // Within itself.
    EXPECT_EQ(shown("0"), std::vector<float>{10});
}

TEST_F(GltfNode, NodesThatAreNamedTwiceAtOnePlaceAreShownOnce) {
    GltfFile file = tree({{1, 1}, {}});
    EXPECT_EQ(places(expect_warning(
                  file, "#/nodes/0/children/1: node 1 is listed twice among the children, and shown once")),
              (std::vector<float>{1, 11}));
    file = tree({{1}, {}});
    file.root["scenes"] = {{{"nodes", {0, 0}}}};
    EXPECT_EQ(
        places(expect_warning(file, "#/nodes/0: the node is listed twice in the scene, and shown once")),
        (std::vector<float>{1, 11}));
    // All nodes are listed as roots.
    file.root["nodes"][0].erase("translation");
    for (const Json& roots : {Json{0, 1}, Json{1, 0}}) {
        file.root["scenes"] = {{{"nodes", roots}}};
        std::vector<float> shown = places(expect_warning(
            file, "#/nodes/1: the node is a root of the scene and a child of node 0, and shown once"));
        std::ranges::sort(shown);
        EXPECT_EQ(shown, (std::vector<float>{0, 10}));
    }
}

TEST_F(GltfNode, HiddenNodesHideTheirChildren) {
    GltfFile file = tree({{1}, {}, {}});
    Json& extensions = file.root["nodes"][0]["extensions"];
    extensions["KHR_node_visibility"] = {{"visible", false}};
    EXPECT_EQ(places(load(file)), (std::vector<float>{100}));
    // Cameras see from there nonetheless.
    file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    file.root["nodes"][1]["camera"] = 0;
    EXPECT_EQ(load(file).cameras.size(), 1u);
    extensions["KHR_node_visibility"] = {{"visible", true}};
    EXPECT_EQ(places(load(file)).size(), 3u);
    extensions["KHR_node_visibility"] = Json::object();
    EXPECT_EQ(places(load(file)).size(), 3u);
    extensions["KHR_node_visibility"] = {{"visible", 0}};
    expect_error(file,
                 "#/nodes/0/extensions/KHR_node_visibility/visible: \"visible\": expected true or false, "
                 "found 0");
}

// Neither the stack nor time that grows with the square of their number.
TEST_F(GltfNode, ChainsMayBeDeepAndInstancesMany) {
    constexpr int COUNT = 100000;
    std::string chain, row;
    for (int i = 0; i + 1 < COUNT; ++i)
        chain += concat("{\"children\":[", i + 1, "],\"rotation\":[0,0,0,2],\"translation\":[1,0,0]},");
    for (int i = 0; i < COUNT / 4; ++i)
        row += concat(",{\"mesh\":0,\"translation\":[", i, ",0,0]}");
    GltfFile file = corner_file();
    file.root["nodes"] = "NODES";
    const auto with = [&](const std::string& nodes) {
        std::string text = file.gltf();
        const std::string word = "\"NODES\"";
        return text.replace(text.find(word), word.size(), '[' + nodes + ']');
    };
    const Scene deep = load_text(with(chain + "{\"mesh\":0}"));
    ASSERT_EQ(deep.shapes.size(), 1u);
    EXPECT_EQ(places(deep), (std::vector<float>{COUNT - 1}));
    EXPECT_EQ(deep.warnings.size(), size_t(COUNT - 1));
    const Scene wide = load_text(with("{}" + row));
    EXPECT_EQ(wide.meshes.size(), 1u);
    EXPECT_EQ(wide.shapes.size(), size_t(COUNT / 4));
}

// The objects of pictures of ids.
TEST_F(GltfNode, IsAnObjectWithItsNameOrThatOfItsMesh) {
    GltfFile file;
    file.show_corner({{"name", "leaf"}});
    file.show_corner({{"name", "leaf"}});
    file.show_corner();
    file.show_corner();
    file.root["meshes"][2]["name"] = "twig";
    Json copies = instanced({{"TRANSLATION", file.add<float>("VEC3", {1, 0, 0, 0, 2, 0})}});
    copies["name"] = "grass";
    file.show_corner(copies);
    const Scene scene = load(file);
    EXPECT_EQ(scene.objects, (std::vector<std::string>{"leaf", "leaf (2)", "twig", "node 3", "grass"}));
    ASSERT_EQ(scene.shapes.size(), 6u);
    for (uint32_t i = 0; i < 6; ++i) {
        EXPECT_EQ(scene.shapes[i].object, std::min(i, 4u));
        EXPECT_EQ(scene.shapes[i].copy, i == 5 ? 1u : 0u);
    }
}

}  // namespace
}  // namespace candela
