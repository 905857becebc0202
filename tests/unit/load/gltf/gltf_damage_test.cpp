// glTF files that are cut off or changed: an Error, and nothing worse.
#include "fuzz/memory_file.h"
#include "unit/base/damage.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

// A file with something of everything.
GltfFile rich_file() {
    GltfFile file;
    const Json sparse = {{"count", 1},
                         {"indices", {{"bufferView", file.add_view<uint8_t>({1})}, {"componentType", 5121}}},
                         {"values", {{"bufferView", file.add_view<float>({0, 0, 1})}}}};
    const Json attributes = {
        {"POSITION", file.add_corner()},
        {"NORMAL", file.add_normalized("VEC3", std::vector<int8_t>{0, 0, 127, 0, 0, 127, 0, 0, 127})},
        {"TEXCOORD_0", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})},
        {"COLOR_0", file.add_normalized("VEC4", std::vector<uint8_t>(12, 200))},
        {"JOINTS_0", file.add<uint8_t>("VEC4", {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0})},
        {"WEIGHTS_0", file.add<float>("VEC4", std::vector<float>(12, 0.25f))}};
    const Json moved = {
        {"POSITION",
         file.push("accessors",
                   {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}})}};
    file.root["images"] = {{{"bufferView", file.add_view<char>({'p', 'n', 'g'})}}};
    file.root["textures"] = {{{"source", 0}}};
    file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                               {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}}};
    file.show({{"attributes", attributes},
               {"indices", file.add<uint16_t>("SCALAR", {0, 1, 2})},
               {"material", 0},
               {"targets", Json::array({moved})}},
              {{"skin", 0}, {"weights", {0.5}}});
    file.push("nodes", {{"children", {2}}, {"rotation", {0, 0, 0, 1}}, {"camera", 0}});
    file.push("nodes", {{"scale", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.root["skins"] = {{{"joints", {1, 2}}}};
    file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}}}}};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", Json::object()}}};
    const Json sampler = {{"input", file.add<float>("SCALAR", {0, 1})},
                          {"output", file.add<float>("VEC3", {0, 0, 0, 1, 2, 3})}};
    file.push("animations",
              {{"samplers", Json::array({sampler})},
               {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
    return file;
}

Scene load_bytes(const std::string& bytes) {
    Scene scene;
    const fuzz::MemoryFile file(bytes);
    scene.reach = FileReach(file.path());
    GltfFiles files;
    add_gltf_scene(file.path(), {.time = 0.5}, scene, no_progress, files);
    return scene;
}

TEST(GltfDamage, EveryTruncationIsRefused) {
    const GltfFile file = rich_file();
    for (const std::string& whole : {file.gltf(), file.glb()}) {
        EXPECT_EQ(load_bytes(whole).shapes.size(), 1u);
        for (size_t size = 0; size < whole.size(); ++size)
            EXPECT_THROW(load_bytes(whole.substr(0, size)), Error) << size;
    }
}

// A header that is right about a file that is too short.
TEST(GltfDamage, EveryTruncationOfABufferIsRefused) {
    GltfFile file = rich_file();
    const std::string whole = file.bytes;
    const Json buffers = {{{"byteLength", whole.size()}}};
    for (size_t size = 0; size < whole.size(); ++size) {
        file.root["buffers"] = buffers;
        file.root["buffers"][0]["uri"] = "data:;base64," + base64(whole.substr(0, size));
        EXPECT_THROW(load_bytes(file.gltf()), Error) << size;
        if (size == 0) continue;
        // Only what is used must be there.
        file.root["buffers"][0]["byteLength"] = size;
        if (size + 24 < whole.size()) {
            EXPECT_THROW(load_bytes(file.gltf()), Error) << size;
        }
    }
}

TEST(GltfDamage, RandomBytesDoNothingWorse) {
    const GltfFile file = rich_file();
    const auto load = [](const std::string& bytes) { load_bytes(bytes); };
    const std::string likely = "0123456789-.,:\"{}[]eE\\/%=\xff" + std::string(1, '\0');
    EXPECT_GT(count_refused(file.gltf(), likely, 3000, load), 1500u);
    EXPECT_GT(count_refused(file.glb(), likely, 3000, load), 1500u);
}

}  // namespace
}  // namespace candela
