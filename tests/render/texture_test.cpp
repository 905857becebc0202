// Textures in whole pictures: estimators agree, lamps light as their texture says, normal maps lose nothing.
#include "estimator_fixture.h"

namespace candela {
namespace {

class TexturedTest : public EstimatorTest {
  protected:
    static Textured<vec3> times(vec3 factor, const Texture& texture) { return {factor, texture}; }
};

TEST_F(TexturedTest, EstimatorsAgree) {
    expect_estimators_agree(textured_scene(), 768, 1536);
}

// A lamp whose texture has two halves is two lamps.
TEST_F(TexturedTest, ALampOfTwoColoursIsTwoLamps) {
    const auto room = [](const std::function<void(Scene&, uint32_t)>& add_lamps) {
        Scene scene = open_room();
        add_lamps(scene, add_diffuse(scene, vec3(0)));
        return scene;
    };
    const vec3 left(5, 1, 0.5f), right(0.25f, 2, 6);
    const Scene one = room([&](Scene& scene, uint32_t black) {
        Texture texture =
            add_texture(scene, {2, 1}, [&](uint32_t x, uint32_t) { return vec4(x == 0 ? left : right, 1); });
        texture.filter = TextureFilter::nearest;
        add_shape(scene, parallelogram(vec3(-0.5f, 1.5f, -0.2f), vec3(1, 0, 0), vec3(0, 0, 0.4f)), black,
                  Emission{{vec3(2), texture}, false});
    });
    const Scene two = room([&](Scene& scene, uint32_t black) {
        for (const bool second : {false, true}) {
            add_shape(
                scene,
                parallelogram(vec3(second ? 0 : -0.5f, 1.5f, -0.2f), vec3(0.5f, 0, 0), vec3(0, 0, 0.4f)),
                black, Emission{2.0f * (second ? right : left), false});
        }
    });
    for (const Estimator estimator : {Estimator::light, Estimator::mis}) {
        SCOPED_TRACE(int(estimator));
        expect_same_expectation(image(one, settings(estimator, 1), 1280),
                                image(two, settings(estimator, 2), 1280));
    }
}

// Coordinates that turn back at the diagonal stay in the red half of the image; those of the first triangle,
// continued over the second, reach the blue one.
TEST_F(TexturedTest, EachTriangleOfALampHasItsCoordinates) {
    const vec3 red(5, 1, 0.5f), blue(0.25f, 2, 6);
    const auto room = [&](bool textured) {
        Scene scene = open_room();
        Emission emission{red, false};
        if (textured) {
            Texture texture = add_texture(scene, {2, 1},
                                          [&](uint32_t x, uint32_t) { return vec4(x == 0 ? red : blue, 1); });
            texture.filter = TextureFilter::nearest;
            emission.radiance = {vec3(1), texture};
        }
        Quad lamp = parallelogram(vec3(-0.5f, 1.5f, -0.2f), vec3(1, 0, 0), vec3(0, 0, 0.4f));
        for (const size_t corner : {0u, 1u, 2u, 3u})
            lamp.uvs[corner] = vec2(corner % 2 == 0 ? 0.45f : 0.1f, 0.5f);
        add_shape(scene, lamp, add_diffuse(scene, vec3(0)), emission);
        return scene;
    };
    expect_same_expectation(image(room(true), settings(Estimator::light, 1), 640),
                            image(room(false), settings(Estimator::light, 2), 640));
}

// Colours of vertices and of textures with one texel are those of plain materials, bit for bit where they are
// powers of two.
TEST_F(TexturedTest, ATextureOfOneColourIsThatColour) {
    const vec3 color(0.5f, 0.25f, 0.125f);
    const auto scene_with = [&](bool textured) {
        Scene scene = open_room();
        Textured<vec3> reflectance = color;
        Textured<float> alpha = 0.25f;
        Textured<vec3> radiance = 4.0f * color;
        if (textured) {
            const Texture texture =
                add_texture(scene, {3, 2}, [&](uint32_t, uint32_t) { return vec4(color, 1); });
            reflectance = times(vec3(1), texture);
            alpha = {0.5f, texture};
            radiance = times(vec3(4), texture);
        }
        add_shape(scene, Sphere{dvec3(-0.4, 0.4, 0), 0.4}, add_material(scene, DiffuseMaterial{reflectance}));
        add_shape(scene, Sphere{dvec3(0.5, 0.4, 0), 0.4},
                  add_material(scene, ConductorMaterial{reflectance, alpha}));
        add_shape(scene, parallelogram(vec3(-0.5f, 1.5f, -0.2f), vec3(1, 0, 0), vec3(0, 0, 0.4f)),
                  add_diffuse(scene, vec3(0)), Emission{radiance, false});
        return scene;
    };
    const Image plain = image(scene_with(false), settings(Estimator::mis, 1), 64);
    const Image textured = image(scene_with(true), settings(Estimator::mis, 1), 64);
    for (size_t c = 0; c < 3; ++c) {
        const auto a = plane(plain, "", c), b = plane(textured, "", c);
        // The kernels differ, and may round differently.
        for (size_t i = 0; i < a.size(); ++i)
            ASSERT_NEAR(a[i], b[i], 1e-5f * a[i]);
    }
}

class NormalMapTest : public TexturedTest {
  protected:
    // A unit sphere with a strong normal or bump map, seen against a sky of radiance 1.
    static Scene bumpy_sphere(const decltype(Material::model)& model, bool heights) {
        Scene scene = scene_with_camera(dvec3(1, 2, 4.5), dvec3(0), 0.4f);
        scene.environment = constant_environment(vec3(1));
        const Texture map = add_texture(scene, {32, 16}, [](uint32_t x, uint32_t y) {
            const float turn = float(M_PI) / 4.0f;
            const vec3 n =
                normalize(vec3(2.0f * std::sin(turn * float(x)), 2.0f * std::cos(turn * float(y)), 1));
            return vec4(0.5f * n + 0.5f, 1);
        });
        const uint32_t material = add_material(scene, model);
        if (heights) {
            scene.materials[material].bump_map = BumpMap{map, 1.0f};  // A slope of 1 and more.
        } else {
            scene.materials[material].normal_map = NormalMap{map, 1.0f};
        }
        add_shape(scene, Sphere{}, material);
        return scene;
    }
};

// What is mirrored at the surface is not lost: every sample is 1.
TEST_F(NormalMapTest, WhiteBodiesStayInvisible) {
    for (const Estimator estimator : {Estimator::bsdf, Estimator::light, Estimator::mis}) {
        for (const decltype(Material::model)& model :
             {decltype(Material::model)(DiffuseMaterial{vec3(1)}),
              decltype(Material::model)(MirrorMaterial{vec3(1)}),
              decltype(Material::model)(DiffuseTransmissionMaterial{vec3(0.5f), vec3(0.5f), {}})}) {
            for (const bool heights : {false, true}) {
                SCOPED_TRACE(testing::Message() << int(estimator) << ' ' << model.index() << ' ' << heights);
                RenderSettings s = independent_settings(32, estimator, 5);
                s.rr_depth = DEPTH_SAFETY_LIMIT;
                const Image picture = image_of(render(bumpy_sphere(model, heights), s, 16));
                for (size_t c = 0; c < 3; ++c) {
                    for (const float value : plane(picture, "", c))
                        ASSERT_NEAR(value, 1.0f, 0x1p-16);
                }
            }
        }
    }
}

// The coat has another horizon than what it lies on, whichever of the two has the map.
TEST_F(NormalMapTest, WhiteBodiesStayInvisibleUnderACoat) {
    for (const float roughness : {0.0f, 0.5f}) {
        for (const bool on_coat : {false, true}) {
            for (const Estimator estimator : {Estimator::bsdf, Estimator::mis}) {
                SCOPED_TRACE(testing::Message() << roughness << ' ' << on_coat << ' ' << int(estimator));
                Scene scene = bumpy_sphere(PrincipledMaterial{.base_color = vec3(1),
                                                              .specular = 0.0f,
                                                              .coat = 1.0f,
                                                              .coat_roughness = roughness,
                                                              .coat_ior = 2.0f},
                                           false);
                Material& material = scene.materials.back();
                if (on_coat)
                    std::swap(material.normal_map,
                              std::get<PrincipledMaterial>(material.model).coat_normal_map);
                RenderSettings s = independent_settings(32, estimator, 5);
                s.rr_depth = DEPTH_SAFETY_LIMIT;
                expect_mean(image_of(render(scene, s, samples(512))), glm::dvec3(1.0), 0x1p-15);
            }
        }
    }
}

// Light and BSDF samples see the same surface, with lobes that the map turns below the horizon.
TEST_F(NormalMapTest, EstimatorsAgree) {
    for (const decltype(Material::model)& model :
         {decltype(Material::model)(PhongMaterial{vec3(0.3f), vec3(0.6f), 8.0f}),
          decltype(Material::model)(ConductorMaterial{vec3(0.9f), 0.4f}),
          decltype(Material::model)(DiffuseTransmissionMaterial{vec3(0.5f), vec3(0.3f), {}})}) {
        SCOPED_TRACE(model.index());
        Scene scene = bumpy_sphere(model, false);
        scene.environment.reset();
        const uint32_t black = add_diffuse(scene, vec3(0));
        add_shape(scene, Sphere{dvec3(3, 2, 3), 1.2}, black, Emission{vec3(3, 2, 1), false});
        add_shape(scene, Sphere{dvec3(-3, 0, 0), 1.5}, black, Emission{vec3(1, 2, 3), false});
        expect_estimators_agree(scene, 2048, 1152);
    }
}

// A map that says "straight up" everywhere changes nothing.
TEST_F(NormalMapTest, AFlatMapChangesNothing) {
    const auto scene_with = [](bool mapped) {
        Scene scene = open_room();
        const Texture flat =
            add_texture(scene, {1, 1}, [](uint32_t, uint32_t) { return vec4(0.5f, 0.5f, 1, 1); });
        const uint32_t material = add_material(scene, PhongMaterial{vec3(0.3f), vec3(0.5f), 30.0f});
        if (mapped) scene.materials[material].normal_map = NormalMap{flat, 1.0f};
        add_shape(scene, Sphere{dvec3(0, 0.5, 0), 0.5}, material);
        add_shape(scene, parallelogram(vec3(-0.5f, 1.5f, -0.2f), vec3(1, 0, 0), vec3(0, 0, 0.4f)),
                  add_diffuse(scene, vec3(0)), Emission{vec3(5), false});
        return scene;
    };
    expect_same_expectation(image(scene_with(false), settings(Estimator::mis, 1), 1024),
                            image(scene_with(true), settings(Estimator::mis, 2), 1024));
}

}  // namespace
}  // namespace candela
