// Meshes of glTF files that morph targets and skins bend.
// Ref: Khronos, "glTF 2.0 Specification", sections 3.7.2.2 and 3.7.3.
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "probe/random.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfMorph : public Gltf {
  protected:
    // A triangle with two morph targets, of positions and normals.
    static GltfFile morphing() {
        GltfFile file;
        const Json attributes = {{"POSITION", file.add_corner()},
                                 {"NORMAL", file.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})}};
        const size_t up = file.add<float>("VEC3", {0, 0, 1, 0, 0, 2, 0, 0, 4});
        const size_t aside = file.add_normalized("VEC3", std::vector<int8_t>{127, 0, 0, 0, 0, 0, 0, 127, 0});
        const size_t tilt = file.add<float>("VEC3", {3, 0, 3, 0, 0, 0, 0, 0, 0});
        Json targets = Json::array({{{"POSITION", up}}, {{"POSITION", aside}, {"NORMAL", tilt}}});
        file.show({{"attributes", attributes}, {"targets", targets}});
        return file;
    }

    void expect_weights(const Scene& scene, size_t shape, double a, double b) {
        const TriangleMesh mesh = world_mesh(scene, shape);
        const std::vector<vec3> expected{vec3(b, 0, a), vec3(1, 0, 2 * a), vec3(0, 1 + b, 4 * a)};
        ASSERT_EQ(mesh.positions.size(), 3u);
        for (size_t i = 0; i < 3; ++i)
            EXPECT_LE(distance(mesh.positions[i], expected[i]), 1e-6f) << i;
        EXPECT_LE(distance(mesh.normals.at(0), vec3(normalize(dvec3(3 * b, 0, 1 + 3 * b)))), 1e-6f);
        EXPECT_EQ(mesh.normals.at(1), vec3(0, 0, 1));
    }
};

TEST_F(GltfMorph, TargetsAreAddedByTheirWeights) {
    GltfFile file = morphing();
    expect_weights(load(file), 0, 0, 0);
    file.root["meshes"][0]["weights"] = {0.5, 1};
    expect_weights(load(file), 0, 0.5, 1);
    // Those of a node come before those of its mesh, those of an animation before both.
    file.root["nodes"][0]["weights"] = {-0.25, 0.75};
    file.push("nodes", {{"mesh", 0}});
    file.push("nodes", {{"mesh", 0}});
    const Scene scene = load(file);
    expect_weights(scene, 0, -0.25, 0.75);
    expect_weights(scene, 1, 0.5, 1);
    // Equal weights are one mesh.
    EXPECT_EQ(scene.meshes.size(), 2u);
    const Json sampler = {{"input", file.add<float>("SCALAR", {0, 1})},
                          {"output", file.add<float>("SCALAR", {0, 0, 1, 0.5f})}};
    file.push("animations",
              {{"samplers", Json::array({sampler})},
               {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
    expect_weights(load(file, {.time = 0.5}), 0, 0.5, 0.25);
    expect_weights(load(file, {.time = 0.5}), 1, 0.5, 1);
}

TEST_F(GltfMorph, TangentsMorphWithoutTheirSign) {
    GltfFile file;
    file.root["images"] = {{{"uri", "a.png"}}};
    file.root["textures"] = {{{"source", 0}}};
    file.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
    const Json attributes = {{"POSITION", file.add_corner()},
                             {"NORMAL", file.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})},
                             {"TANGENT", file.add<float>("VEC4", {1, 0, 0, -1, 1, 0, 0, 1, 1, 0, 0, -1})},
                             {"TEXCOORD_0", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})}};
    const Json target = {{"TANGENT", file.add<float>("VEC3", {-1, 2, 0, 0, 0, 0, 0, 0, 0})},
                         {"TEXCOORD_0", file.add<float>("VEC2", {0.5f, 0, 0, 0, 0, 0.5f})}};
    file.show({{"attributes", attributes}, {"material", 0}, {"targets", Json::array({target})}},
              {{"weights", {1}}});
    const TriangleMesh mesh = world_mesh(load(file));
    EXPECT_EQ(mesh.tangents, (std::vector<vec4>{vec4(0, 1, 0, -1), vec4(1, 0, 0, 1), vec4(1, 0, 0, -1)}));
    EXPECT_EQ(mesh.uv0, (std::vector<vec2>{vec2(0.5f, 1), vec2(1, 1), vec2(0, -0.5f)}));
}

TEST_F(GltfMorph, NotesWeightsThatAreTooFewAndRefusesTargetsThatDoNotFit) {
    GltfFile file = morphing();
    file.root["nodes"][0]["weights"] = {0.5};
    const Scene scene = expect_warning(
        file, "#/meshes/0/primitives/0/targets: there are 1 weights for 2 morph targets; missing ones are 0");
    expect_weights(scene, 0, 0.5, 0);
    file.root["nodes"][0]["weights"] = {0, 0, 7};
    expect_warning(
        file, "#/meshes/0/primitives/0/targets: there are 3 weights for 2 morph targets; missing ones are 0");
    file.root["nodes"][0]["weights"] = {1, 1};
    Json& target = file.root["meshes"][0]["primitives"][0]["targets"][0];
    target["POSITION"] = file.add<float>("VEC3", {0, 0, 1});
    expect_error(file,
                 "#/meshes/0/primitives/0/targets/0/POSITION: the attribute has 1 elements for 3 vertices; "
                 "is the file damaged?");
    target["POSITION"] = file.add<float>("VEC3", {0, 0, 1, INFINITE, 0, 0, 0, 0, 0});
    expect_error(file,
                 "#/meshes/0/primitives/0/attributes/POSITION: the coordinates of vertex 1 are not finite; "
                 "export the mesh again");
}

class GltfSkin : public Gltf {
  protected:
    static constexpr uint32_t JOINTS = 5;

    static std::vector<float> columns(const glm::dmat4& m) {
        std::vector<float> numbers;
        for (int i = 0; i < 16; ++i)
            numbers.push_back(float(m[i / 4][i % 4]));
        return numbers;
    }

    // Two joints without a matrix, at (1, 0, 0) and (0, 0, 5).
    static GltfFile two_joints() {
        GltfFile file;
        const Json attributes = {
            {"POSITION", file.add_corner()},
            {"JOINTS_0", file.add<uint8_t>("VEC4", {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0})},
            {"WEIGHTS_0",
             file.add_normalized("VEC4", std::vector<uint8_t>{51, 204, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0})}};
        file.show({{"attributes", attributes}}, {{"skin", 0}, {"translation", {100, 0, 0}}});
        file.push("nodes", {{"translation", {1, 0, 0}}});
        file.push("nodes", {{"translation", {0, 0, 5}}});
        file.push("skins", {{"joints", {1, 2}}});
        return file;
    }
    // The same with normals, and tangents along x with that sign.
    static GltfFile with_tangents(float sign) {
        GltfFile file = two_joints();
        file.root["images"] = {{{"uri", "a.png"}}};
        file.root["textures"] = {{{"source", 0}}};
        file.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
        Json& primitive = file.root["meshes"][0]["primitives"][0];
        primitive["material"] = 0;
        primitive["attributes"]["NORMAL"] = file.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
        primitive["attributes"]["TANGENT"] =
            file.add<float>("VEC4", {1, 0, 0, sign, 1, 0, 0, sign, 1, 0, 0, sign});
        primitive["attributes"]["TEXCOORD_0"] = file.add<float>("VEC2", {0, 0, 1, 0, 0, 1});
        return file;
    }
};

TEST_F(GltfSkin, VerticesFollowTheirJointsAndNotTheirNode) {
    const TriangleMesh mesh = world_mesh(load(two_joints()));
    EXPECT_LE(distance(mesh.positions.at(0), vec3(0.2f, 0, 4)), 1e-6f);
    EXPECT_EQ(mesh.positions.at(1), vec3(1, 0, 5));
    EXPECT_EQ(mesh.positions.at(2), vec3(1, 1, 0));
    // Such a mesh is one of its own for every node.
    GltfFile twice = two_joints();
    twice.push("nodes", {{"mesh", 0}, {"skin", 0}});
    EXPECT_EQ(load(twice).meshes.size(), 2u);
}

// Against the formula in double precision: sum of weight * joint's matrix * inverse bind matrix.
TEST_F(GltfSkin, PositionsAndNormalsAreThoseOfTheBlendedMatrices) {
    Random random(7);
    const auto number = [&] { return 2.0 * double(random.unit()) - 1.0; };
    const auto matrix = [&] {
        const glm::dquat q = normalize(glm::dquat(number(), number(), number(), number()));
        glm::dmat4 m = glm::mat4_cast(q);
        for (int i = 0; i < 3; ++i)
            m[i] *= 1.0 + 0.5 * number();
        m[3] = glm::dvec4(number(), number(), number(), 1.0);
        return m;
    };
    GltfFile file;
    std::vector<float> positions, normals, weights, more_weights, inverse_binds;
    std::vector<uint16_t> joints, more_joints;
    constexpr size_t VERTICES = 60;
    for (size_t i = 0; i < VERTICES; ++i) {
        const dvec3 n = normalize(dvec3(number(), number(), number()));
        for (int k = 0; k < 3; ++k) {
            positions.push_back(float(number()));
            normals.push_back(float(n[k]));
        }
        for (int k = 0; k < 4; ++k) {
            joints.push_back(uint16_t(random.bits() % JOINTS));
            more_joints.push_back(uint16_t(random.bits() % JOINTS));
            weights.push_back(random.unit());
            more_weights.push_back(k == 0 ? random.unit() : 0.0f);
        }
    }
    std::vector<glm::dmat4> nodes(JOINTS), binds(JOINTS), worlds(JOINTS);
    Json indices = Json::array();
    for (size_t j = 0; j < JOINTS; ++j) {
        nodes[j] = matrix();
        // A chain, each the child of the one before.
        worlds[j] = j == 0 ? nodes[j] : worlds[j - 1] * nodes[j];
        binds[j] = matrix();
        const std::vector<float> numbers = columns(binds[j]);
        inverse_binds.insert(inverse_binds.end(), numbers.begin(), numbers.end());
        Json numbers_of_node = Json::array();
        for (int i = 0; i < 16; ++i)
            numbers_of_node.push_back(nodes[j][i / 4][i % 4]);
        indices.push_back(file.push("nodes", {{"matrix", numbers_of_node}}));
        if (j > 0) file.root["nodes"][j - 1]["children"] = {j};
    }
    const Json attributes = {
        {"POSITION", file.add("VEC3", positions)},   {"NORMAL", file.add("VEC3", normals)},
        {"JOINTS_0", file.add("VEC4", joints)},      {"WEIGHTS_0", file.add("VEC4", weights)},
        {"JOINTS_1", file.add("VEC4", more_joints)}, {"WEIGHTS_1", file.add("VEC4", more_weights)}};
    file.show({{"attributes", attributes}}, {{"skin", 0}});
    file.push("skins", {{"joints", indices}, {"inverseBindMatrices", file.add("MAT4", inverse_binds)}});
    const TriangleMesh mesh = world_mesh(load(file));
    ASSERT_EQ(mesh.positions.size(), VERTICES);
    for (size_t i = 0; i < VERTICES; ++i) {
        glm::dmat4 blended(0.0);
        double sum = 0.0;
        for (size_t k = 4 * i; k < 4 * (i + 1); ++k) {
            blended += double(weights[k]) * worlds[joints[k]] * binds[joints[k]];
            blended += double(more_weights[k]) * worlds[more_joints[k]] * binds[more_joints[k]];
            sum += double(weights[k]) + double(more_weights[k]);
        }
        blended /= sum;
        const auto at = [&](const std::vector<float>& v) {
            return dvec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
        };
        // The roundings of the matrices' floats, below 2^-24 of numbers below 4 in sums of a dozen.
        EXPECT_LE(distance(dvec3(mesh.positions[i]), dvec3(blended * glm::dvec4(at(positions), 1.0))), 1e-5)
            << i;
        const glm::dmat3 linear(blended);
        // Where the matrix does not flatten, so that its inverse is exact enough.
        if (std::abs(determinant(linear)) < 0.05) continue;
        EXPECT_LE(distance(dvec3(mesh.normals[i]), normalize(transpose(inverse(linear)) * at(normals))), 1e-4)
            << i;
    }
}

TEST_F(GltfSkin, TangentsFollowToo) {
    GltfFile file = with_tangents(-1);
    file.root["nodes"][2]["matrix"] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1};
    file.root["nodes"][2].erase("translation");
    EXPECT_EQ(world_mesh(load(file)).tangents.at(1), vec4(0, 1, 0, -1));
    EXPECT_EQ(world_mesh(load(file)).tangents.at(2), vec4(1, 0, 0, -1));
}

// A skeleton that is mirrored, and the mesh with it: its front stays the front.
TEST_F(GltfSkin, AMirroredSkeletonTurnsTheTrianglesRound) {
    GltfFile file = with_tangents(1);
    Json& primitive = file.root["meshes"][0]["primitives"][0];
    primitive["attributes"].erase("JOINTS_0");
    primitive["attributes"].erase("WEIGHTS_0");
    file.push("nodes", {{"scale", {-1, 1, 1}}, {"children", {0, 1, 2}}});
    const TriangleMesh mesh = world_mesh(load(file));
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{uvec3(0, 2, 1)}));
    EXPECT_EQ(mesh.positions.at(1), vec3(-2, 0, 0));
    EXPECT_EQ(mesh.normals.at(1), vec3(0, 0, 1));
    EXPECT_EQ(mesh.tangents.at(1), vec4(-1, 0, 0, -1));
}

TEST_F(GltfSkin, VerticesThatFollowNothingFollowTheFirstJoint) {
    GltfFile file = two_joints();
    Json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
    const std::vector<vec3> moved{vec3(1, 0, 0), vec3(2, 0, 0), vec3(1, 1, 0)};
    attributes["WEIGHTS_0"] = file.add("VEC4", std::vector<float>(12, 0.0f));
    EXPECT_EQ(world_mesh(load(file)).positions, moved);
    attributes.erase("WEIGHTS_0");
    const Scene scene = expect_warning(file,
                                       "#/meshes/0/primitives/0/attributes: the mesh has a skin, but the "
                                       "primitive has no joints; all of it follows the first joint");
    EXPECT_EQ(world_mesh(scene).positions, moved);
}

TEST_F(GltfSkin, NotesWeightsAndMatricesThatItMends) {
    GltfFile file = two_joints();
    Json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
    const size_t good = attributes["WEIGHTS_0"];
    attributes["WEIGHTS_0"] = file.add<float>("VEC4", {-1, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const std::string place = "#/meshes/0/primitives/0/attributes/";
    Scene scene = expect_warning(file, place + "WEIGHTS_0: some weights are below 0, and are read as 0");
    EXPECT_EQ(world_mesh(scene).positions.at(0), vec3(0, 0, 5));
    attributes["WEIGHTS_0"] = good;
    attributes["JOINTS_1"] = attributes["JOINTS_0"];
    expect_warning(file, place + "JOINTS_1: JOINTS_1 and WEIGHTS_1 are only used together");
    attributes.erase("JOINTS_1");
    attributes["WEIGHTS_1"] = good;
    expect_warning(file, place + "WEIGHTS_1: JOINTS_1 and WEIGHTS_1 are only used together");
    attributes.erase("WEIGHTS_1");

    std::vector<float> matrices(32, 0.0f);
    for (size_t i = 0; i < 8; ++i)
        matrices[16 * (i / 4) + 5 * (i % 4)] = 1.0f;
    matrices[31] = 1.0000001f;  // A rounding error.
    file.root["skins"][0]["inverseBindMatrices"] = file.add("MAT4", matrices);
    const std::vector<vec3> expected = world_mesh(load(file)).positions;
    EXPECT_TRUE(load(file).warnings.empty());
    matrices[16 + 3] = 0.5f;
    file.root["skins"][0]["inverseBindMatrices"] = file.add("MAT4", matrices);
    scene = expect_warning(
        file,
        "#/skins/0/inverseBindMatrices: matrix 1 is not affine; the last row of each is read as 0, 0, 0, 1");
    EXPECT_EQ(world_mesh(scene).positions, expected);
}

TEST_F(GltfSkin, RefusesSkinsThatAreNoneOrDamaged) {
    GltfFile file = two_joints();
    Json& skin = file.root["skins"][0];
    skin["joints"] = {1};
    expect_error(file,
                 "#/meshes/0/primitives/0/attributes/JOINTS_0: vertex 0 follows a joint beyond the skin's 1");
    skin["joints"] = Json::array();
    expect_error(file, "#/skins/0/joints: a skin needs at least one joint; export it again");
    skin["joints"] = {1, 3};
    expect_error(file,
                 "#/skins/0/joints/1: \"nodes\" has no element 3, only 0 to 2; name one that the file "
                 "has");
    skin.erase("joints");
    expect_error(file, "#/skins/0: the key \"joints\" is missing here; add it");
    skin["joints"] = {1, 2};
    skin["inverseBindMatrices"] = file.add("MAT4", std::vector<float>(16, 1.0f));
    expect_error(file, "#/skins/0/inverseBindMatrices: there are 1 matrices for 2 joints");
    skin["inverseBindMatrices"] = file.add("MAT4", std::vector<int16_t>(32, 1));
    expect_error(file, "#/skins/0/inverseBindMatrices: these matrices must be floats");
    skin["inverseBindMatrices"] = 0;
    expect_error(file, "#/accessors/0/type: \"type\": expected \"MAT4\" for what it is used, found \"VEC3\"");
    std::vector<float> infinite(32, 1.0f);
    infinite[5] = INFINITE;
    skin["inverseBindMatrices"] = file.add("MAT4", infinite);
    expect_error(file,
                 "#/meshes/0/primitives/0/attributes/POSITION: the coordinates of vertex 0 are not finite; "
                 "export the mesh again");
    file.root["nodes"][0]["skin"] = 1;
    expect_error(file, "#/nodes/0/skin: \"skins\" has no element 1, only 0 to 0; name one that the file has");
    file = two_joints();
    Json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = file.add<uint8_t>("VEC4", {0, 1, 0, 0});
    expect_error(file,
                 "#/meshes/0/primitives/0/attributes/JOINTS_0: the attribute has 1 elements for 3 vertices; "
                 "is the file damaged?");
    attributes["JOINTS_0"] = file.add("VEC4", std::vector<float>(12, 0.0f));
    expect_error(file,
                 "#/accessors/4/componentType: unsigned integers are expected here; export the file again");
}

}  // namespace
}  // namespace candela
