// The values by default that scene_keys.inc states, and so the schema and the page of scene files, are those
// of a scene that states none.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "base/text.h"
#include "load/json/keys.h"
#include "scene/names.h"

namespace candela {
namespace {

// What the table says, but for the quotation marks of a word.
std::string stated(std::string_view object, std::string_view name) {
    for (const SceneKey& key : SCENE_KEYS) {
        if (key.object != object || key.name != name) continue;
        std::string text(key.initial);
        std::erase(text, '"');
        return text;
    }
    return "no such key";
}

std::string text_of(float number) {
    return number_text(double(number), 6);
}

TEST(SceneKeys, NoKeyHasTwoLines) {
    for (const SceneKey& key : SCENE_KEYS) {
        const auto same = [&](const SceneKey& other) {
            return other.object == key.object && other.name == key.name;
        };
        EXPECT_EQ(std::ranges::count_if(SCENE_KEYS, same), 1) << key.object << ' ' << key.name;
    }
}

TEST(SceneKeys, DefaultsAreThoseOfTheScene) {
    const IntegratorSettings s;
    EXPECT_EQ(stated("integrator", "spp"), std::to_string(s.spp));
    EXPECT_EQ(stated("integrator", "max_depth"), s.max_depth ? "a number" : "unlimited");
    EXPECT_EQ(stated("integrator", "rr_depth"), std::to_string(s.rr_depth));
    EXPECT_EQ(stated("integrator", "estimator"), name_of(s.estimator, ESTIMATOR_NAMES));
    EXPECT_EQ(stated("integrator", "sampler"), name_of(s.sampler, SAMPLER_NAMES));
    EXPECT_EQ(stated("integrator", "terminator"), name_of(s.terminator, TERMINATOR_NAMES));
    EXPECT_EQ(stated("integrator", "seed"), std::to_string(s.seed));
    const Film film;
    EXPECT_EQ(stated("scene", "film"), concat(film.size.x, "×", film.size.y, " pixels"));
    const Camera camera;
    EXPECT_EQ(stated("camera", "up"),
              concat('[', text_of(camera.up.x), ", ", text_of(camera.up.y), ", ", text_of(camera.up.z), ']'));
    EXPECT_EQ(stated("lens", "rotation"), text_of(camera.lens.rotation));
    EXPECT_EQ(stated("phong", "diffuse"), text_of(PhongMaterial().diffuse.factor.x));
    EXPECT_EQ(stated("mirror", "reflectance"), text_of(MirrorMaterial().reflectance.factor.x));
    const DielectricMaterial dielectric;
    EXPECT_EQ(stated("dielectric", "fresnel"), name_of(dielectric.fresnel, FRESNEL_NAMES));
    EXPECT_EQ(stated("dielectric", "priority"), std::to_string(dielectric.priority));
    EXPECT_EQ(stated("rough_dielectric", "priority"), std::to_string(PrincipledMaterial().priority));
    EXPECT_EQ(stated("material", "opacity"), text_of(Opacity().value.factor));
    EXPECT_EQ(stated("normal_map", "scale"), text_of(NormalMap().scale));
    const Texture texture;
    EXPECT_EQ(stated("texture", "filter"), name_of(texture.filter, FILTER_NAMES));
    EXPECT_EQ(stated("texture", "wrap"), name_of(texture.wrap_u, WRAP_NAMES));
    EXPECT_EQ(stated("texture", "uv_set"), std::to_string(texture.uv_set));
    const Cone cone;
    EXPECT_EQ(stated("spot", "inner_angle"), text_of(glm::degrees(cone.inner_angle)));
    EXPECT_EQ(stated("spot", "outer_angle"), text_of(glm::degrees(cone.outer_angle)));
    EXPECT_EQ(stated("spot", "falloff"), name_of(cone.falloff, FALLOFF_NAMES));
    EXPECT_EQ(stated("directional", "angle"), text_of(DirectionalLight{}.angle));
    const Environment sky;
    EXPECT_EQ(stated("environment", "rotation"), text_of(sky.rotation));
    EXPECT_EQ(stated("environment", "visible"), sky.visible ? "true" : "false");
    const Sky clear;
    EXPECT_EQ(stated("sky", "sun_azimuth"), number_text(clear.sun_azimuth, 6));
    EXPECT_EQ(stated("sky", "turbidity"), number_text(clear.turbidity, 6));
    EXPECT_EQ(stated("sky", "ground"), text_of(clear.ground.x));
}

}  // namespace
}  // namespace candela
