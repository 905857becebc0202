// OBJ files whose materials look up images, from the files to the scene.
#include <algorithm>

#include <gtest/gtest.h>

#include "scene/images.h"
#include "support/png_writer.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

constexpr const char* SHAPE = R"({"type": "obj", "file": "m.obj"})";

class ObjTextures : public testing::Test {
  protected:
    ObjTextures() { write_faces("usemtl a\nf 1/1 2/2 3/3\n"); }

    void write_faces(const std::string& faces) {
        folder_.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n" + faces);
    }

    // An image of one texel, whose channels are all 51 (0.2).
    void write_image(const std::string& name, PngColor color) {
        PngPicture picture{.size = {1, 1}, .bits = 8, .color = color};
        picture.samples.assign(picture.channels(), 51);
        folder_.write(name, encode_png(picture));
    }

    // The scene of a shape with this library.
    Scene load(const std::string& library) {
        folder_.write("m.mtl", library);
        return folder_.load(scene_of(SHAPE));
    }

    static const Material& material(const Scene& scene, size_t shape = 0) {
        return scene.materials.at(scene.shapes.at(shape).material);
    }

    SceneFolder folder_;
};

TEST_F(ObjTextures, ImagesLieBesideTheLibrary) {
    std::filesystem::create_directories(folder_.path() / "parts/my tex");
    write_image("parts/my tex/a.png", png_rgb);
    folder_.write("parts/m.mtl", "newmtl a\nmap_Kd my tex\\a.png\nmap_Ke my tex/../my tex/a.png\n");
    folder_.write("m.obj",
                  "mtllib parts/m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    const Scene scene = folder_.load(scene_of(SHAPE));
    ASSERT_EQ(scene.images.size(), 1u);  // Under two names.
    EXPECT_EQ(scene.images[0].image->size, uvec2(1, 1));
    EXPECT_EQ(folder_.without_folder(scene.images[0].place), "parts/m.mtl:2");
    EXPECT_NE(std::ranges::find(scene.files, folder_.path() / "parts/my tex/a.png"), scene.files.end());
    EXPECT_EQ(scene.shapes.at(0).emission->radiance.texture->image, 0u);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjTextures, MaterialsShareImages) {
    for (const char* name : {"a.png", "b.png", "n.png"})
        write_image(name, png_rgb);
    write_faces("usemtl b\nf 1/1 2/2 3/3\nusemtl a\nf 3/3 2/2 1/1\n");
    const Scene scene = load(
        "newmtl a\nmap_Kd a.png\nnorm n.png\nmap_Ke b.png\nnewmtl b\nmap_Kd b.png\nmap_d a.png\n"
        "newmtl unused\nmap_Kd no.png\n");
    ASSERT_EQ(scene.images.size(), 3u);
    const auto name_of = [&](const Texture& texture) {
        return scene.images.at(texture.image).path.filename().string();
    };
    const Material& b = material(scene, 0);
    EXPECT_EQ(name_of(*std::get<DiffuseMaterial>(b.model).reflectance.texture), "b.png");
    EXPECT_EQ(name_of(*b.opacity.value.texture), "a.png");
    const Material& a = material(scene, 1);
    EXPECT_EQ(a.name, "m.obj/a");
    EXPECT_EQ(name_of(*std::get<DiffuseMaterial>(a.model).reflectance.texture), "a.png");
    EXPECT_EQ(name_of(a.normal_map->texture), "n.png");
    EXPECT_EQ(name_of(*scene.shapes.at(1).emission->radiance.texture), "b.png");
    EXPECT_FALSE(scene.shapes.at(0).emission);
    EXPECT_TRUE(scene.meshes.at(0).tangents.empty());
    EXPECT_FALSE(scene.meshes.at(1).tangents.empty());
}

TEST_F(ObjTextures, OpacityIsAlphaWhereThereIsAlpha) {
    for (const auto& [color, channel] : {std::pair(png_grey, 0u), std::pair(png_rgb, 0u),
                                         std::pair(png_grey_alpha, 3u), std::pair(png_rgb_alpha, 3u)}) {
        write_image("a.png", color);
        EXPECT_EQ(material(load("newmtl a\nKd 1\nmap_d a.png\n")).opacity.value.texture->channel, channel);
        EXPECT_EQ(material(load("newmtl a\nKd 1\nmap_d -imfchan g a.png\n")).opacity.value.texture->channel,
                  1u);
        EXPECT_EQ(material(load("newmtl a\nmap_Kd a.png\nmap_d a.png\n")).opacity.value.texture->channel, 3u);
    }
}

// Heights are in the units of the mesh.
TEST_F(ObjTextures, HeightsGrowWithTheMesh) {
    write_image("a.png", png_grey);
    folder_.write("m.mtl", "newmtl a\nKd 1\nbump -bm 3 a.png\n");
    const auto shape = [](const std::string& transform) {
        return R"({"type": "obj", "file": "m.obj", "transform": [)" + transform + "]}";
    };
    const Scene scene = folder_.load(scene_of(shape(R"({"scale": 0.25})") + ',' + shape(R"({"scale": -4})") +
                                              ',' + shape(R"({"scale": 0.25}, {"translate": [1, 2, 3]})") +
                                              ',' + shape(R"({"scale": [1, 2, 4]})")));
    const auto scale = [&](size_t i) { return material(scene, i).bump_map->scale; };
    EXPECT_EQ(scale(0), 0.75f);
    EXPECT_EQ(scale(1), 12.0f);
    EXPECT_EQ(scale(2), 0.75f);
    EXPECT_EQ(scale(3), 6.0f);
    EXPECT_EQ(scene.shapes[0].material, scene.shapes[2].material);
    EXPECT_EQ(material(scene, 0).name, "m.obj/a");
    EXPECT_EQ(material(scene, 1).name, "m.obj/a (2)");
    EXPECT_EQ(scene.warnings.size(), 1u);  // There is no light.
}

// Blender writes normal maps as map_Bump, and -bm is then their strength, regardless of the scale.
TEST_F(ObjTextures, ABlueBumpMapIsANormalMap) {
    folder_.write("n.png",
                  encode_png({.size = uvec2(1), .bits = 8, .color = png_rgb, .samples = {128, 128, 255}}));
    folder_.write("m.mtl", "newmtl a\nKd 1\nmap_Bump -bm 0.5 -imfchan b n.png\n");
    const Scene scene =
        folder_.load(scene_of(R"({"type": "obj", "file": "m.obj", "transform": [{"scale": 100}]})"));
    EXPECT_FALSE(material(scene).bump_map);
    ASSERT_TRUE(material(scene).normal_map);
    EXPECT_EQ(material(scene).normal_map->scale, 0.5f);
    EXPECT_EQ(material(scene).normal_map->texture.image, 0u);
    EXPECT_FALSE(scene.meshes.at(0).tangents.empty());
    ASSERT_EQ(scene.warnings.size(), 2u);  // The other: there is no light.
    EXPECT_EQ(
        folder_.without_folder(scene.warnings[0]),
        "m.mtl:3: the bump map of the material \"m.obj/a\", n.png, has the colours of a normal map and is "
        "read as one; to say so, name it as norm");
}

TEST_F(ObjTextures, ImagesMayBeMissing) {
    const std::string library =
        "newmtl a\nKd 0.5 0.25 0.125\nmap_Kd no.png\nmap_Ke gone/e.png\nd 0.5\nmap_d no.png\nnorm n.png\n";
    const Scene scene = load(library);
    const Material& read = material(scene);
    EXPECT_EQ(std::get<DiffuseMaterial>(read.model).reflectance, vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(read.opacity.value, 0.5f);
    EXPECT_FALSE(read.normal_map);
    EXPECT_FALSE(scene.shapes.at(0).emission);  // It is not white.
    ASSERT_EQ(scene.warnings.size(), 2u);
    EXPECT_EQ(
        folder_.without_folder(scene.warnings[1]),
        "scene.json:3:11: the scene has no light: the image will be black");  // With that image, it had.
    EXPECT_EQ(folder_.without_folder(scene.warnings[0]),
              "m.mtl:3: 3 images do not exist; white is used instead: \"no.png\", \"n.png\", \"gone/e.png\"");
    const auto error = [&](const std::string& text, const ImageOptions& options) {
        folder_.write("m.mtl", text);
        return folder_.without_folder(error_of([&] { folder_.load(scene_of(SHAPE), options); }));
    };
    EXPECT_EQ(error(library, {.if_missing = IfMissing::error}),
              "m.mtl:3: cannot read \"no.png\": the file does not exist; check the name");
    folder_.write("a.png", "no image");
    EXPECT_EQ(error("newmtl a\nnorm a.png\n", {}).substr(0, 9), "m.mtl:2: ");
    // With a material of the scene, nobody asks for them.
    EXPECT_NO_THROW(folder_.load(scene_of(R"({"type": "obj", "file": "m.obj", "material": "white"})")));
    // A scene that names such an image itself means it.
    folder_.write("m.mtl", "newmtl a\nmap_Kd no.png\n");
    EXPECT_THROW(
        folder_.load(R"({"materials": {"m": {"type": "diffuse", "reflectance": {"image": "no.png"}}}, )" +
                     GOOD_CAMERA + R"(, "shapes": [)" + SHAPE + "]}"),
        Error);
}

// Whether they exist is not told.
TEST_F(ObjTextures, ImagesOutOfReachAreAsGoodAsMissing) {
    std::filesystem::create_directory(folder_.path() / "in");
    folder_.write("in/m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    write_image("there.png", png_rgb);
    std::filesystem::create_symlink("../there.png", folder_.path() / "in/link.png");
    const std::filesystem::path file = folder_.path() / "in/m.obj";
    for (const std::string name :
         {"../there.png", "../none.png", "..\\none.png", "\"../there.png\"", "link.png"}) {
        SCOPED_TRACE(name);
        const std::string path = "in/" + (name == "link.png"                        ? name
                                          : name.find("there") != std::string::npos ? "../there.png"
                                                                                    : "../none.png");
        folder_.write("in/m.mtl", "newmtl a\nKd 0.5\nmap_Kd " + name + "\nmap_Ke " + name + "\n");
        const Scene scene = load_scene(file);
        EXPECT_EQ(std::get<DiffuseMaterial>(material(scene).model).reflectance, vec3(0.5f));
        EXPECT_FALSE(scene.shapes.at(0).emission);
        const std::string refusal =
            "in/m.mtl:3: cannot read \"" + path + "\": with links followed, it is not ";
        EXPECT_EQ(folder_.without_folder(scene.warnings.at(0)).substr(0, refusal.size()), refusal);
        EXPECT_TRUE(scene.warnings[0].ends_with("(--allow-any-folder); white is used instead"));
        const LoadOptions strict{.images = {.if_missing = IfMissing::error}};
        const std::string error = error_of([&] { load_scene(file, strict); });
        EXPECT_EQ(folder_.without_folder(error).substr(0, refusal.size()), refusal);
    }
    folder_.write("in/there.png", "no image");  // A name alone is one in the folder.
    EXPECT_NE(error_of([&] {
                  folder_.write("in/m.mtl", "newmtl a\nmap_Kd ../there.png\n");
                  load_scene(file);
              }),
              "");
}

TEST_F(ObjTextures, ImagesMayBeNamedByOtherComputers) {
    write_image("my wall.png", png_rgb);
    for (const char* name : {"\"my wall.png\"", "C:\\textures\\my wall.png", "/gone/my wall.png",
                             "my wall.png # 1", "..\\tex\\my wall.png"}) {
        SCOPED_TRACE(name);
        const Scene scene = load(std::string("newmtl a\nmap_Kd -clamp on ") + name + "\n");
        EXPECT_EQ(scene.images.at(0).image->size, uvec2(1));
        EXPECT_EQ(scene.images[0].path, folder_.path() / "my wall.png");
        EXPECT_EQ(scene.warnings.size(), 1u);  // There is no light.
    }
}

TEST_F(ObjTextures, EachPartHasTextureCoordinatesIfItNeedsThem) {
    write_image("a.png", png_rgb);
    const std::string library = "newmtl a\nmap_Kd a.png\nnewmtl b\nKd 1\n";
    write_faces("usemtl b\nf 1 2 3\nusemtl a\nf 1/1 2/2 3/3\nf 3 2 1\n");
    const Scene scene = load(library);
    EXPECT_TRUE(scene.meshes.at(0).uv0.empty());
    EXPECT_EQ(scene.meshes.at(1).uv0.size(), 6u);
    write_faces("usemtl b\nf 1/1 2/2 3/3\nusemtl a\nf 1 2 3\n");
    const Scene none = load(library);
    EXPECT_EQ(none.meshes.at(1).uv0, std::vector<vec2>(3, vec2(0)));
    ASSERT_EQ(none.warnings.size(), 2u);  // The other: there is no light.
    EXPECT_EQ(folder_.without_folder(none.warnings[0]),
              "scene.json:3:36: m.obj: the material \"a\" has textures, but its faces have no texture "
              "coordinates: they show the corner (0, 0) of each image");
    folder_.write("m.mtl", "newmtl a\nKd 0\nmap_Ke a.png\n");
    EXPECT_EQ(folder_.load(scene_of(SHAPE)).meshes.at(0).uv0.size(), 3u);
}

TEST_F(ObjTextures, AreInASceneOfItsOwn) {
    write_image("a.png", png_rgb);
    folder_.write("m.mtl", "newmtl a\nmap_Kd a.png\nd 0.5\n");
    const Scene scene = load_scene(folder_.path() / "m.obj");
    EXPECT_EQ(std::get<DiffuseMaterial>(material(scene).model).reflectance.factor, vec3(1));
    EXPECT_EQ(material(scene).opacity.value, 0.5f);
    EXPECT_EQ(scene.images.at(0).image->channels, 3u);
    EXPECT_EQ(scene.meshes.at(0).uv0, (std::vector<vec2>{vec2(0, 0), vec2(1, 0), vec2(0, 1)}));
}

}  // namespace
}  // namespace candela
