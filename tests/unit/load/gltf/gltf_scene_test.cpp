// glTF files as scenes: extensions, what a file says of itself, native scenes that name one, and options.
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfScene : public Gltf {
  protected:
    // Loads a native scene that names m.gltf.
    Scene native(const GltfFile& file, const std::string& members = "", const GltfOptions& options = {}) {
        folder_.write("m.gltf", file.gltf());
        folder_.write("scene.json", "{\"scene\": \"m.gltf\"" + members + "}");
        return load_scene(folder_.path() / "scene.json", {.images = {}, .gltf = options});
    }

    // A triangle of the material "wood", and a camera "eye".
    static GltfFile wooden() {
        GltfFile file = corner_file();
        file.root["materials"] = {{{"name", "wood"}}};
        file.root["meshes"][0]["primitives"][0]["material"] = 0;
        file.root["cameras"] = {
            {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}, {"aspectRatio", 2}}}}};
        file.push("nodes", {{"camera", 0}, {"name", "eye"}});
        return file;
    }
};

TEST_F(GltfScene, RefusesExtensionsThatItRequiresAndNotesTheOthers) {
    GltfFile file = corner_file();
    file.root["extensionsUsed"] = {"KHR_texture_transform", "EXT_texture_avif"};
    expect_warning(file,
                   "#/extensionsUsed/1: the extension \"EXT_texture_avif\" is not read: "
                   "images in PNG, JPEG or WebP are used instead");
    file.root["extensionsUsed"] = Json::array({"ACME_teapots"});
    expect_warning(file,
                   "#/extensionsUsed/0: the extension \"ACME_teapots\" is not read: what it adds is missing");
    file.root["extensionsRequired"] = {"KHR_mesh_quantization", "ACME_teapots"};
    expect_error(file,
                 "#/extensionsRequired/1: the file requires the extension \"ACME_teapots\", which is not "
                 "read; export the scene without it");
    file.root["extensionsRequired"] = Json::array({"EXT_texture_avif"});
    expect_error(file,
                 "#/extensionsRequired/0: the file requires the extension \"EXT_texture_avif\", which is not "
                 "read; convert its images to PNG, JPEG or WebP");
    file.root["extensionsRequired"] = Json::array({"KHR_gaussian_splatting"});
    expect_error(
        file,
        "#/extensionsRequired/0: the file requires the extension \"KHR_gaussian_splatting\", which is "
        "not read; its splats are points without a surface: export a mesh of the scene");
    file.root["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_texture_transform"};
    file.root.erase("extensionsUsed");
    EXPECT_TRUE(load(file).warnings.empty());
    file.root["extensionsRequired"] = 1;
    expect_error(file, "#/extensionsRequired: \"extensionsRequired\": expected an array [ ... ], found 1");
}

TEST_F(GltfScene, ExtensionsThatShowInNoPictureAreListedOnce) {
    const std::vector<std::string> names{"AGI_articulations",
                                         "CESIUM_RTC",
                                         "CESIUM_primitive_outline",
                                         "EXT_instance_features",
                                         "EXT_mesh_features",
                                         "EXT_mesh_manifold",
                                         "EXT_structural_metadata",
                                         "FB_ngon_encoding",
                                         "GODOT_single_root",
                                         "KHR_animation_pointer",
                                         "KHR_audio_emitter",
                                         "KHR_physics_rigid_bodies",
                                         "MSFT_lod",
                                         "MSFT_packing_occlusionRoughnessMetallic",
                                         "NEEDLE_components",
                                         "OMI_seat",
                                         "VRMC_springBone",
                                         "VRMC_vrm",
                                         "VRMC_vrm_animation"};
    GltfFile file = corner_file();
    std::string list;
    for (const std::string& name : names)
        list += (list.empty() ? "\"" : ", \"") + name + "\"";
    file.root["extensionsUsed"] = file.root["extensionsRequired"] = names;
    file.root["extensionsUsed"].push_back("KHR_xmp_json_ld");
    file.root["extensionsUsed"].push_back("VRMC_vrm");
    expect_warning(file, "#/extensionsUsed: what these extensions add does not show in a picture: " + list);
}

TEST_F(GltfScene, WhatBeginsLikeSuchAnExtensionIsAnother) {
    GltfFile file = corner_file();
    file.root["extensionsRequired"] = Json::array({"MSFT_lod2"});
    expect_error(file,
                 "#/extensionsRequired/0: the file requires the extension \"MSFT_lod2\", which is not read; "
                 "export the scene without it");
}

TEST_F(GltfScene, WhatOtherExtensionsWouldChangeIsSaid) {
    for (const auto& [name, missing] :
         {std::pair("EXT_lights_ies", "lights shine evenly, without a profile"),
          std::pair("EXT_texture_avif", "images in PNG, JPEG or WebP are used instead"),
          std::pair("VRMC_materials_mtoon", "toon shading looks as the material does without it"),
          std::pair("VRM", "toon shading looks as the material does without it")}) {
        GltfFile file = corner_file();
        file.root["extensionsUsed"] = Json::array({name});
        expect_warning(file,
                       concat("#/extensionsUsed/0: the extension \"", name, "\" is not read: ", missing));
    }
}

TEST_F(GltfScene, WhatAFileSaysOfItselfIsKept) {
    GltfFile file = corner_file();
    file.root["asset"]["generator"] = "by hand";
    file.root["asset"]["copyright"] = "CC0";
    using Attributes = std::vector<std::pair<std::string, std::string>>;
    EXPECT_EQ(
        load(file).attributes,
        (Attributes{{"gltf.generator", "by hand"}, {"gltf.copyright", "CC0"}, {"gltf.version", "2.0"}}));
    // Names of another type are none.
    file.root["asset"]["generator"] = file.root["nodes"][0]["name"] = file.root["meshes"][0]["name"] = 7;
    file.root["materials"] = {{{"name", 7}}};
    file.root["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_EQ(load(file).materials.at(0).name, "material 0");
}

TEST_F(GltfScene, ANativeSceneReplacesMaterialsByName) {
    const Scene scene = native(
        wooden(),
        R"(, "materials": {"wood": {"type": "diffuse", "reflectance": 0.25}, "glue": {"type": "mirror"}})");
    ASSERT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(scene.materials.size(), 2u);
    const Material& wood = scene.materials.at(scene.shapes[0].material);
    EXPECT_EQ(wood.name, "wood");
    EXPECT_EQ(std::get<DiffuseMaterial>(wood.model).reflectance, Textured<vec3>(vec3(0.25f)));
    EXPECT_EQ(scene.files, std::vector<std::filesystem::path>{folder_.path() / "m.gltf"});
}

TEST_F(GltfScene, ANativeSceneAddsWhatTheFormatCannotSay) {
    const GltfFile file = wooden();
    const Scene plain = native(file);
    EXPECT_EQ(plain.film.size, uvec2(1280, 720));
    EXPECT_EQ(plain.cameras.at(0).film_size, uvec2(1440, 720));
    ASSERT_EQ(plain.warnings.size(), 1u);
    EXPECT_EQ(
        folder_.without_folder(plain.warnings[0]),
        "scene.json:1:11: there is no light; a studio, which the camera does not see, lights the scene");
    const Scene scene = native(file, R"(,
"film": {"size": [300, 200]},
"cameras": {"eye": {"position": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40}},
"shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 2, "material": "wood"}],
"environment": {"radiance": 2})");
    EXPECT_EQ(scene.film.size, uvec2(300, 200));
    // The scene's own camera comes first.
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].position, dvec3(0, 0, 5));
    EXPECT_EQ(scene.cameras[1].name, "eye (2)");
    EXPECT_FALSE(scene.cameras[1].film_size);
    // Its shapes may be of the file's materials.
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
    EXPECT_EQ(scene.environment.value().radiance, std::vector<vec3>{vec3(2)});
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfScene, ANativeScenePassesOptionsAndErrorsOn) {
    GltfFile file = wooden();
    file.root["scenes"] = {{{"nodes", {0, 1}}}, {{"nodes", {1}}, {"name", "none"}}};
    EXPECT_EQ(native(file).shapes.size(), 1u);
    EXPECT_EQ(native(file, "", {.scene = "none"}).shapes.size(), 0u);
    const auto message = [&](const GltfOptions& options) {
        return folder_.without_folder(error_of([&] { native(file, "", options); }));
    };
    EXPECT_EQ(message({.scene = "x"}),
              "scene.json:1:11: --scene: m.gltf has nothing called \"x\" among its scenes (known: 0, none)");
    file.root["scene"] = 2;
    EXPECT_EQ(message({}),
              "scene.json:1:11: m.gltf#/scene: \"scenes\" has no element 2, only 0 to 1; name one "
              "that the file has");
    folder_.write("scene.json", R"({"scene": "m.obj"})");
    EXPECT_EQ(folder_.without_folder(error_of([&] { load_scene(folder_.path() / "scene.json"); })),
              "scene.json:1:11: cannot read \"m.obj\": the file does not exist; check the name");
}

TEST_F(GltfScene, OtherFormatsRefuseItsOptions) {
    folder_.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder_.write("m.ply", "ply\n");
    folder_.write("m.json", "{" + GOOD_CAMERA + ", \"shapes\": []}");
    for (const std::string name : {"m.obj", "m.ply", "m.json"}) {
        for (const GltfOptions& options : {GltfOptions{.time = 1.0}, GltfOptions{.scene = "a"},
                                           GltfOptions{.light_units = LightUnits::raw}}) {
            try {
                load_scene(folder_.path() / name, {.images = {}, .gltf = options});
                ADD_FAILURE() << name;
            } catch (const Error& error) {
                EXPECT_EQ(
                    folder_.without_folder(error.what()),
                    name +
                        ": --scene, --animation, --time, --frames, --variant and --light-units are for glTF "
                        "files; leave "
                        "them out");
                EXPECT_EQ(error.kind(), ErrorKind::request);
            }
        }
    }
}

}  // namespace
}  // namespace candela
