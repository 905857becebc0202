// Cameras and lights of glTF files, and what files get that have neither.
// Ref: Khronos, "glTF 2.0 Specification", section 3.10; KHR_lights_punctual.
#include <cmath>

#include "image/image_io.h"
#include "scene/geometry.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

class GltfCamera : public Gltf {
  protected:
    static GltfFile seen_by(const Json& camera, const Json& node = Json::object()) {
        GltfFile file = corner_file();
        Json all = {{"camera", file.push("cameras", camera)}};
        all.update(node);
        file.push("nodes", all);
        return file;
    }
    static Json perspective(const Json& more = Json::object()) {
        Json view = {{"yfov", 0.5}, {"znear", 0.1}};
        view.update(more);
        return {{"type", "perspective"}, {"perspective", view}};
    }
    static Json orthographic(const Json& xmag, const Json& ymag) {
        return {{"type", "orthographic"},
                {"orthographic", {{"xmag", xmag}, {"ymag", ymag}, {"znear", 0}, {"zfar", 1}}}};
    }
};

TEST_F(GltfCamera, LooksAlongItsNodesNegativeZ) {
    // A quarter turn about y takes -z to -x.
    const Scene scene =
        load(seen_by(perspective(), {{"translation", {1, 2, 3}}, {"rotation", {0, ROOT, 0, ROOT}}}));
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& camera = scene.cameras[0];
    EXPECT_EQ(camera.position, dvec3(1, 2, 3));
    EXPECT_LE(distance(normalize(camera.look_at - camera.position), dvec3(-1, 0, 0)), 1e-6);
    EXPECT_LE(distance(camera.up, vec3(0, 1, 0)), 1e-6f);
    EXPECT_EQ(camera.vertical_fov, 0.5f);
    EXPECT_FALSE(camera.ortho_height);
    EXPECT_FALSE(camera.film_size);  // Without an aspect ratio.
}

TEST_F(GltfCamera, ItsAspectRatioGivesThePicturesSize) {
    const auto size = [&](const Json& camera) {
        return load(seen_by(camera)).cameras.at(0).film_size.value();
    };
    const auto ratio = [](uvec2 pixels) { return double(pixels.x) / double(pixels.y); };
    for (const double aspect : {2.0, 1.0, 0.5, 16.0 / 9.0}) {
        // Whole pixels.
        EXPECT_NEAR(ratio(size(perspective({{"aspectRatio", aspect}}))), aspect, 1e-3);
        EXPECT_NEAR(ratio(size(orthographic(aspect * 3.0, 3.0))), aspect, 1e-3);
    }
    EXPECT_EQ(size(perspective({{"aspectRatio", 1e9}})).x, 65536u);
    EXPECT_EQ(size(perspective({{"aspectRatio", 1e-9}})).x, 1u);
    for (const double none : {0.0, -1.0}) {
        const Scene scene = expect_warning(
            seen_by(perspective({{"aspectRatio", none}})),
            "#/cameras/0/perspective/aspectRatio: an aspect ratio that is not above 0 is ignored");
        EXPECT_FALSE(scene.cameras.at(0).film_size);
    }
}

TEST_F(GltfCamera, AnOrthographicOneSeesTwiceItsMagnification) {
    const Camera camera = load(seen_by(orthographic(3, 1.5))).cameras.at(0);
    EXPECT_EQ(camera.ortho_height, 3.0);
    const Scene mirrored =
        expect_warning(seen_by(orthographic(3, -1.5)),
                       "#/cameras/0/orthographic/ymag: the sign of the view's size is ignored");
    EXPECT_EQ(mirrored.cameras.at(0).ortho_height, 3.0);
    for (const auto& [size, text] :
         {std::pair(0.0, "0"), std::pair(1e38, "1e+38"), std::pair(1e-40, "1e-40")}) {
        const std::string message =
            std::string(": expected a number from 1.2e-38 to 1e37, half the size of the view, found ") + text;
        expect_error(seen_by(orthographic(size, 1)), "#/cameras/0/orthographic/xmag: \"xmag\"" + message);
        expect_error(seen_by(orthographic(1, size)), "#/cameras/0/orthographic/ymag: \"ymag\"" + message);
    }
}

TEST_F(GltfCamera, HasTheNameOfItsNodeOrItsOwn) {
    GltfFile file = seen_by(perspective());
    file.root["cameras"][0]["name"] = "lens";
    for (const Json& node :
         {Json{{"camera", 0}, {"name", "left"}}, Json{{"camera", 0}, {"name", "left"}}, Json{{"camera", 0}}})
        file.push("nodes", node);
    std::vector<std::string> names;
    for (const Camera& camera : load(file).cameras)
        names.push_back(camera.name);
    EXPECT_EQ(names, (std::vector<std::string>{"lens", "left", "left (2)", "lens (2)"}));
    EXPECT_EQ(load(seen_by(perspective())).cameras.at(0).name, "camera 0");
}

TEST_F(GltfCamera, RefusesOnesThatSeeNothing) {
    for (const auto& [angle, text] : {std::pair(0.0, "0"), std::pair(3.2, "3.2"), std::pair(-1.0, "-1")}) {
        expect_error(seen_by(perspective({{"yfov", angle}})),
                     std::string("#/cameras/0/perspective/yfov: \"yfov\": "
                                 "expected an angle between 0 and pi, found ") +
                         text);
    }
    expect_error(seen_by({{"type", "fisheye"}}),
                 "#/cameras/0/type: \"type\": expected \"perspective\" or "
                 "\"orthographic\", found \"fisheye\"");
    expect_error(seen_by({{"type", "perspective"}}),
                 "#/cameras/0: the key \"perspective\" is missing here; add it");
    expect_error(seen_by(Json::object()), "#/cameras/0: the key \"type\" is missing here; add it");
    EXPECT_TRUE(expect_warning(seen_by(perspective(), {{"scale", {1, 0, 1}}}),
                               "#/nodes/1: left out a camera that its transform flattens")
                    .cameras.empty());
    expect_error(seen_by(perspective(), {{"translation", {0, 2e37, 0}}}),
                 "#/nodes/1: it lies beyond 1e37 along an axis; check the transforms of the nodes around it");
    GltfFile file = seen_by(perspective());
    file.root["nodes"][1]["camera"] = 1;
    expect_error(file,
                 "#/nodes/1/camera: \"cameras\" has no element 1, only 0 to 0; name one that the file "
                 "has");
}

class GltfLight : public Gltf {
  protected:
    static GltfFile lit_by(const Json& light, const Json& node = Json::object()) {
        GltfFile file = corner_file();
        file.root["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
        Json all = {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
        all.update(node);
        file.push("nodes", all);
        return file;
    }
    template <class Model>
    Model read(const Json& light, LightUnits units = LightUnits::spec) {
        const Scene scene =
            load(lit_by(light, {{"translation", {1, 2, 3}}, {"rotation", {0, ROOT, 0, ROOT}}}),
                 {.light_units = units});
        EXPECT_EQ(scene.warnings, std::vector<std::string>{});
        return std::get<Model>(scene.lights.at(0).model);
    }
    static void expect_near(vec3 value, dvec3 expected) {
        EXPECT_LE(distance(dvec3(value), expected), 1e-6 * length(expected));
    }
};

TEST_F(GltfLight, ReadsEachKind) {
    const auto point = read<PointLight>({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 100}});
    EXPECT_EQ(point.position, dvec3(1, 2, 3));
    EXPECT_EQ(point.intensity, vec3(100, 50, 0));
    EXPECT_EQ(read<PointLight>({{"type", "point"}}).intensity, vec3(1));
    const auto spot = read<SpotLight>(
        {{"type", "spot"}, {"intensity", 3}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}});
    EXPECT_EQ(spot.position, dvec3(1, 2, 3));
    EXPECT_LE(distance(spot.direction, dvec3(-1, 0, 0)), 1e-6);
    EXPECT_EQ(spot.intensity, vec3(3));
    EXPECT_EQ(spot.cone.inner_angle, 0.25f);
    EXPECT_EQ(spot.cone.outer_angle, 0.5f);
    const auto plain = read<SpotLight>({{"type", "spot"}, {"spot", Json::object()}});
    EXPECT_EQ(plain.cone.inner_angle, 0.0f);
    EXPECT_EQ(plain.cone.outer_angle, float(std::acos(-1.0) / 4));
    const auto sun =
        read<DirectionalLight>({{"type", "directional"}, {"color", {1, 0.5, 0}}, {"intensity", 4}});
    EXPECT_LE(distance(sun.direction, dvec3(-1, 0, 0)), 1e-6);
    EXPECT_EQ(sun.irradiance, vec3(4, 2, 0));
    EXPECT_EQ(load(lit_by({{"type", "point"}, {"name", "lamp"}})).lights.at(0).name, "lamp");
    EXPECT_EQ(load(lit_by({{"type", "point"}})).lights.at(0).name, "light 0");
}

TEST_F(GltfLight, CountsInTheUnitsThatAreAskedFor) {
    const Json lamp = {{"type", "point"}, {"intensity", 683}},
               sun = {{"type", "directional"}, {"intensity", 683}};
    const Json spot = {{"type", "spot"}, {"intensity", 683}};
    const double sphere = 4.0 * std::acos(-1.0);
    expect_near(read<PointLight>(lamp, LightUnits::spec).intensity, dvec3(683));
    expect_near(read<PointLight>(lamp, LightUnits::blender).intensity, dvec3(1));
    expect_near(read<PointLight>(lamp, LightUnits::raw).intensity, dvec3(683 / sphere));
    expect_near(read<SpotLight>(spot, LightUnits::blender).intensity, dvec3(1));
    expect_near(read<SpotLight>(spot, LightUnits::raw).intensity, dvec3(683 / sphere));
    expect_near(read<DirectionalLight>(sun, LightUnits::spec).irradiance, dvec3(683));
    expect_near(read<DirectionalLight>(sun, LightUnits::blender).irradiance, dvec3(1));
    expect_near(read<DirectionalLight>(sun, LightUnits::raw).irradiance, dvec3(683));
    // Those of the program that wrote the file, unless others are asked for.
    GltfFile file = lit_by(lamp);
    file.root["asset"]["generator"] = "Khronos glTF Blender I/O v3.6.5";
    const Scene scene = expect_warning(file,
                                       ": Blender wrote the file, so its lights are read as watts times 683 "
                                       "lm/W; if that is too dark, use --light-units spec or raw");
    expect_near(std::get<PointLight>(scene.lights.at(0).model).intensity, dvec3(1));
    // Blender multiplies since its exporter 3.4.35; names without a version are of today.
    for (const char* generator : {"Khronos glTF Blender I/O v1.2.75", "Khronos glTF Blender I/O v3.3.27",
                                  "Khronos Blender glTF 2.0 I/O"}) {
        file.root["asset"]["generator"] = generator;
        const Scene old = expect_warning(file,
                                         ": a Blender before 3.4 wrote the file, so its lights are read as "
                                         "watts; if that is too dark, use --light-units spec");
        expect_near(std::get<PointLight>(old.lights.at(0).model).intensity, dvec3(683 / sphere));
    }
    for (const char* generator :
         {"Khronos glTF Blender I/O v3.4.50", "Khronos glTF Blender I/O v10.0.1", "Blender"}) {
        file.root["asset"]["generator"] = generator;
        expect_near(std::get<PointLight>(load(file).lights.at(0).model).intensity, dvec3(1));
    }
    const Scene as_spec = load(file, {.light_units = LightUnits::spec});
    EXPECT_TRUE(as_spec.warnings.empty());
    EXPECT_EQ(std::get<PointLight>(as_spec.lights.at(0).model).intensity, vec3(683));
    file.root["nodes"].erase(1);
    EXPECT_TRUE(load(file).warnings.empty());
}

TEST_F(GltfLight, NotesWhatIsOdd) {
    const std::string light = "#/extensions/KHR_lights_punctual/lights/0";
    expect_warning(lit_by({{"type", "point"}, {"range", 5}}),
                   light +
                       "/range: the range of a light is ignored: its "
                       "intensity falls with the squared distance");
    expect_warning(lit_by({{"type", "point"}, {"intensity", -1}}),
                   light + "/intensity: -1 is not between 0 and 1e+30; it is read as 0");
    expect_warning(lit_by({{"type", "point"}, {"color", {1, 2, 1}}}),
                   light + "/color: 2 is not between 0 and 1; it is read as 1");
    expect_warning(lit_by({{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}),
                   light + "/spot/outerConeAngle: 2 is not between 0 and 1.5708; it is read as 1.5708");
    const Scene scene = expect_warning(
        lit_by({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.25}}}}),
        light + "/spot: the inner angle of a spot is greater than the outer one, and is treated as equal");
    for (const Json& cone : {Json{{"innerConeAngle", 0.25}, {"outerConeAngle", 0.25}},
                             Json{{"innerConeAngle", 0}, {"outerConeAngle", 0}}}) {
        const auto spot = read<SpotLight>({{"type", "spot"}, {"spot", cone}});
        EXPECT_LT(spot.cone.inner_angle, spot.cone.outer_angle);
        EXPECT_NEAR(spot.cone.outer_angle, cone["outerConeAngle"].get<double>(), 2.1e-4);
    }
}

TEST_F(GltfLight, RefusesOnesThatAreNone) {
    const std::string light = "#/extensions/KHR_lights_punctual/lights/0";
    const std::string of_node = "#/nodes/1/extensions/KHR_lights_punctual/light: ";
    expect_error(lit_by({{"type", "area"}}), light +
                                                 "/type: \"type\": expected \"point\", \"spot\" or "
                                                 "\"directional\", found \"area\"");
    expect_error(lit_by(Json::object()), light + ": the key \"type\" is missing here; add it");
    expect_error(lit_by({{"type", "point"}}, {{"translation", {0, 0, -2e37}}}),
                 of_node + "it lies beyond 1e37 along an axis; check the transforms of the nodes around it");
    GltfFile file = lit_by({{"type", "point"}});
    file.root["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 1;
    expect_error(file, of_node + "there is no light 1 among 1");
    file.root.erase("extensions");
    expect_error(file, of_node + "the file has no lights; export it again");
}

// What a viewer shows of a file without camera and light.
TEST_F(GltfLight, FilesWithoutCameraOrLightGetBoth) {
    const auto complete = [&](const GltfFile& file) {
        folder_.write("m.gltf", file.gltf());
        return load_scene(folder_.path() / "m.gltf");
    };
    const auto warnings = [&](const Scene& scene) {
        std::string text;
        for (const std::string& warning : scene.warnings)
            text += folder_.without_folder(warning) + '\n';
        return text;
    };
    const std::string camera =
        "m.gltf: there is no camera; the scene is seen from the front, a little from the right and above\n";
    const std::string light =
        "m.gltf: there is no light; a studio, which the camera does not see, lights the scene\n";
    const Scene bare = complete(corner_file());
    EXPECT_EQ(warnings(bare), camera + light);
    EXPECT_EQ(bare.cameras.size(), 1u);
    ASSERT_TRUE(bare.environment);
    EXPECT_FALSE(bare.environment->visible);
    EXPECT_TRUE(gives_light(*bare.environment));
    EXPECT_EQ(bare.film.size, uvec2(1280, 720));
    const Scene lit = complete(lit_by({{"type", "point"}}));
    EXPECT_EQ(warnings(lit), camera);
    EXPECT_FALSE(lit.environment);
    // Surfaces that emit or need no light will do.
    GltfFile glowing = corner_file();
    glowing.root["meshes"][0]["primitives"][0]["material"] = 0;
    glowing.root["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
    EXPECT_EQ(warnings(complete(glowing)), camera);
    glowing.root["materials"] = {{{"extensions", {{"KHR_materials_unlit", Json::object()}}}}};
    EXPECT_EQ(warnings(complete(glowing)), camera);
    // One that needs no light is none for others.
    glowing.show_corner();
    EXPECT_EQ(warnings(complete(glowing)), camera + light);
    EXPECT_EQ(warnings(complete(GltfFile())), "m.gltf: the scene has no surfaces\n" + camera + light);
    GltfFile seen = corner_file();
    seen.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    seen.push("nodes", {{"camera", 0}});
    EXPECT_EQ(warnings(complete(seen)), light);
}

// As of a toy whose lamps glow: a quarter of this image does, then half of it.
TEST_F(GltfLight, AnImageThatIsMostlyBlackLightsNothing) {
    const auto glowing = [&](uint8_t second) {
        const std::vector<uint8_t> rgb{255, 255, 255, second, second, second, 12, 12, 12, 0, 0, 0};
        write_png(folder_.path() / "glow.png", 2, 2, rgb);
        GltfFile file;
        file.root["images"] = {{{"uri", "glow.png"}}};
        file.root["textures"] = {{{"source", 0}}};
        file.root["materials"] = {{{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0}}}}};
        const size_t uv = file.add<float>("VEC2", {0, 0, 1, 0, 0, 1});
        file.show({{"attributes", {{"POSITION", file.add_corner()}, {"TEXCOORD_0", uv}}}, {"material", 0}});
        folder_.write("m.gltf", file.gltf());
        return load_scene(folder_.path() / "m.gltf");
    };
    const Scene toy = glowing(0);
    EXPECT_TRUE(toy.environment);
    EXPECT_EQ(
        folder_.without_folder(toy.warnings.back()),
        "m.gltf: only small or dim surfaces emit light; a studio, which the camera does not see, lights the "
        "scene (--studio off leaves it out)");
    EXPECT_FALSE(glowing(30).environment);
}

// A body, and what glows near it.
class GltfStudio : public Gltf {
  protected:
    GltfStudio() {
        file_.push("meshes", square(0));
        file_.push("meshes", square(1));
        file_.push("nodes", {{"mesh", 0}});
        file_.root["materials"] = {Json::object(), {{"emissiveFactor", {1, 1, 1}}}};
    }
    // A mesh of the square [-1, 1]^2 that faces +z.
    Json square(int material) {
        const size_t positions = file_.add<float>("VEC3", {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
        const size_t indices = file_.add<uint8_t>("SCALAR", {0, 1, 2, 0, 2, 3});
        return {
            {"primitives",
             {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", material}}}}};
    }
    // Another square that emits.
    void glow(const Json& node) {
        Json all = {{"mesh", 1}};
        all.update(node);
        file_.push("nodes", all);
    }
    Scene complete(std::optional<StudioChoice> studio = {}) {
        folder_.write("m.gltf", file_.gltf());
        Scene scene = load_scene(folder_.path() / "m.gltf", {.lighting = {.studio = studio}});
        EXPECT_FALSE(scene.warnings.empty());
        scene.warnings.erase(scene.warnings.begin());  // There is no camera.
        for (std::string& warning : scene.warnings)
            warning = folder_.without_folder(warning);
        return scene;
    }
    void expect_lit_by_itself() {
        const Scene scene = complete();
        EXPECT_FALSE(scene.environment);
        EXPECT_EQ(scene.warnings, Warnings());
    }
    void expect_dim() {
        const Scene scene = complete();
        EXPECT_TRUE(scene.environment);
        EXPECT_EQ(scene.warnings,
                  Warnings{"m.gltf: only small or dim surfaces emit light; a studio, which the "
                           "camera does not see, lights the scene (--studio off leaves it out)"});
    }

    using Warnings = std::vector<std::string>;
    static inline const Json FACING_BACK = {0, 1, 0, 0};  // A half turn about y.
    GltfFile file_;
};

TEST_F(GltfStudio, AnEyeThatGlowsDoesNotPutItOut) {
    glow({{"scale", {0.1, 0.1, 0.1}}, {"translation", {0.5, 0.5, 0.05}}});
    expect_dim();
}

TEST_F(GltfStudio, ALargePanelDoesIfItFacesTheScene) {
    const Json towards = {{"translation", {0, 0, 2}}, {"rotation", FACING_BACK}},
               away = {{"translation", {0, 0, 2}}};
    // A body larger than the panel, so that the panel is less than half of all.
    file_.root["nodes"][0]["scale"] = {1.5, 1.5, 1};
    glow(towards);
    expect_lit_by_itself();
    file_.root["nodes"].erase(1);
    glow(away);
    expect_dim();
    file_.root["nodes"].erase(1);
    glow(towards);
    file_.root["materials"][1]["emissiveFactor"] = {0.1, 0.1, 0.1};
    expect_dim();
}

TEST_F(GltfStudio, ABodyThatGlowsAllOverNeedsNone) {
    file_.root["materials"][0]["emissiveFactor"] = {0.2, 0.2, 0.2};
    expect_lit_by_itself();
    file_.root["materials"][0]["emissiveFactor"] = {0.01, 0.01, 0.01};
    expect_dim();
}

TEST_F(GltfStudio, WhatIsBrighterThanWhiteIsALightOfAnySize) {
    glow({{"scale", {0.1, 0.1, 0.1}}});
    file_.root["materials"][1]["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 2}};
    const Scene scene = complete();
    EXPECT_FALSE(scene.environment);
    EXPECT_EQ(
        scene.warnings,
        Warnings{"m.gltf: only small or dim surfaces emit light; if that is too dark, use --studio default"});
    // As old files of VRM say it.
    file_.root["materials"][1]["extensions"] = {
        {"VRMC_materials_hdr_emissiveMultiplier", {{"emissiveMultiplier", 2}}}};
    EXPECT_FALSE(complete().environment);
}

TEST_F(GltfStudio, CanBeChosen) {
    const Scene off = complete(StudioChoice::off);
    EXPECT_FALSE(off.environment);
    EXPECT_EQ(off.warnings,
              Warnings{"m.gltf: there is no light, and the studio is off: the picture will be black"});
    glow({{"scale", {0.1, 0.1, 0.1}}});
    const Scene alone = complete(StudioChoice::off);
    EXPECT_FALSE(alone.environment);
    EXPECT_EQ(alone.warnings, Warnings());
    glow({{"translation", {0, 0, 1}}, {"rotation", FACING_BACK}});
    expect_lit_by_itself();
    const Scene always = complete(StudioChoice::standard);
    ASSERT_TRUE(always.environment);
    EXPECT_EQ(always.warnings, Warnings());
    EXPECT_EQ(complete(StudioChoice::automatic).environment.has_value(), false);
    // Also in the place of the environment of a native scene.
    folder_.write("m.gltf", file_.gltf());
    folder_.write("s.json", R"({"scene": "m.gltf", "environment": {"radiance": 1}})");
    const auto environment = [&](StudioChoice studio) {
        return load_scene(folder_.path() / "s.json", {.lighting = {.studio = studio}}).environment;
    };
    EXPECT_EQ(environment(StudioChoice::standard).value().radiance, always.environment->radiance);
    EXPECT_EQ(environment(StudioChoice::off).value().radiance, std::vector<vec3>{vec3(1)});
}

// A native scene states its lights by hand.
TEST_F(GltfStudio, ShapesOfANativeSceneLightIt) {
    folder_.write("m.gltf", file_.gltf());
    folder_.write("s.json", R"({"scene": "m.gltf", "shapes":
        [{"type": "disk", "center": [0, 0, 1], "normal": [0, 0, -1], "radius": 0.01, "emission": 0.5}]})");
    EXPECT_FALSE(load_scene(folder_.path() / "s.json").environment);
}

}  // namespace
}  // namespace candela
