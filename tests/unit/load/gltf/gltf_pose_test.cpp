// Scenes at several times from one reading of a glTF file.
#include <algorithm>

#include "gpu_scene/gpu_scene.h"
#include "support/png_writer.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfPose : public Gltf {
  protected:
    // A triangle with an image beside the file moves, with a morph target, and shrinks to a point at 1 s.
    // Another one takes its roughness from an image within the buffer, and so does the sky, which no other
    // part needs.
    static GltfFile moving() {
        GltfFile file;
        const std::string grey =
            encode_png({.size = uvec2(1), .bits = 8, .color = png_rgb_alpha, .samples = {90, 120, 150, 200}});
        file.root["images"] = {{{"uri", "a.png"}},
                               {{"bufferView", file.add_view(std::vector<char>(grey.begin(), grey.end()))}},
                               {{"uri", "sky.png"}}};
        file.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
        const Json old = {{"specularGlossinessTexture", {{"index", 1}}}};
        file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}},
                                  {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", old}}}}};
        const Json attributes = {{"POSITION", file.add_corner()},
                                 {"TEXCOORD_0", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})}};
        const size_t target = file.add<float>("VEC3", {0, 0, 1, 0, 0, 2, 0, 0, 3});
        file.show({{"attributes", attributes}, {"material", 0}, {"targets", {{{"POSITION", target}}}}});
        file.show({{"attributes", attributes}, {"material", 1}}, {{"translation", {4, 0, 0}}});
        const size_t times = file.add<float>("SCALAR", {0, 1});
        Json samplers, channels;
        const auto animate = [&](const char* path, const char* type, const std::vector<float>& values) {
            channels.push_back({{"sampler", channels.size()}, {"target", {{"node", 0}, {"path", path}}}});
            samplers.push_back({{"input", times}, {"output", file.add(type, values)}});
        };
        animate("translation", "VEC3", {0, 0, 0, 3, 5, 7});
        animate("scale", "VEC3", {1, 1, 1, 0, 0, 0});
        animate("weights", "SCALAR", {0, 1});
        file.root["animations"] = {{{"samplers", samplers}, {"channels", channels}}};
        const Json use = {{"EXT_lights_image_based", {{"light", 0}}}};
        file.root["scenes"] = {{{"nodes", {0, 1}}, {"extensions", use}}};
        const Json faces = Json::array({Json::array({2, 2, 2, 2, 2, 2})});
        file.root["extensions"]["EXT_lights_image_based"]["lights"] = {{{"specularImages", faces}}};
        return file;
    }

    void write_images() {
        const auto write = [&](const char* name, std::vector<uint32_t> samples) {
            folder_.write(name,
                          encode_png({.size = uvec2(1), .bits = 8, .color = png_rgb, .samples = samples}));
        };
        write("a.png", {10, 100, 200});
        write("sky.png", {200, 210, 255});
    }

    Scene at(std::optional<double> time, LoadedFiles* files = nullptr) {
        const LoadOptions options{.gltf = {.time = time}};
        const std::filesystem::path path = folder_.path() / "m.json";
        return files == nullptr ? load_scene(path, options) : load_scene(path, options, *files);
    }
};

TEST_F(GltfPose, ManyTimesFromOneReadingAreAsMuchAsManyReadings) {
    constexpr std::array<std::optional<double>, 5> TIMES{0.25, std::nullopt, 1.0, 0.75, 0.25};
    const GltfFile file = moving();
    folder_.write("m.gltf", file.document("m.bin"));
    folder_.write("m.bin", file.bytes);
    folder_.write("m.json", R"({"scene": "m.gltf"})");
    write_images();
    std::vector<Scene> fresh;
    for (const auto& time : TIMES)
        fresh.push_back(at(time));
    ASSERT_EQ(fresh[0].shapes.size(), 2u);
    ASSERT_EQ(fresh[2].shapes.size(), 1u);  // The other one is a point.
    EXPECT_NE(build_gpu_scene(fresh[0]).arrays, build_gpu_scene(fresh[1]).arrays);

    LoadedFiles files;
    const Scene first = at(TIMES[0], &files);
    for (const char* name : {"m.gltf", "m.bin", "a.png", "sky.png"})
        folder_.write(name, "");  // So that nothing can be read again.
    for (size_t i = 0; i < TIMES.size(); ++i) {
        SCOPED_TRACE(i);
        const Scene scene = at(TIMES[i], &files);
        EXPECT_EQ(build_gpu_scene(scene).arrays, build_gpu_scene(fresh[i]).arrays);
        EXPECT_EQ(scene.warnings, fresh[i].warnings);
        EXPECT_EQ(scene.files, fresh[i].files);
        EXPECT_EQ(scene.attributes, fresh[i].attributes);
        for (const ImageFile& image : scene.images) {
            const auto same = std::ranges::find(first.images, image.real_path, &ImageFile::real_path);
            ASSERT_NE(same, first.images.end());
            EXPECT_EQ(image.image, same->image);  // The pointer.
        }
    }
}

// The scene with the fewest bytes decides how many zeros an accessor may have, regardless of what was read
// before.
TEST_F(GltfPose, WhatOtherScenesReadDoesNotCount) {
    GltfFile file = moving();
    const size_t zeros = file.push("accessors", {{"componentType", 5126}, {"count", 3000}, {"type", "VEC3"}});
    file.root["nodes"].push_back(
        {{"mesh", file.push("meshes", {{"primitives", {{{"attributes", {{"POSITION", zeros}}}}}}})}});
    file.root["scenes"].push_back({{"nodes", {2}}});
    file.bytes.resize(4096);
    folder_.write("m.gltf", file.document("m.bin"));
    folder_.write("m.bin", file.bytes);
    write_images();
    LoadedFiles files;
    const auto scene = [&](const char* name, LoadedFiles& all) {
        load_scene(folder_.path() / "m.gltf", {.gltf = {.scene = name}}, all);
    };
    scene("0", files);
    LoadedFiles none;
    const std::string expected = error_of([&] { scene("1", none); });
    EXPECT_NE(expected.find("an accessor without a bufferView is all zeros"), std::string::npos);
    EXPECT_EQ(error_of([&] { scene("1", files); }), expected);
}

// A file that is damaged is so at every time.
TEST_F(GltfPose, AnImageThatCannotBeReadIsAnErrorEachTime) {
    folder_.write("m.glb", moving().glb());
    folder_.write("m.json", R"({"scene": "m.glb"})");
    folder_.write("a.png", "nothing");
    folder_.write("sky.png", encode_png({.size = uvec2(1), .bits = 8, .color = png_grey, .samples = {9}}));
    LoadedFiles files;
    const std::string expected = error_of([&] { at(0.5, &files); });
    EXPECT_NE(expected.find("a.png"), std::string::npos);
    EXPECT_EQ(error_of([&] { at(0.75, &files); }), expected);
    write_images();
    EXPECT_EQ(at(0.5, &files).warnings, at(0.5).warnings);
}

}  // namespace
}  // namespace candela
