// Textures of glTF files: their images, samplers and transforms; and which material a primitive has.
// Ref: Khronos, "glTF 2.0 Specification", section 3.8; KHR_texture_transform; EXT_texture_webp;
// KHR_materials_variants.
#include <algorithm>
#include <cmath>

#include "image/texel_io.h"
#include "support/png_writer.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfTexture : public Gltf {
  protected:
    // A triangle with a base colour from texture 0.
    static GltfFile textured(const Json& info = Json::object()) {
        GltfFile file;
        file.root["images"] = {{{"uri", "a.png"}}};
        file.root["textures"] = {{{"source", 0}}};
        Json reference = {{"index", 0}};
        reference.update(info);
        file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", reference}}}}};
        const Json attributes = {{"POSITION", file.add_corner()},
                                 {"TEXCOORD_0", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})},
                                 {"TEXCOORD_1", file.add<float>("VEC2", {0, 0, 1, 0, 0, 1})}};
        file.show({{"attributes", attributes}, {"material", 0}});
        return file;
    }
    static std::optional<Texture> texture_of(const Scene& scene) {
        return std::get<PrincipledMaterial>(scene.materials.at(0).model).base_color.texture;
    }
    Texture read(const GltfFile& file) { return texture_of(load(file)).value(); }
};

TEST_F(GltfTexture, SamplersSayWhatLiesBetweenAndBeyondTexels) {
    const Texture plain = read(textured());
    EXPECT_EQ(plain.filter, TextureFilter::bilinear);
    EXPECT_EQ(plain.wrap_u, Wrap::repeat);
    EXPECT_EQ(plain.wrap_v, Wrap::repeat);
    GltfFile file = textured();
    file.root["textures"][0]["sampler"] = 0;
    file.root["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33648}}};
    EXPECT_EQ(read(file).filter, TextureFilter::nearest);
    EXPECT_EQ(read(file).wrap_u, Wrap::clamp);
    EXPECT_EQ(read(file).wrap_v, Wrap::mirror);
    file.root["samplers"][0] = {{"magFilter", 9729}, {"wrapS", 10497}};
    EXPECT_EQ(read(file).filter, TextureFilter::bilinear);
    EXPECT_EQ(read(file).wrap_u, Wrap::repeat);
    // What glTF has no number for, and programs write.
    for (const auto& [mode, nearest, wrap] :
         {std::tuple(0, 10497, Wrap::repeat), std::tuple(10496, 33071, Wrap::clamp),
          std::tuple(33069, 33071, Wrap::clamp)}) {
        file.root["samplers"][0]["wrapT"] = mode;
        const Scene scene = expect_warning(
            file,
            concat("#/samplers/0/wrapT: ", mode, " is not 33071, 33648 or 10497; ", nearest, " is used"));
        EXPECT_EQ(texture_of(scene).value().wrap_v, wrap);
    }
    file.root["textures"][0]["sampler"] = 1;
    expect_error(file,
                 "#/textures/0/sampler: \"samplers\" has no element 1, only 0 to 0; name one that the "
                 "file has");
    file.root.erase("samplers");
    const Scene without =
        expect_warning(file, "#/textures/0/sampler: the file has no samplers; the texture repeats");
    EXPECT_EQ(texture_of(without).value().wrap_u, Wrap::repeat);
}

TEST_F(GltfTexture, ImagesMayBeMissing) {
    GltfFile file = textured();
    file.root["images"] = {{{"uri", "a.png"}}, {{"uri", "b.png"}}};
    file.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
    Json& material = file.root["materials"][0];
    material["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 0.125, 1};
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.75;
    material["normalTexture"] = {{"index", 1}};
    material["emissiveTexture"] = {{"index", 1}};
    material["emissiveFactor"] = {1, 1, 1};
    folder_.write("m.gltf", file.gltf());
    const Scene scene = load_scene(folder_.path() / "m.gltf");
    const auto& read = std::get<PrincipledMaterial>(scene.materials.at(0).model);
    EXPECT_EQ(read.base_color, vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(read.roughness, 0.75f);
    EXPECT_EQ(read.metalness, 1.0f);
    EXPECT_EQ(read.emission, vec3(0));  // It is not white.
    EXPECT_FALSE(scene.materials[0].normal_map);
    const std::string expected =
        "m.gltf#/images/0/uri: 2 images do not exist; white is used instead: \"a.png\", \"b.png\"";
    EXPECT_TRUE(std::ranges::any_of(scene.warnings, [&](const std::string& warning) {
        return folder_.without_folder(warning) == expected;
    }));
    const LoadOptions strict{.images = {.if_missing = IfMissing::error}};
    EXPECT_EQ(folder_.without_folder(error_of([&] { load_scene(folder_.path() / "m.gltf", strict); })),
              "m.gltf#/images/0/uri: cannot read \"a.png\": the file does not exist; check the name");
    // Glossiness is in the alpha of white.
    file.root["materials"] = {
        {{"extensions",
          {{"KHR_materials_pbrSpecularGlossiness",
            {{"glossinessFactor", 0.75}, {"specularGlossinessTexture", {{"index", 0}}}}}}}}};
    folder_.write("m.gltf", file.gltf());
    const Scene old = load_scene(folder_.path() / "m.gltf");
    const auto roughness = std::get<PrincipledMaterial>(old.materials.at(0).model).roughness;
    ASSERT_TRUE(roughness.texture);
    EXPECT_NEAR(texel_codes(*old.images.at(roughness.texture->image).image, 0).x, 0.25f, 1.0f / 255.0f);
}

TEST_F(GltfTexture, ReadsTwoSetsOfCoordinates) {
    EXPECT_EQ(read(textured()).uv_set, 0u);
    EXPECT_EQ(read(textured({{"texCoord", 1}})).uv_set, 1u);
    const Json other = {{"texCoord", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}};
    EXPECT_EQ(read(textured(other)).uv_set, 1u);
    const Scene scene = expect_warning(textured({{"texCoord", 2}}),
                                       "#/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord: only "
                                       "TEXCOORD_0 and TEXCOORD_1 are read; TEXCOORD_0 is used");
    EXPECT_EQ(texture_of(scene)->uv_set, 0u);
}

// In the file, v grows downwards, here upwards: V = 1 - v. There,
// u' = c sx u + s sy v + ox, v' = -s sx u + c sy v + oy.
TEST_F(GltfTexture, TransformsCoordinatesByScaleThenRotationThenOffset) {
    const auto expect = [&](const std::vector<double>& offset, double angle,
                            const std::vector<double>& scale) {
        const Texture texture = read(textured(
            {{"extensions",
              {{"KHR_texture_transform", {{"offset", offset}, {"rotation", angle}, {"scale", scale}}}}}}));
        const double c = std::cos(angle), s = std::sin(angle);
        for (const auto& [u, v] : {std::pair(0.0, 0.0), std::pair(1.0, 0.0), std::pair(0.0, 1.0),
                                   std::pair(0.3, 0.8), std::pair(-2.0, 5.0)}) {
            const double u1 = c * scale[0] * u + s * scale[1] * v + offset[0];
            const double v1 = -s * scale[0] * u + c * scale[1] * v + offset[1];
            const dvec3 ours(u, 1.0 - v, 1.0);
            EXPECT_NEAR(dot(dvec3(texture.rows[0]), ours), u1, 1e-5);
            EXPECT_NEAR(dot(dvec3(texture.rows[1]), ours), 1.0 - v1, 1e-5);
        }
    };
    expect({0, 0}, 0, {1, 1});
    expect({0.25, -0.5}, 0, {1, 1});
    expect({0, 0}, 0, {2, -3});
    expect({0.1, 0.2}, 0.7, {2, 0.5});
    expect({0, 0}, -2.0, {1, 3});
    // The extension's example: the lower left quadrant, turned clockwise by 90 degrees. The image's lower
    // left quadrant is u' and V' from 0 to 1/2.
    const Texture example =
        read(textured({{"extensions",
                        {{"KHR_texture_transform",
                          {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}}}}}}));
    for (const dvec3 corner : {dvec3(0, 0, 1), dvec3(1, 0, 1), dvec3(0, 1, 1), dvec3(1, 1, 1)}) {
        for (const vec3 row : example.rows) {
            const double at = dot(dvec3(row), corner);
            EXPECT_TRUE(std::abs(at) < 1e-6 || std::abs(at - 0.5) < 1e-6) << at;
        }
    }
    expect_error(
        textured({{"extensions", {{"KHR_texture_transform", {{"offset", {0, 2e6}}}}}}}),
        "#/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset: "
        "\"offset\": expected numbers from -1e6 to 1e6, found [0, 2e+06]");
    expect_error(
        textured({{"extensions", {{"KHR_texture_transform", {{"scale", 2}}}}}}),
        "#/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale: "
        "\"scale\": expected two numbers, found 2");
}

TEST_F(GltfTexture, ImagesAreFilesDataInLineOrViews) {
    GltfFile file = textured();
    file.root["images"][0] = {{"uri", "two%20words.png"}};
    folder_.write("two words.png", "");
    const Scene beside = load(file);
    EXPECT_EQ(beside.images.at(0).path, folder_.path() / "two words.png");
    EXPECT_TRUE(beside.images[0].bytes.empty());
    EXPECT_TRUE(beside.images[0].of_gltf);  // Section 3.8.3: colour profiles are ignored.
    file.root["images"][0] = {{"uri", "data:image/png;base64," + base64("a file")}};
    EXPECT_EQ(load(file).images.at(0).bytes, "a file");
    file.root["images"][0] = {{"bufferView", file.add_view<char>({'a', ' ', 'v', 'i', 'e', 'w'})},
                              {"mimeType", "image/png"}};
    const Scene within = load(file);
    EXPECT_EQ(within.images.at(0).bytes, "a view");
    EXPECT_EQ(folder_.without_folder(within.images[0].path.string()), "m.gltf#/images/0");
    file.root["images"][0]["uri"] = "";
    EXPECT_EQ(load(file).images.at(0).bytes, "a view");
    file.root["images"][0]["uri"] = "a.png";
    const std::string one = "#/images/0: an image has either a uri or a bufferView; export the file again";
    expect_error(file, one);
    for (const Json& none : {Json{{"mimeType", "image/png"}}, Json{{"uri", ""}}}) {
        file.root["images"][0] = none;
        EXPECT_FALSE(texture_of(
            expect_warning(file, "#/images/0: the image has neither a uri nor a bufferView; it is white")));
    }
    file.root["images"][0] = {{"uri", "https://example.org/a.png"}};
    expect_error(file,
                 "#/images/0/uri: only files that are named relative to this one are read, not "
                 "\"https://example.org/a.png\"; put the file beside this one");
    file.root["textures"][0]["source"] = 1;
    expect_error(file,
                 "#/textures/0/source: \"images\" has no element 1, only 0 to 0; name one that the file "
                 "has");
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
    expect_error(file,
                 "#/materials/0/pbrMetallicRoughness/baseColorTexture/index: \"textures\" has no element 1, "
                 "only 0 to 0; name one that the file has");
}

// The place of an image that cannot be read is where the file names it.
TEST_F(GltfTexture, MessagesAboutImagesNameThem) {
    GltfFile file = textured();
    file.root["images"][0] = {{"bufferView", file.add_view<char>({'n', 'o', 'n', 'e'})}};
    folder_.write("m.gltf", file.gltf());
    const auto message = [&] {
        return folder_.without_folder(error_of([&] { load_scene(folder_.path() / "m.gltf"); }));
    };
    EXPECT_EQ(message(),
              "cannot read \"m.gltf#/images/0\": its first bytes are not those of an image that can be read; "
              "give PNG, JPEG or WebP");
    file.root["images"][0] = {{"uri", "a.gif"}};
    folder_.write("a.gif", "GIF89a");
    folder_.write("m.gltf", file.gltf());
    EXPECT_EQ(
        message(),
        "m.gltf#/images/0/uri: cannot read \"a.gif\": it is a GIF image; convert it to PNG, JPEG or WebP");
}

// What is odd in an image within the file names the file once, and advises nothing that glTF cannot say.
TEST_F(GltfTexture, WarningsAboutImagesNameTheFileOnce) {
    GltfFile file = textured();
    const std::string white =
        encode_png({.size = uvec2(1), .bits = 8, .color = png_rgb, .samples = {255, 255, 255}});
    file.root["images"][0] = {{"uri", "data:image/png;base64," + base64(white)}};
    file.root["materials"][0]["name"] = "wall";
    file.root["materials"][0]["alphaMode"] = "MASK";
    file.root["materials"][0]["normalTexture"] = {{"index", 0}};
    folder_.write("m.gltf", file.gltf());
    std::string all;
    for (const std::string& warning : load_scene(folder_.path() / "m.gltf").warnings)
        all += folder_.without_folder(warning) + '\n';
    EXPECT_NE(
        all.find("m.gltf#/images/0/uri: the normal map of the material \"wall\" has a mean of 1 1 1, not "),
        std::string::npos)
        << all;
    EXPECT_NE(
        all.find(
            "m.gltf#/images/0/uri: the opacity of the material \"wall\" is the alpha of the image, which "
            "has none: it is opaque\n"),
        std::string::npos)
        << all;
}

// A cube of light decodes its images itself.
TEST_F(GltfTexture, MessagesAboutFacesOfACubeNameThem) {
    GltfFile file = textured();
    file.root["images"][0] = {{"uri", "none.png"}};
    file.root["scenes"] = {{{"nodes", {0}}, {"extensions", {{"EXT_lights_image_based", {{"light", 0}}}}}}};
    const Json light = {{"specularImages", Json::array({std::vector<int>(6)})}};
    file.root["extensions"]["EXT_lights_image_based"]["lights"] = Json::array({light});
    expect_error(file, "#/images/0/uri: cannot read \"none.png\": the file does not exist; check the name");
    file.root["images"][0] = {{"bufferView", file.add_view<char>({'G', 'I', 'F', '8'})}};
    expect_text_error(
        file.gltf(),
        "cannot read \"m.gltf#/extensions/EXT_lights_image_based/lights/0/specularImages/0/0\": "
        "it is a GIF image; convert it to PNG or JPEG");
}

TEST_F(GltfTexture, AnImageIsReadOnceForAllItsTextures) {
    GltfFile file = textured();
    file.root["images"].push_back({{"uri", "data:;base64,QUJD"}});
    file.root["textures"] = {{{"source", 1}}, {{"source", 0}}, {{"source", 1}}};
    file.root["materials"][0]["emissiveFactor"] = {1, 1, 1};
    file.root["materials"][0]["emissiveTexture"] = {{"index", 2}};
    file.root["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 1}};
    EXPECT_EQ(load(file).images.size(), 2u);
}

TEST_F(GltfTexture, WebpComesFirstAndUnreadFormatsAreLeftOut) {
    GltfFile file = textured();
    file.root["images"] = {{{"uri", "a.png"}}, {{"uri", "a.webp"}}};
    file.root["textures"][0]["extensions"]["EXT_texture_webp"] = {{"source", 1}};
    EXPECT_EQ(load(file).images.at(0).path, folder_.path() / "a.webp");
    file.root["textures"][0]["extensions"] = {{"EXT_texture_avif", {{"source", 1}}}};
    EXPECT_EQ(load(file).images.at(0).path, folder_.path() / "a.png");
    file.root["textures"][0].erase("source");
    for (const std::string name : {"EXT_texture_avif", "MSFT_texture_dds"}) {
        file.root["textures"][0]["extensions"] = {{name, {{"source", 1}}}};
        EXPECT_FALSE(texture_of(expect_warning(file, "#/textures/0: the texture has an image of " + name +
                                                         " only, which is not read; it is white")));
    }
    file.root["textures"][0].erase("extensions");
    EXPECT_FALSE(texture_of(expect_warning(file, "#/textures/0: the texture has no image; it is white")));
}

TEST_F(GltfTexture, KtxComesFirstWhereItCanBeRead) {
    GltfFile file = textured();
    file.root["images"] = {{{"uri", "a.png"}}, {{"uri", "a.ktx2"}}};
    file.root["textures"][0]["extensions"] = {{"KHR_texture_basisu", {{"source", 1}}}};
    file.root["extensionsUsed"] = Json::array({"KHR_texture_basisu"});
    if (reads_ktx_texels()) {
        EXPECT_EQ(load(file).images.at(0).path, folder_.path() / "a.ktx2");
        file.root["extensionsRequired"] = Json::array({"KHR_texture_basisu"});
        file.root["textures"][0].erase("source");
        EXPECT_EQ(load(file).images.at(0).path, folder_.path() / "a.ktx2");
    } else {
        const Scene scene =
            expect_warning(file,
                           "#/extensionsUsed/0: the extension \"KHR_texture_basisu\" is not read: "
                           "images in PNG, JPEG or WebP are used instead");
        EXPECT_EQ(scene.images.at(0).path, folder_.path() / "a.png");
        file.root["extensionsRequired"] = Json::array({"KHR_texture_basisu"});
        expect_error(
            file,
            "#/extensionsRequired/0: the file requires the extension \"KHR_texture_basisu\", which is not "
            "read; run sh cmake/basisu.sh and build candela again, or convert its images to PNG, JPEG or "
            "WebP");
    }
}

TEST_F(GltfTexture, VariantsReplaceMaterials) {
    GltfFile file = corner_file();
    file.root["materials"] = {{{"name", "wood"}}, {{"name", "steel"}}};
    Json& primitive = file.root["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {1, 2}}}};
    file.root["extensions"]["KHR_materials_variants"]["variants"] = {
        {{"name", "warm"}}, {{"name", "cold"}}, {{"name", "blank"}}};
    const auto name = [&](const std::optional<std::string>& variant) {
        const Scene scene = load(file, {.variant = variant});
        return scene.materials.at(scene.shapes.at(0).material).name;
    };
    EXPECT_EQ(name({}), "wood");
    EXPECT_EQ(name("warm"), "wood");
    EXPECT_EQ(name("cold"), "steel");
    EXPECT_EQ(name("2"), "steel");
    expect_text_error(
        file.gltf(),
        "--variant: m.gltf has nothing called \"hot\" among its variants (known: warm, cold, blank)",
        "m.gltf", {.variant = "hot"});
    expect_text_error(corner_file().gltf(),
                      "--variant: m.gltf has nothing called \"hot\" among its variants (it has none)",
                      "m.gltf", {.variant = "hot"});
    Json& mappings = primitive["extensions"]["KHR_materials_variants"]["mappings"];
    mappings.push_back({{"material", 0}, {"variants", {0, 2}}});
    EXPECT_EQ(name("cold"), "steel");
    const Scene scene = expect_warning(file,
                                       "#/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/1/"
                                       "variants/1: the variant already has a material, which is used",
                                       {.variant = "blank"});
    EXPECT_EQ(scene.materials.at(scene.shapes.at(0).material).name, "steel");
    mappings[0]["material"] = 2;
    expect_error(file,
                 "#/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material: "
                 "\"materials\" has no element 2, only 0 to 1; name one that the file has",
                 {.variant = "cold"});
    primitive["material"] = 5;
    expect_error(file,
                 "#/meshes/0/primitives/0/material: \"materials\" has no element 5, only 0 to 1; name "
                 "one that the file has");
}

TEST_F(GltfTexture, VertexColoursMakeACopyOfTheMaterial) {
    GltfFile file = corner_file();
    file.root["materials"] = {{{"name", "wood"}}};
    file.root["meshes"][0]["primitives"][0]["material"] = 0;
    const size_t colors = file.add<float>("VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 1});
    for (const Json& material : {Json{{"material", 0}}, Json::object()}) {
        Json primitive = {{"attributes", {{"POSITION", 0}, {"COLOR_0", colors}}}};
        primitive.update(material);
        file.show(primitive);
        file.show(primitive);
    }
    const Scene scene = load(file);
    ASSERT_EQ(scene.shapes.size(), 5u);
    std::vector<std::string> names;
    for (const Shape& shape : scene.shapes) {
        const Material& material = scene.materials[shape.material];
        names.push_back(material.name + (material.vertex_colors ? " with colours" : ""));
    }
    EXPECT_EQ(names, (std::vector<std::string>{"wood", "wood (2) with colours", "wood (2) with colours",
                                               "(default) with colours", "(default) with colours"}));
}

}  // namespace
}  // namespace candela
