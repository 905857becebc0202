// No reference point and no random number makes a light sample that is not finite, negative, or not a
// direction.
#include <cmath>

#include "gpu/light_fixture.h"
#include "probe/random.h"
#include "selftest/skies.h"

namespace candela {
namespace {

bool is_sound(vec3 v) {
    return is_finite(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f;
}

// Whether a sample is valid from which light may arrive.
bool is_sound(const LightSample& s) {
    const bool unit = std::abs(length(glm::dvec3(s.wi)) - 1.0) <= 0x1p-20;
    return unit && is_sound(s.Li) && is_finite(vec3(s.pdf)) && s.pdf > 0.0f && is_finite(s.shadow) &&
           s.t_max > 0.0f;
}

class LightRobustnessTest : public LightTest {
  protected:
    LightRobustnessTest() : random_(250) {}

    // A size from 10^-6 to 10^6.
    float size() { return std::pow(10.0f, 12.0f * random_.unit() - 6.0f); }
    // With a corner or centre p, and edges or half axes.
    static void add_lamp(Scene& scene, uint32_t kind, vec3 p, vec3 e1, vec3 e2, const Emission& emission) {
        TriangleMesh triangle;
        switch (kind) {
            case 0:
                return add_shape(scene, parallelogram(p, e1, e2), 0, emission);
            case 1:
                add_triangle(triangle, p, p + e1, p + e2);
                return add_shape(scene, std::move(triangle), 0, emission);
            case 2:
                return add_shape(scene, Disk{dvec3(p), dvec3(e1), dvec3(e2)}, 0, emission);
            case 3:
                return add_shape(scene, Sphere{dvec3(p), length(e1)}, 0, emission);
            default:
                return add_punctual(scene, kind, p, e1, emission.radiance.factor);
        }
    }
    // At p, or in the direction e1; a spot is as narrow as that is short.
    static void add_punctual(Scene& scene, uint32_t kind, vec3 p, vec3 e1, vec3 intensity) {
        const float angle = std::min(length(e1), 1.5f);
        switch (kind) {
            case 4:
                scene.lights = {{"", PointLight{dvec3(p), intensity}}};
                break;
            case 5:
                scene.lights = {{"", SpotLight{dvec3(p), dvec3(e1), intensity, {0.999f * angle, angle}}}};
                break;
            default:
                add_shape(scene, Sphere{dvec3(p), 1.0}, 0);
                scene.lights = {{"", DirectionalLight{dvec3(e1), intensity}}};
        }
    }
    // At the light's own points, a rounding beside them, in its plane, at its centre, or anywhere.
    vec3 reference(vec3 p, vec3 e1, vec3 e2) {
        const vec3 on = p + random_.unit() * e1 + random_.unit() * e2;
        switch (random_.bits() % 5) {
            case 0:
                return p;
            case 1:
                return on;
            case 2:
                return on + 1e-6f * size() * random_.direction();
            case 3:
                return p - size() * e1;
            default:
                return on + size() * random_.direction();
        }
    }

    // In [0, 2^32), often one of the ends.
    uint32_t bits() {
        const uint32_t choice = random_.bits() % 6;
        return choice == 0 ? 0u : choice == 1 ? 0xFFFFFFFFu : random_.bits();
    }
    // Many points from which to look at a light with that corner or centre and those edges.
    std::vector<LightItem> items(vec3 p, vec3 e1, vec3 e2) {
        std::vector<LightItem> items(3000);
        for (LightItem& item : items) {
            item.from = reference(p, e1, e2);
            item.choice = bits();
            item.u.x = bits();
            item.u.y = bits();
        }
        return items;
    }

    Random random_;
};

TEST_F(LightRobustnessTest, NoPlaceMakesAnUnsoundSample) {
    size_t arriving = 0, samples = 0;
    for (int light = 0; light < 70; ++light) {
        const vec3 p = size() * random_.cube(), e1 = size() * random_.direction(),
                   e2 = size() * random_.direction();
        Scene scene = scene_of_mesh({});
        scene.shapes.clear();
        const float power = size() * size();
        add_lamp(scene, uint32_t(light) % 7, p, e1, e2, Emission{power * vec3(1, 0.5f, 0), light % 3 == 0});
        const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
        if (gpu.light_count == 0) continue;  // Flat, when its corners are rounded.
        const std::vector<LightItem> from = items(p, e1, e2);
        const std::vector<LightSample> results = sample(gpu, from);
        for (size_t i = 0; i < results.size(); ++i) {
            const LightSample& s = results[i];
            ++samples;
            if (s.pdf == 0.0f) continue;
            ++arriving;
            EXPECT_TRUE(is_sound(s)) << "kind " << light % 7 << ", p " << p.x << ' ' << p.y << ' ' << p.z
                                     << ", e1 " << e1.x << ' ' << e1.y << ' ' << e1.z << ", e2 " << e2.x
                                     << ' ' << e2.y << ' ' << e2.z << ", from " << from[i].from.x << ' '
                                     << from[i].from.y << ' ' << from[i].from.z << ", u " << from[i].u.x
                                     << ' ' << from[i].u.y << "; wi " << s.wi.x << ' ' << s.wi.y << ' '
                                     << s.wi.z << ", Li " << s.Li.x << ", pdf " << s.pdf << ", shadow "
                                     << s.shadow.x << ' ' << s.shadow.y << ' ' << s.shadow.z;
        }
    }
    EXPECT_GT(arriving, samples / 2);
}

}  // namespace
}  // namespace candela
