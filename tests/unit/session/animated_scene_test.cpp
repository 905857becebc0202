// Frames of an animation: each pose is that of a fresh scene, fitted to all of the animation.
#include "session/animated_scene.h"

#include "render/make_identity.h"
#include "scene/geometry.h"
#include "unit/load/gltf/moving_file.h"
#include "views/views.h"

namespace candela {
namespace {

class AnimatedSceneTest : public Gltf {
  protected:
    AnimatedSceneTest() { folder_.write("m.gltf", moving_file().gltf()); }

    AnimatedScene loaded(const LoadOptions& options = {}) const {
        return AnimatedScene(folder_.path() / "m.gltf", options);
    }

    static void expect_equal(const GpuScene& a, const GpuScene& b) {
        for (const SceneArray& array : SCENE_ARRAYS)
            EXPECT_TRUE(a.arrays[array.number] == b.arrays[array.number]) << array.name;
        EXPECT_EQ(make_identity(a, Camera{}, {}).hash, make_identity(b, Camera{}, {}).hash);
    }
};

// Where the triangles of a scene are in the world.
std::vector<dvec3> corners_of(const Scene& scene) {
    std::vector<dvec3> corners;
    for (const Shape& shape : scene.shapes) {
        const auto& instance = std::get<MeshInstance>(shape.geometry);
        const TriangleMesh& mesh = scene.meshes[instance.mesh];
        for (const uvec3 t : mesh.triangles) {
            for (const int i : {0, 1, 2})
                corners.push_back(instance.transform.point(mesh.origin + dvec3(mesh.positions[t[i]])));
        }
    }
    return corners;
}

TEST_F(AnimatedSceneTest, AnyOrderOfPosesGivesTheRecordsOfAFreshScene) {
    AnimatedScene scene = loaded();
    for (const double time : {0.25, 0.75, 0.0, 1.0, 0.5, 0.25}) {
        SCOPED_TRACE(time);
        scene.pose(time);
        AnimatedScene fresh = loaded();
        fresh.pose(time);
        EXPECT_EQ(scene.scene().cameras, fresh.scene().cameras);
        expect_equal(scene.build(), fresh.build());
    }
}

// The loader at one time does not know of frames.
TEST_F(AnimatedSceneTest, APoseIsThatOfTheLoader) {
    AnimatedScene scene = loaded();
    EXPECT_EQ(scene.times(), std::pair(0.0, 1.0));
    for (const double time : {0.0, 0.3, 0.5, 1.0}) {
        SCOPED_TRACE(time);
        scene.pose(time);
        const Scene once = load_scene(folder_.path() / "m.gltf", {.gltf = {.time = time}});
        EXPECT_EQ(corners_of(scene.scene()), corners_of(once));
        EXPECT_EQ(scene.scene().cameras, once.cameras);
    }
}

// Every vertex is where a fresh scene has it, whichever frames were shown before.
TEST_F(AnimatedSceneTest, MotionLeadsToWhereEverythingWas) {
    // Corners without a normal become vertices of their own.
    GltfFile file = moving_file();
    for (const size_t mesh : {2, 3}) {
        file.root["meshes"][mesh]["primitives"][0]["attributes"]["NORMAL"] =
            file.add<float>("VEC3", {0, 0, 1, 0, 0, 0, 0, 0, 1});
    }
    folder_.write("m.gltf", file.gltf());
    AnimatedScene scene = loaded();
    for (const auto& [time, before] : {std::pair(0.5, 0.25), std::pair(1.0, 0.75), std::pair(0.25, 0.5)}) {
        SCOPED_TRACE(time);
        scene.pose(time);
        const GpuScene records = scene.build();
        const SceneMotion motion = scene.motion_since(before);
        AnimatedScene fresh = loaded();
        fresh.pose(before);
        EXPECT_EQ(motion.cameras, fresh.scene().cameras);
        size_t deforming = 0;
        for (uint32_t i = 0; i < scene.scene().shapes.size(); ++i) {
            const auto& now = std::get<MeshInstance>(scene.scene().shapes[i].geometry);
            const auto& then = std::get<MeshInstance>(fresh.scene().shapes[i].geometry);
            const TriangleMesh& mesh = scene.scene().meshes[now.mesh];
            const TriangleMesh& mesh_then = fresh.scene().meshes[then.mesh];
            const auto moved = motion.shapes.find(i);
            if (moved == motion.shapes.end()) {
                EXPECT_TRUE(now == then || mesh.positions.empty() || mesh_then.positions.empty());
                continue;
            }
            EXPECT_EQ(moved->second.now, now.transform.matrix());
            if (mesh_then.positions.empty()) continue;  // It was hidden.
            EXPECT_EQ(moved->second.before, then.transform.matrix());
            if (moved->second.corners.empty()) continue;
            ++deforming;
            EXPECT_EQ(mesh.positions.size(), 4u);
            EXPECT_EQ(moved->second.corners.size(), mesh.triangles.size());
            ASSERT_EQ(mesh.positions.size(), mesh_then.positions.size());
            for (size_t v = 0; v < mesh.positions.size(); ++v) {
                EXPECT_EQ(moved->second.positions_now[v], mesh.origin + dvec3(mesh.positions[v]));
                EXPECT_EQ(moved->second.positions_before[v],
                          mesh_then.origin + dvec3(mesh_then.positions[v]));
            }
        }
        EXPECT_EQ(deforming, 2u);
        // The records do not know of it.
        AnimatedScene other = loaded();
        other.pose(time);
        expect_equal(records, other.build());
    }
}

TEST_F(AnimatedSceneTest, WhatDoesNotMoveIsNeitherReadNorBuiltAgain) {
    AnimatedScene scene = loaded();
    scene.pose(0.6);
    const GpuScene before = scene.build();
    folder_.write("m.gltf", "");
    scene.pose(0.7);
    BufferSet changed = changed_buffers(before, scene.build());
    EXPECT_TRUE(changed[BUFFER_PRIMITIVES]) << "a mesh deforms";
    EXPECT_FALSE(changed[BUFFER_MATERIALS] || changed[BUFFER_ENVIRONMENT]);
    // The shape that moves is an instance, so that nothing of the others lies in the records that change.
    GltfFile file = moving_file();
    for (const int channel : {5, 4, 3, 2, 1})
        file.root["animations"][0]["channels"].erase(size_t(channel));
    folder_.write("m.gltf", file.gltf());
    AnimatedScene rigid = loaded();
    rigid.pose(0.6);
    const GpuScene first = rigid.build();
    rigid.pose(0.7);
    changed = changed_buffers(first, rigid.build());
    EXPECT_EQ(changed, BufferSet().set(BUFFER_NODES));
    EXPECT_EQ(first.instances.size(), 1u);
}

// At 501 times, of which few are among those that were looked at.
TEST_F(AnimatedSceneTest, BoundsHoldAllFramesAndNotMuchMore) {
    AnimatedScene scene = loaded();
    const DoubleBox box = bounds(scene.scene());
    DoubleBox seen;
    for (int i = 0; i <= 500; ++i) {
        scene.pose(i / 500.0);
        for (const dvec3 p : corners_of(scene.scene()))
            seen.extend(p);
        EXPECT_EQ(bounds(scene.scene()).lo, box.lo);
        EXPECT_EQ(bounds(scene.scene()).hi, box.hi);
    }
    // An arc of radius 1 between two looks, 90/16 degrees apart, exceeds them by 1 - cos(90/32 degrees).
    const double exceeded = 1.0 - std::cos(glm::radians(90.0 / 32.0));
    for (const int i : {0, 1, 2}) {
        EXPECT_LE(box.lo[i], seen.lo[i] + exceeded);
        EXPECT_GE(box.hi[i], seen.hi[i] - exceeded);
        EXPECT_NEAR(box.lo[i], seen.lo[i], exceeded);
        EXPECT_NEAR(box.hi[i], seen.hi[i], exceeded);
    }
    EXPECT_LT(box.hi.y, 10.0) << "what is hidden there does not count";
}

TEST_F(AnimatedSceneTest, WhatIsFittedToTheSceneIsTheSameInAllFrames) {
    AnimatedScene scene = loaded({.lighting = {.studio = StudioChoice::sunset}});
    scene.pose(0.0);
    const auto& ground = std::get<Disk>(scene.scene().shapes.back().geometry);
    const dvec3 center = ground.center;
    const Camera camera = Surroundings(scene.scene()).view("view", {.azimuth = 0.5, .elevation = 0.3}, {});
    const SceneFrame frame = scene.build().frame;
    scene.pose(1.0);
    EXPECT_EQ(std::get<Disk>(scene.scene().shapes.back().geometry).center, center);
    EXPECT_EQ(Surroundings(scene.scene()).view("view", {.azimuth = 0.5, .elevation = 0.3}, {}), camera);
    EXPECT_EQ(scene.build().frame, frame);
}

TEST_F(AnimatedSceneTest, LightsMoveAndGoOut) {
    GltfFile file = moving_file();
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    for (Json& node : file.root["nodes"]) {
        if (node["name"] == "blink") node["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
    }
    folder_.write("m.gltf", file.gltf());
    AnimatedScene scene = loaded();
    EXPECT_FALSE(scene.scene().environment) << "the light decides, though it is out at times";
    const auto light = [&] { return std::get<PointLight>(scene.scene().lights.at(0).model); };
    scene.pose(0.25);
    EXPECT_EQ(light().position, dvec3(0, -1, 0));
    EXPECT_EQ(light().intensity, vec3(1));
    scene.pose(0.75);
    EXPECT_EQ(light().position, dvec3(0, 50, 0));
    EXPECT_EQ(light().intensity, vec3(0));
}

TEST_F(AnimatedSceneTest, OfNothingThatMovesIsRefused) {
    GltfFile file = corner_file();
    const auto expect_refused = [&](const std::string& cause) {
        folder_.write("m.gltf", file.gltf());
        EXPECT_EQ(folder_.without_folder(error_of([&] { loaded(); })),
                  "m.gltf: the " + cause + ", so that all frames would be the same; leave --frames out");
    };
    expect_refused("file has no animations");
    file.push("animations", {{"channels", Json::array()}, {"samplers", Json::array()}});
    expect_refused("animation moves neither nodes nor weights");
}

TEST_F(AnimatedSceneTest, WarnsOnce) {
    GltfFile file = moving_file();
    for (Json& node : file.root["nodes"]) {
        if (node["name"] == "eye") node["scale"] = {1, 1, 1};
    }
    // The camera is flattened at 1 s.
    Json& animation = file.root["animations"][0];
    animation["channels"][6]["target"]["path"] = "scale";
    animation["samplers"][6]["output"] = file.add<float>("VEC3", {1, 1, 1, 0, 0, 0});
    folder_.write("m.gltf", file.gltf());
    AnimatedScene scene = loaded();
    scene.pose(0.0);
    scene.take_warnings();
    const Camera camera = scene.scene().cameras.at(0);
    scene.pose(1.0);
    EXPECT_EQ(scene.scene().cameras.at(0), camera);
    const std::vector<std::string> warnings = scene.take_warnings();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(folder_.without_folder(warnings[0]),
              "m.gltf#/nodes/9: at some times, the node's transform flattens its camera, which is then where "
              "it is without the animation");
    scene.pose(1.0);
    EXPECT_TRUE(scene.take_warnings().empty());
}

}  // namespace
}  // namespace candela
