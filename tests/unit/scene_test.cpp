// Scene files: what a good one means, and what the loader says of each kind of bad one, with the place.
#include "scene/scene.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/file.h"
#include "scene/geometry.h"
#include "scene_fixture.h"

namespace candela {
namespace {

const std::string SCENES = CANDELA_SCENES;

void expect_near(vec3 actual, vec3 expected, float tolerance) {
    EXPECT_LE(length(actual - expected), tolerance)
        << actual.x << ", " << actual.y << ", " << actual.z << " instead of " << expected.x << ", "
        << expected.y << ", " << expected.z;
}

// A scene whose camera, film or integrator is under test.
std::string settings(const std::string& members) {
    return "{" + members + ",\n\"shapes\": []}";
}

std::string camera(const std::string& members) {
    return settings("\"film\": {\"size\": [200, 100]},\n\"cameras\": {\"main\": " + members + "}");
}

const std::string GOOD_CAMERA =
    R"("cameras": {"main": {"position": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40}})";

TEST(Scene, CornellBoxHasThePublishedFigures) {
    const Scene scene = load_scene(SCENES + "/cornell-box.json");
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "main");
    EXPECT_NEAR(glm::degrees(scene.cameras[0].vertical_fov), 39.3077f, 1e-4f);
    EXPECT_EQ(scene.cameras[0].position, vec3(0.278f, 0.273f, -0.8f));
    EXPECT_EQ(scene.film.size, uvec2(512, 512));
    EXPECT_EQ(scene.integrator.spp, 256u);
    EXPECT_FALSE(scene.integrator.max_depth.has_value());
    EXPECT_EQ(triangle_count(scene), 32u);
    EXPECT_EQ(emitter_count(scene), 1u);
    const Box box = bounds(scene);
    EXPECT_EQ(box.lo, vec3(0));
    EXPECT_EQ(box.hi, vec3(0.556f, 0.5488f, 0.5592f));
}

TEST(Scene, CornellBoxLightShinesDownAndIsBlack) {
    const Scene scene = load_scene(SCENES + "/cornell-box.json");
    const Shape& light = scene.shapes[0];
    ASSERT_TRUE(light.emission.has_value());
    EXPECT_EQ(light.emission->radiance, vec3(17, 12, 4));
    EXPECT_FALSE(light.emission->two_sided);
    const auto& c = std::get<Quad>(light.geometry).corners;
    expect_near(normalize(cross(c[1] - c[0], c[2] - c[0])), vec3(0, -1, 0), 1e-6f);
    const auto& black = std::get<DiffuseMaterial>(scene.materials[light.material].model);
    EXPECT_EQ(black.reflectance, vec3(0));
}

TEST(Scene, FurnaceEmitsFromEveryWallInwards) {
    const Scene scene = load_scene(SCENES + "/furnace.json");
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.shapes.size(), 6u);
    for (const Shape& shape : scene.shapes) {
        ASSERT_TRUE(shape.emission.has_value());
        EXPECT_EQ(shape.emission->radiance, vec3(1));
        EXPECT_TRUE(shape.emission->two_sided);
        EXPECT_EQ(std::get<DiffuseMaterial>(scene.materials[shape.material].model).reflectance, vec3(0.5f));
    }
}

TEST(Scene, MeshSceneHasFrontsAndNormalsOnTheSameSide) {
    const Scene scene = load_scene(SCENES + "/mesh.json");
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_GT(triangle_count(scene), 4000u);
    EXPECT_EQ(emitter_count(scene), 2u);
    for (const Shape& shape : scene.shapes) {
        const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
        if (mesh == nullptr) continue;
        double volume = 0.0;
        for (const uvec3 t : mesh->triangles) {
            const vec3 a = mesh->positions[t.x];
            const vec3 n = cross(mesh->positions[t.y] - a, mesh->positions[t.z] - a);
            volume += dot(a, n);
            for (glm::length_t i = 0; i < 3 && !mesh->normals.empty(); ++i) {
                ASSERT_GT(dot(n, mesh->normals[t[i]]), 0.0f);
                ASSERT_NEAR(length(mesh->normals[t[i]]), 1.0f, 1e-6f);
            }
        }
        // The octahedron is the closed emitter.
        if (shape.emission) {
            EXPECT_GT(volume, 0.0);
        }
    }
}

TEST(Scene, ReadsTheIntegrator) {
    SceneFolder folder;
    const Scene scene = folder.load(settings(GOOD_CAMERA + R"(, "integrator": {"spp": 16777216,
        "max_depth": 0, "rr_depth": 4096, "estimator": "light", "sampler": "stratified", "seed": 4294967295})"));
    EXPECT_EQ(scene.integrator.spp, 1u << 24);
    EXPECT_EQ(scene.integrator.max_depth, 0u);
    EXPECT_EQ(scene.integrator.rr_depth, 4096u);
    EXPECT_EQ(scene.integrator.estimator, Estimator::light);
    EXPECT_EQ(scene.integrator.sampler, SamplerKind::stratified);
    EXPECT_EQ(scene.integrator.seed, 0xFFFFFFFFu);
}

TEST(Scene, KeepsCamerasInOrder) {
    SceneFolder folder;
    const std::string rest =
        R"({"position": [0, 0, 5], "look_at": [0, 0, 0], "up": [1, 0, 0], "vertical_fov": 90})";
    const Scene scene =
        folder.load("{\"cameras\": {\"z\": " + rest + ", \"a\": " + rest + "}, \"shapes\": []}");
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "z");
    EXPECT_EQ(scene.cameras[1].name, "a");
    EXPECT_EQ(scene.cameras[0].up, vec3(1, 0, 0));
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov, PI / 2);
}

TEST(Scene, GivesEmittersWithoutMaterialOneBlackOne) {
    SceneFolder folder;
    const std::string box = R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1], )";
    const Scene scene = folder.load(scene_of(box + "\"emission\": [1, 0, 2]}, " + box + "\"emission\": 0}, " +
                                             box + "\"material\": \"white\", \"emission\": 3}"));
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(std::get<DiffuseMaterial>(scene.materials[2].model).reflectance, vec3(0));
    EXPECT_EQ(scene.shapes[0].material, 2u);
    EXPECT_EQ(scene.shapes[6].material, 2u);
    EXPECT_EQ(scene.shapes[12].material, 1u);
    EXPECT_EQ(scene.shapes[0].emission->radiance, vec3(1, 0, 2));
    EXPECT_FALSE(scene.shapes[6].emission.has_value());  // Switched off.
}

TEST(Scene, WarnsOfWhatIsOddButUsable) {
    SceneFolder folder;
    const auto warnings = [&](std::string text) {
        const std::string place = take_mark(text);
        const Scene scene = folder.load(text);
        EXPECT_EQ(scene.warnings.size(), 1u);
        const std::string warning = scene.warnings.empty() ? "" : folder.without_folder(scene.warnings[0]);
        const std::string prefix = "scene.json:" + place + ": ";
        EXPECT_TRUE(warning.starts_with(prefix)) << warning << " should be at " << place;
        return warning.substr(std::min(prefix.size(), warning.size()));
    };
    EXPECT_EQ(warnings("{" + GOOD_CAMERA + ", \"shapes\": @[]}"), "the scene has no shapes");
    EXPECT_EQ(
        warnings(
            "{\"materials\": {\"m\": {\"type\": \"diffuse\", \"reflectance\": 1}}, \"shapes\": @[{\"type\": "
            "\"box\", \"min\": [0, 0, 0], \"max\": [1, 1, 1], \"material\": \"m\"}], " +
            GOOD_CAMERA + "}"),
        "the scene has no light: the image will be black");
    EXPECT_EQ(warnings(scene_of(R"(@{"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                                    "triangles": [[0, 1, 2], [1, 1, 2], [0, 2, 2]], "emission": 1})")),
              "left out 2 triangles without area");
}

TEST(Scene, SaysWhichKeysItKnows) {
    SceneFolder folder;
    folder.expect_error(
        "{" + GOOD_CAMERA + ",\n\"shapes\": [], @\"light\": []}",
        "unknown key \"light\" (known: $schema, cameras, film, integrator, materials, shapes)");
    folder.expect_error(
        camera(R"({"position": [0, 0, 1], "look_at": [0, 0, 0], @"vertcal_fov": 40})"),
        "unknown key \"vertcal_fov\" (did you mean \"vertical_fov\"? known: position, look_at, up, "
        "vertical_fov, film_size, focal_length)");
    folder.expect_error(
        scene_of(R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1], @"colour": "white"})"),
        "unknown key \"colour\" (known: min, max, type, material, emission, two_sided, transform)");
    folder.expect_error("@{\"shapes\": []}", "the key \"cameras\" is missing here; add it");
    folder.expect_error("@[]", "the scene: expected an object { ... }, found []");
}

TEST(Scene, ChecksMaterials) {
    SceneFolder folder;
    const auto material = [](const std::string& value) {
        return settings(GOOD_CAMERA + ",\n\"materials\": {\"m\": " + value + "}");
    };
    const std::string box = R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1], "material": )";
    folder.expect_error(scene_of(box + "@\"glas\"}"),
                        "unknown material \"glas\" (did you mean \"glass\"? defined: glass, white)");
    folder.expect_error(scene_of(box + "@\"(black)\"}"),
                        "unknown material \"(black)\" (defined: glass, white)");
    folder.expect_error(material(R"({"type": @"difuse", "reflectance": 1})"),
                        "unknown type \"difuse\" (did you mean \"diffuse\"? known: diffuse)");
    folder.expect_error(material(R"({"type": "diffuse", "reflectance": @[0.5, 0.5, 1.01]})"),
                        "\"reflectance\": expected numbers from 0 to 1, found [0.5, 0.5, 1.01]");
    folder.expect_error(material(R"({"type": "diffuse", "reflectance": @-0.25})"),
                        "\"reflectance\": expected numbers of at least 0, found -0.25");
    folder.expect_error(material(R"({"type": "diffuse", "reflectance": @"white"})"),
                        "\"reflectance\": expected one grey number or three [r, g, b], found \"white\"");
    folder.expect_error(material(R"({"type": "diffuse", "reflectance": @[1, 1]})"),
                        "\"reflectance\": expected three numbers, found [1, 1]");
    folder.expect_error(material(R"(@{"type": "diffuse"})"),
                        "the key \"reflectance\" is missing here; add it");
}

TEST(Scene, ChecksFilmAndIntegrator) {
    SceneFolder folder;
    const auto film = [](const std::string& size) {
        return settings(GOOD_CAMERA + ",\n\"film\": {\"size\": " + size + "}");
    };
    const std::string side = "\"size\": expected a whole number from 1 to 65536, found ";
    folder.expect_error(film("[512, @0]"), side + "0");
    folder.expect_error(film("[@65537, 1]"), side + "65537");
    folder.expect_error(film("[@-1, 1]"), side + "-1");
    folder.expect_error(film("[@1.5, 1]"), side + "1.5");
    folder.expect_error(film("[1, @\"2\"]"), side + "\"2\"");
    folder.expect_error(film("@[1]"), "\"size\": expected two whole numbers [width, height], found [1]");

    const auto integrator = [](const std::string& member) {
        return settings(GOOD_CAMERA + ",\n\"integrator\": {" + member + "}");
    };
    folder.expect_error(integrator("\"spp\": @0"),
                        "\"spp\": expected a whole number from 1 to 16777216, found 0");
    folder.expect_error(integrator("\"spp\": @16777217"),
                        "\"spp\": expected a whole number from 1 to 16777216, found 16777217");
    folder.expect_error(integrator("\"max_depth\": @\"infinite\""),
                        "\"max_depth\": expected a whole number or \"unlimited\", found \"infinite\"");
    folder.expect_error(integrator("\"max_depth\": @4097"),
                        "\"max_depth\": expected a whole number from 0 to 4096, found 4097");
    folder.expect_error(integrator("\"rr_depth\": @-1"),
                        "\"rr_depth\": expected a whole number from 0 to 4096, found -1");
    folder.expect_error(integrator("\"seed\": @4294967296"),
                        "\"seed\": expected a whole number from 0 to 4294967295, found 4294967296");
    folder.expect_error(integrator("\"seed\": @null"),
                        "\"seed\": expected a whole number from 0 to 4294967295, found null");
    folder.expect_error(
        integrator("\"sampler\": @\"sobel\""),
        "unknown sampler \"sobel\" (did you mean \"sobol\"? known: independent, stratified, sobol)");
    folder.expect_error(integrator("\"estimator\": @true"), "\"estimator\": expected a string, found true");
}

TEST(Scene, ChecksCameras) {
    SceneFolder folder;
    const std::string lens = "\"vertical_fov\": 40}";
    folder.expect_error(camera("{\"position\": [1, 2, 3], \"look_at\": @[1, 2, 3], " + lens),
                        "the camera looks at its own position; move one of the two");
    folder.expect_error(
        camera("{\"position\": [0, 0, 0], \"look_at\": [0, 2, 0], \"up\": @[0, -1, 0], " + lens),
        "the camera's up direction is zero or parallel to its view; give another \"up\"");
    folder.expect_error(
        camera("{\"position\": [0, 0, 0], \"look_at\": [1, 0, 0], \"up\": @[0, 0, 0], " + lens),
        "the camera's up direction is zero or parallel to its view; give another \"up\"");
    folder.expect_error(camera("@{\"position\": [0, 0, 0], \"look_at\": [0, 5, 0], " + lens),
                        "the camera's up direction is zero or parallel to its view; give another \"up\"");
    folder.expect_error(camera("{\"position\": @[0, 0], \"look_at\": [0, 5, 0], " + lens),
                        "\"position\": expected three numbers, found [0, 0]");
    folder.expect_error(camera("{\"position\": [0, @1e39, 0], \"look_at\": [0, 5, 0], " + lens),
                        "\"position\": expected a number of at most 3.4e38 in size, found 1e+39");
    folder.expect_error(settings("\"cameras\": @{}"), "the scene has no camera; add one");
}

TEST(Scene, ChecksFieldsOfView) {
    SceneFolder folder;
    const auto lens = [](const std::string& members) {
        return camera("@{\"position\": [0, 0, 1], \"look_at\": [0, 0, 0]" + members + "}");
    };
    const auto marked = [](const std::string& members) {
        return camera("{\"position\": [0, 0, 1], \"look_at\": [0, 0, 0], " + members + "}");
    };
    for (const char* angle : {"0", "180", "-20", "179.9999999"}) {
        folder.expect_error(marked("\"vertical_fov\": @" + std::string(angle)),
                            "the vertical field of view must lie between 0 and 180 degrees");
    }
    const std::string either = "a camera needs either vertical_fov, or film_size and focal_length";
    folder.expect_error(lens(""), either);
    folder.expect_error(lens(", \"film_size\": [2, 1]"), either);
    folder.expect_error(lens(", \"focal_length\": 1"), either);
    folder.expect_error(lens(", \"focal_length\": 1, \"vertical_fov\": 40"), either);
    folder.expect_error(
        marked("\"film_size\": @[1, 1], \"focal_length\": 1"),
        "the aspect ratio of film_size must be that of the film's size, 200 by 100 pixels; pixels are "
        "square");
    folder.expect_error(marked("\"film_size\": [2, @0], \"focal_length\": 1"),
                        "\"film_size\": expected a number above 0, found 0");
    folder.expect_error(marked("\"film_size\": [2, 1], \"focal_length\": @-3"),
                        "\"focal_length\": expected a number above 0, found -3");
}

TEST(Scene, ReadsFilmAndLensInAnyUnit) {
    SceneFolder folder;
    const Scene scene = folder.load(camera(
        R"({"position": [0, 0, 1], "look_at": [0, 0, 0], "film_size": [36.02, 18], "focal_length": 9})"));
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov, PI / 2);
}

TEST(Scene, ChecksSurfaces) {
    SceneFolder folder;
    const std::string box = R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1])";
    folder.expect_error(scene_of("@" + box + "}"),
                        "the shape has neither material nor emission; add one of them");
    folder.expect_error(scene_of(box + ", \"material\": \"white\", \"two_sided\": @true}"),
                        "two_sided says where emission leaves; it needs \"emission\"");
    folder.expect_error(scene_of(box + ", \"emission\": @[1, 2, -3]}"),
                        "\"emission\": expected numbers of at least 0, found [1, 2, -3]");
    folder.expect_error(scene_of(box + ", \"emission\": [1, 2, @1e39]}"),
                        "\"emission\": expected a number of at most 3.4e38 in size, found 1e+39");
    folder.expect_error(scene_of(box + ", \"emission\": 1, \"two_sided\": @1}"),
                        "\"two_sided\": expected true or false, found 1");
    folder.expect_error(scene_of(R"({"type": @"sphere", "emission": 1})"),
                        "unknown type \"sphere\" (known: quad, box, mesh, obj)");
    folder.expect_error(scene_of("@3"), "\"shapes\": expected an object { ... }, found 3");
}

TEST(Scene, ReportsAFileThatCannotBeRead) {
    SceneFolder folder;
    const std::string message = error_of([] { load_scene("no-such-scene.json"); });
    EXPECT_EQ(message, "cannot read \"no-such-scene.json\": the file does not exist; check the name");
    folder.expect_error("@", "the file is empty; a scene is a JSON object { ... }");
    folder.expect_error(std::string("@\0\1\2PNG", 7),
                        "found a byte of value 0: this is not text; a scene is JSON in UTF-8");
}

// Every damaged scene loads or throws Error; nothing else may happen.
class DamagedScene : public testing::Test {
  protected:
    // Returns whether the text is still a scene.
    bool loads(const std::string& text) {
        try {
            folder_.load(text);
            return true;
        } catch (const Error& error) {
            EXPECT_TRUE(folder_.without_folder(error.what()).starts_with("scene.json:")) << error.what();
            return false;
        }
    }

    std::string text_ = read_file(SCENES + "/cornell-box.json");

  private:
    SceneFolder folder_;
};

TEST_F(DamagedScene, IsRefusedWhereverItIsCutOff) {
    const size_t end = text_.rfind('}');
    for (size_t size = 0; size < text_.size(); ++size) {
        ASSERT_EQ(loads(text_.substr(0, size)), size > end) << "cut to " << size << " bytes";
    }
}

TEST_F(DamagedScene, LoadsOrIsRefusedAfterAnyChangeOfAByte) {
    std::mt19937 random(1);
    const std::string likely = "{}[],:\"\\/*-.e0129 \n\xFF\xC3";
    size_t refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string text = text_;
        text[random() % text.size()] = i % 4 == 0 ? char(random()) : likely[random() % likely.size()];
        refused += loads(text) ? 0u : 1u;
    }
    EXPECT_GT(refused, 500u);
}

}  // namespace
}  // namespace candela
