// Scene files: what a good one means, and what the loader says of each kind of bad one, with the place.
#include "scene/scene.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

#include "base/file.h"
#include "scene/geometry.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

const std::string SCENES = CANDELA_SCENES;

void expect_near(dvec3 actual, dvec3 expected, double tolerance) {
    EXPECT_LE(length(actual - expected), tolerance)
        << actual.x << ", " << actual.y << ", " << actual.z << " instead of " << expected.x << ", "
        << expected.y << ", " << expected.z;
}

TEST(Scene, CornellBoxHasThePublishedFigures) {
    const Scene scene = load_scene(SCENES + "/cornell-box.json");
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "main");
    EXPECT_NEAR(glm::degrees(scene.cameras[0].vertical_fov), 39.3077f, 1e-4f);
    EXPECT_EQ(scene.cameras[0].position, dvec3(0.278, 0.273, -0.8));
    EXPECT_EQ(scene.film.size, uvec2(512, 512));
    EXPECT_EQ(scene.integrator.spp, 256u);
    EXPECT_FALSE(scene.integrator.max_depth.has_value());
    EXPECT_EQ(triangle_count(scene), 32u);
    EXPECT_EQ(emitter_count(scene), 1u);
    const DoubleBox box = bounds(scene);
    EXPECT_EQ(box.lo, dvec3(0));
    EXPECT_EQ(vec3(box.hi), vec3(0.556f, 0.5488f, 0.5592f));
}

TEST(Scene, CornellBoxLightShinesDownAndIsBlack) {
    const Scene scene = load_scene(SCENES + "/cornell-box.json");
    const Shape& light = scene.shapes[0];
    ASSERT_TRUE(light.emission.has_value());
    EXPECT_EQ(light.emission->radiance, vec3(17, 12, 4));
    EXPECT_FALSE(light.emission->two_sided);
    const auto& c = std::get<Quad>(light.geometry).corners;
    expect_near(normalize(cross(c[1] - c[0], c[2] - c[0])), dvec3(0, -1, 0), 1e-6);
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
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance == nullptr) continue;
        const TriangleMesh mesh = placed(scene.meshes[instance->mesh], instance->transform);
        double volume = 0.0;
        for (const uvec3 t : mesh.triangles) {
            const vec3 a = mesh.positions[t.x];
            const vec3 n = cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
            volume += dot(a, n);
            for (glm::length_t i = 0; i < 3 && !mesh.normals.empty(); ++i) {
                ASSERT_GT(dot(n, mesh.normals[t[i]]), 0.0f);
                ASSERT_NEAR(length(mesh.normals[t[i]]), 1.0f, 1e-6f);
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
        "max_depth": 0, "rr_depth": 4096, "estimator": "light", "sampler": "stratified", "light_sampler": "power",
        "terminator": "flat", "clamp_indirect": 2.5, "seed": 4294967295})"));
    EXPECT_EQ(scene.integrator.spp, 1u << 24);
    EXPECT_EQ(scene.integrator.max_depth, 0u);
    EXPECT_EQ(scene.integrator.rr_depth, 4096u);
    EXPECT_EQ(scene.integrator.light_sampler, LightSampler::power);
    EXPECT_EQ(scene.integrator.terminator, Terminator::flat);
    EXPECT_EQ(scene.integrator.estimator, Estimator::light);
    EXPECT_EQ(scene.integrator.sampler, SamplerKind::stratified);
    EXPECT_EQ(scene.integrator.seed, 0xFFFFFFFFu);
    EXPECT_EQ(scene.integrator.clamp_indirect, 2.5f);
    EXPECT_FALSE(folder.load(settings(GOOD_CAMERA)).integrator.clamp_indirect);
    for (const char* limit : {"0", "-1"}) {
        folder.expect_error(settings(GOOD_CAMERA + ", \"integrator\": {\"clamp_indirect\": @" + limit + "}"),
                            "\"clamp_indirect\": expected a number above 0, found " + std::string(limit));
    }
}

TEST(Scene, ReadsTheFilterOfItsFilm) {
    SceneFolder folder;
    const auto film = [](const std::string& members) {
        return settings(GOOD_CAMERA + ", \"film\": {\"size\": [4, 4]" + members + "}");
    };
    const auto filter = [&](const std::string& members) { return folder.load(film(members)).film.filter; };
    EXPECT_EQ(filter(""), (PixelFilter{FilterShape::box, 1.0f}));
    EXPECT_EQ(filter(R"(, "filter": "box")"), (PixelFilter{FilterShape::box, 1.0f}));
    EXPECT_EQ(filter(R"(, "filter": "tent")"), (PixelFilter{FilterShape::tent, 2.0f}));
    EXPECT_EQ(filter(R"(, "filter": "gaussian")"), (PixelFilter{FilterShape::gaussian, 3.0f}));
    EXPECT_EQ(filter(R"(, "filter": "blackman-harris", "filter_width": 10)"),
              (PixelFilter{FilterShape::blackman_harris, 10.0f}));
    folder.expect_error(film(", \"filter\": @\"sinc\""),
                        "unknown filter \"sinc\" (known: box, tent, gaussian, blackman-harris)");
    for (const char* width : {"0", "100"}) {
        folder.expect_error(
            film(R"(, "filter": "tent", "filter_width": @)" + std::string(width)),
            "\"filter_width\": expected a number from 0.01 to 10, found " + std::string(width));
    }
    folder.expect_error(film(", \"filter_width\": @2"),
                        "filter_width is the width of a filter; add \"filter\"");
}

TEST(Scene, WarnsOfWhatIsOddButUsable) {
    SceneFolder folder;
    folder.expect_warning("{" + GOOD_CAMERA + ", \"shapes\": @[]}", "the scene has no shapes");
    folder.expect_warning(scene_of(R"({"type": "sphere", "material": "white"})", '@'),
                          "the scene has no light: the image will be black");
    folder.expect_warning(scene_of(R"(@{"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                                       "triangles": [[0, 1, 2], [1, 1, 2], [0, 2, 2]], "emission": 1})"),
                          "left out 2 triangles without area");
}

TEST(Scene, SaysWhichKeysItKnows) {
    SceneFolder folder;
    folder.expect_error(
        "{" + GOOD_CAMERA + ",\n\"shapes\": [], @\"light\": []}",
        "unknown key \"light\" (did you mean \"lights\"? known: $schema, scene, cameras, film, integrator, "
        "materials, objects, shapes, lights, environment, sky, medium)");
    folder.expect_error(
        settings(R"("cameras": {"m": {"position": [0, 0, 1], "look_at": [0, 0, 0], @"vertcal_fov": 40}})"),
        "unknown key \"vertcal_fov\" (did you mean \"vertical_fov\"? known: position, look_at, up, "
        "vertical_fov, film_size, focal_length, principal_point, shift, orthographic_height, projection, "
        "fisheye_fov, lens)");
    folder.expect_error(
        scene_of(R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1], @"colour": "white"})"),
        "unknown key \"colour\" (known: type, min, max, name, material, emission, two_sided, spread, "
        "shadow_catcher, visible_to_camera, transform)");
    folder.expect_error("@{\"shapes\": []}", "the key \"cameras\" is missing here; add it");
    folder.expect_error("@[]", "the scene: expected an object { ... }, found []");
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

TEST(Scene, ReportsAFileThatCannotBeRead) {
    SceneFolder folder;
    const std::string message = error_of([] { load_scene("no-such-scene.json"); });
    EXPECT_EQ(message, "cannot read \"no-such-scene.json\": the file does not exist; check the name");
    folder.expect_error("@", "the file is empty; a scene is a JSON object { ... }");
    folder.expect_error(std::string("@\0\1\2PNG", 7),
                        "found a byte of value 0: this is not text; a scene is JSON in UTF-8");
}

// A scene with what the Cornell box lacks.
const std::string ROUND_SCENE = R"({
"cameras": {"main": {"position": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40,
    "lens": {"radius": 0.1, "focal_distance": 5, "blades": 6, "rotation": 30}}},
"materials": {
    "lacquer": {"type": "phong", "diffuse": 0.5, "specular": [0.5, 0.1, 0.2], "exponent": 90},
    "silver": {"type": "mirror", "reflectance": 0.9},
    "gold": {"type": "conductor", "reflectance": [1, 0.8, 0.3], "alpha": 0.1},
    "glass": {"type": "dielectric", "ior": 1.5, "exterior_ior": 1.3, "fresnel": "exact",
        "absorption": {"transmittance": [0.5, 1, 0.9], "distance": 0.1}}},
"shapes": [
    {"type": "sphere", "center": [1, 2, 3], "radius": 0.5, "material": "glass",
        "transform": [{"scale": -2}, {"rotate": 40, "axis": [1, 2, 3]}]},
    {"type": "disk", "center": [0, -1, 0], "normal": [0, 1, 0], "radius": 9, "material": "gold",
        "transform": [{"matrix": [1, 0.5, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1]}]},
    {"type": "sphere", "emission": [1, 2, 3], "two_sided": true}],
"environment": {"radiance": [0.1, 0.2, 0.5], "intensity": 2, "visible": false}
})";

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

    const std::array<std::string, 2> texts_{read_file(SCENES + "/cornell-box.json"), ROUND_SCENE};

  private:
    SceneFolder folder_;
};

TEST_F(DamagedScene, IsRefusedWhereverItIsCutOff) {
    for (const std::string& text : texts_) {
        const size_t end = text.rfind('}');
        for (size_t size = 0; size < text.size(); ++size) {
            ASSERT_EQ(loads(text.substr(0, size)), size > end) << "cut to " << size << " bytes: " << text;
        }
        EXPECT_TRUE(loads(text));
    }
}

TEST_F(DamagedScene, LoadsOrIsRefusedAfterAnyChangeOfAByte) {
    std::mt19937 random(1);
    const std::string likely = "{}[],:\"\\/*-.e0129 \n\xFF\xC3";
    for (const std::string& text : texts_) {
        size_t refused = 0;
        for (int i = 0; i < 2000; ++i) {
            std::string damaged = text;
            damaged[random() % text.size()] = i % 4 == 0 ? char(random()) : likely[random() % likely.size()];
            refused += loads(damaged) ? 0u : 1u;
        }
        EXPECT_GT(refused, 500u) << text;
    }
}

TEST(Scene, AMediumFillsTheSpaceAroundAndHidesSkyAndSuns) {
    const auto scene = [](const std::string& more) {
        return "{" + GOOD_CAMERA +
               ",\n\"shapes\": [], \"medium\": @{\"scattering\": {\"coefficient\": 2, \"g\": 0.5}}" + more +
               "}";
    };
    SceneFolder folder;
    const std::string hidden =
        "the medium has no end, so that no light of the sky or of suns comes through it; give it to an "
        "\"interface\" around the scene instead";
    folder.expect_warning(scene(R"(, "environment": {"radiance": 1})"), hidden);
    std::string lit = scene(R"(, "lights": [{"type": "point", "position": [0, 1, 0], "intensity": 1}])");
    lit.erase(lit.find('@'), 1);
    const Scene haze = folder.load(lit);
    EXPECT_EQ(haze.medium, (Medium{vec3(0), vec3(2), 0.5f}));
    for (const std::string& warning : haze.warnings)
        EXPECT_EQ(warning.find(hidden), std::string::npos);
    folder.expect_error("{" + GOOD_CAMERA + ",\n\"shapes\": [], \"medium\": @{}}",
                        R"(the medium is empty; add "absorption" or "scattering")");
}

}  // namespace
}  // namespace candela
