// The principled material on the device against its reference in double precision, which is written apart
// from the shaders and integrates where they measure.
#include "shared/principled.h"

#include <utility>

#include "gpu/bsdf_fixture.h"
#include "gpu_scene/material_record.h"
#include "support/principled_reference.h"

namespace candela {
namespace {

// Floats and their roundings: some forty operations; where alpha is small, D has the eighth power of them.
// Beyond that, pairs of directions far from a narrow lobe are ignored.
constexpr double ROUNDING = 1e-4;

// What sheen leaves to the layers below is a fit: bsdf/sheen_albedo.glsl.
constexpr double SHEEN_FIT = 0.002;

PrincipledParameters parameters_of(const PrincipledMaterial& m, bool inside) {
    return {.base_color = dvec3(m.base_color.factor),
            .metalness = double(m.metalness.factor),
            .roughness = double(m.roughness.factor),
            .diffuse_roughness = double(m.diffuse_roughness.factor),
            .ior = double(m.ior),
            .specular = double(m.specular.factor),
            .specular_color = dvec3(m.specular_color.factor),
            .anisotropy = double(m.anisotropy.factor),
            .transmission = double(m.transmission.factor),
            .thin = !interior(m),
            .inside = inside,
            .dispersion = double(m.dispersion),
            .diffuse_transmission = double(m.diffuse_transmission.factor),
            .diffuse_transmission_color = dvec3(m.diffuse_transmission_color.factor),
            .coat = double(m.coat.factor),
            .coat_roughness = double(m.coat_roughness.factor),
            .coat_ior = double(m.coat_ior),
            .coat_darkening = double(m.coat_darkening),
            .sheen_color = dvec3(m.sheen_color.factor),
            .sheen_roughness = double(m.sheen_roughness.factor),
            .fuzz = double(m.fuzz.factor),
            .fuzz_color = dvec3(m.fuzz_color.factor),
            .fuzz_roughness = double(m.fuzz_roughness.factor),
            .iridescence = double(m.iridescence.factor),
            .iridescence_ior = double(m.iridescence_ior),
            .iridescence_thickness = double(m.iridescence_thickness.factor)};
}

// A pair of directions, and the mean of the value over the facets that are measured there.
struct Mean {
    dvec3 value{0};
    dvec3 error{0};  // Standard error.
};

class PrincipledTest : public BsdfTest {
  protected:
    // Each of `pairs` seen by as many choices of facets.
    std::vector<Mean> means(const PrincipledMaterial& m, const std::vector<std::pair<vec3, vec3>>& pairs,
                            bool inside, uint32_t choices) const {
        std::vector<BsdfItem> items;
        for (const auto& [wo, wi] : pairs) {
            for (uint32_t i = 0; i < choices; ++i) {
                items.push_back(bsdf_item(principled(m), wo, wi, inside ? 1 : 0));
                items.back().random = i;
            }
        }
        const std::vector<BsdfResult> results = run(items);
        std::vector<Mean> means;
        for (size_t p = 0; p < pairs.size(); ++p) {
            dvec3 sum(0), squares(0);
            for (uint32_t i = 0; i < choices; ++i) {
                const dvec3 f(results[p * choices + i].f);
                sum += f, squares += f * f;
            }
            const double n = choices;
            const dvec3 variance = max((squares / n - sum * sum / (n * n)) / (n - 1.0), dvec3(0));
            means.push_back({sum / n, sqrt(variance)});
        }
        return means;
    }
    // Random pairs over the sphere, and near the mirrored and the straight direction.
    static std::vector<std::pair<vec3, vec3>> pairs(Random& random, size_t count) {
        std::vector<std::pair<vec3, vec3>> result;
        while (result.size() < count) {
            vec3 wo = random.direction(), wi = random.direction();
            wo.z = std::abs(wo.z);
            const vec3 lobe = result.size() % 3 == 0 ? vec3(-wo.x, -wo.y, wo.z) : -wo;
            if (result.size() % 3 != 2) wi = normalize(lobe + 0.5f * wi);
            if (wo.z > 0.02f && std::abs(wi.z) > 0.02f) result.emplace_back(wo, wi);
        }
        return result;
    }
    // The three pairs of corners of each of 500 random triangles of directions above the surface, each both
    // ways, one after the other.
    static std::vector<BsdfItem> triangles(const PrincipledMaterial& m, uint32_t back) {
        Random random(12);
        const auto above = [&] {
            const vec3 w = random.direction();
            return vec3(w.x, w.y, std::abs(w.z));
        };
        std::vector<BsdfItem> items;
        for (int i = 0; i < 500; ++i) {
            const vec3 corners[] = {above(), above(), above()};
            for (int k = 0; k < 3; ++k) {
                const vec3 a = corners[k], b = corners[(k + 1) % 3];
                items.push_back(bsdf_item(principled(m), a, b, back));
                items.push_back(bsdf_item(principled(m), b, a, back));
            }
        }
        return items;
    }
    // The device's values must be those of the reference, within rounding and the noise of facets.
    void expect_reference(const std::string& name, const PrincipledMaterial& m, bool inside,
                          uint32_t seed) const {
        Random random(seed);
        const auto at = pairs(random, 12);
        const std::vector<Mean> found = means(m, at, inside, 256);
        const PrincipledParameters parameters = parameters_of(m, inside);
        PrincipledParameters bare = parameters;
        bare.sheen_color = dvec3(0);
        const bool sheen = parameters.sheen_color != dvec3(0);
        for (size_t i = 0; i < at.size(); ++i) {
            const dvec3 wo = normalize(dvec3(at[i].first)), wi = normalize(dvec3(at[i].second));
            const dvec3 expected = PrincipledReference(parameters, wo).f(wi);
            const dvec3 under_sheen = sheen ? PrincipledReference(bare, wo).f(wi) : dvec3(0);
            for (int c = 0; c < 3; ++c) {
                // Six standard errors of each of some thousand numbers.
                const double tolerance =
                    ROUNDING * (expected[c] + 0.01) + SHEEN_FIT * under_sheen[c] + 6.0 * found[i].error[c];
                ASSERT_NEAR(found[i].value[c], expected[c], tolerance)
                    << name << ", channel " << c << ", wo " << wo.x << ' ' << wo.y << ' ' << wo.z << ", wi "
                    << wi.x << ' ' << wi.y << ' ' << wi.z;
            }
        }
    }
};

// Random materials of all layers: the seed decides which of them there are.
PrincipledMaterial random_material(Random& random) {
    const auto fraction = [&]() { return random.bits() % 3 == 0 ? 0.0f : random.unit(); };
    const auto color = [&]() { return vec3{random.unit(), random.unit(), random.unit()}; };
    const auto tint = [&]() {
        const float strength = fraction();
        return strength * color();
    };
    const bool prism = random.bits() % 4 == 0;
    PrincipledMaterial m{
        .base_color = color(),
        .metalness = fraction(),
        .roughness = 0.15f + 0.85f * random.unit(),
        .diffuse_roughness = fraction(),
        .ior = 1.1f + random.unit(),
        .specular = 1.0f - fraction(),
        .specular_color = vec3(1.0f) - tint(),
        .anisotropy = fraction(),
        // On the device, what lies under a dielectric that parts colours takes green's share, and a film on
        // it has three base indices at once; in the reference, each colour has a material of its own.
        .transmission = prism ? 1.0f : fraction(),
        .dispersion = prism ? random.unit() : 0.0f,
        .diffuse_transmission = fraction(),
        .diffuse_transmission_color = color(),
        .coat = fraction(),
        .coat_roughness = 0.15f + 0.85f * random.unit(),
        .coat_ior = 1.2f + random.unit(),
        .coat_darkening = fraction(),
        .sheen_color = tint(),
        .sheen_roughness = 0.3f + 0.7f * random.unit(),
        .fuzz = fraction(),
        .fuzz_color = color(),
        .fuzz_roughness = 0.1f + 0.9f * random.unit(),
        .iridescence = prism ? 0.0f : fraction(),
        .iridescence_ior = 1.1f + random.unit(),
        .iridescence_thickness = 100.0f + 900.0f * random.unit()};
    if (random.bits() % 2 == 0) m.inside = Medium{};
    return m;
}

struct NamedMaterial {
    const char* name;
    PrincipledMaterial material;
};

// One part of the material each.
std::vector<NamedMaterial> plain_materials() {
    const vec3 orange(0.7f, 0.5f, 0.2f);
    std::vector<NamedMaterial> list;
    const auto add = [&](const char* name, const auto& change) {
        PrincipledMaterial m{.base_color = orange, .roughness = 0.6f};
        change(m);
        list.push_back({name, m});
    };
    const auto glass = [](PrincipledMaterial& m) { m.transmission = 1.0f, m.inside = Medium{}; };
    add("plastic", [](auto&) {});
    add("tinted specular", [](auto& m) { m.specular = 0.5f, m.specular_color = vec3(0.9f, 0.5f, 0.1f); });
    add("metal", [](auto& m) { m.metalness = 1.0f; });
    add("brushed metal", [](auto& m) { m.metalness = 1.0f, m.anisotropy = 0.7f; });
    add("rough diffuse", [](auto& m) { m.diffuse_roughness = 0.8f; });
    add("thin", [](auto& m) { m.transmission = 1.0f; });
    add("glass", [&](auto& m) { glass(m); });
    add("half a glass", [&](auto& m) { glass(m), m.transmission = 0.5f; });
    add("glass with less specular", [&](auto& m) { glass(m), m.transmission = 0.5f, m.specular = 0.5f; });
    add("glass under a film", [&](auto& m) { glass(m), m.iridescence = 0.5f; });
    add("prism", [&](auto& m) { glass(m), m.dispersion = 0.5f; });
    add("film", [](auto& m) { m.iridescence = 0.5f; });
    add("metal under a film", [](auto& m) { m.metalness = 1.0f, m.iridescence = 0.5f; });
    add("leaf", [](auto& m) { m.diffuse_transmission = 0.5f; });
    add("wax", [](auto& m) { m.diffuse_transmission = 0.5f, m.inside = Medium{}; });
    add("coat", [](auto& m) { m.coat = 0.5f, m.coat_roughness = 0.4f; });
    add("ideal coat", [](auto& m) { m.coat = 0.5f; });
    add("coat that darkens",
        [](auto& m) { m.coat = 0.5f, m.coat_roughness = 0.4f, m.coat_darkening = 1.0f; });
    add("sheen", [](auto& m) { m.sheen_color = vec3(0.9f, 0.5f, 0.2f), m.sheen_roughness = 0.5f; });
    add("fuzz",
        [](auto& m) { m.fuzz = 0.8f, m.fuzz_color = vec3(0.9f, 0.5f, 0.2f), m.fuzz_roughness = 0.3f; });
    add("fuzz on glass", [&](auto& m) { glass(m), m.fuzz = 0.8f; });
    add("all reflecting", [](auto& m) { m.ior = 0.0f, m.specular_color = vec3(0.9f, 0.5f, 0.2f); });
    return list;
}

TEST_F(PrincipledTest, ValuesOfEachPartAreThoseOfTheReference) {
    for (const auto& [name, material] : plain_materials()) {
        expect_reference(name, material, false, 5);
        if (material.inside) expect_reference(std::string(name) + " from inside", material, true, 6);
    }
}

TEST_F(PrincipledTest, ValuesOfRandomMaterialsAreThoseOfTheReference) {
    Random random(31);
    for (uint32_t i = 0; i < 24; ++i) {
        const PrincipledMaterial m = random_material(random);
        expect_reference("material " + std::to_string(i), m, false, 100 + i);
        if (interior(m)) expect_reference("material " + std::to_string(i) + " from inside", m, true, 200 + i);
    }
}

// Cosines of unit vectors may be rounded to a little more than 1.
TEST_F(PrincipledTest, ACosineAboveOneIsTakenForOne) {
    const vec3 slanted = normalize(vec3(1.0f, 0.0f, 0.6f));
    const float above = std::nextafter(std::nextafter(1.0f, 2.0f), 2.0f);
    for (const auto& [name, material] : plain_materials()) {
        const auto value = [&, &m = material](float cosine) {
            const vec3 w(0.0f, 0.0f, cosine);
            return run({bsdf_item(principled(m), w, slanted, 0), bsdf_item(principled(m), slanted, w, 0)});
        };
        const std::vector<BsdfResult> at_one = value(1.0f), above_one = value(above);
        for (size_t i = 0; i < 2; ++i) {
            EXPECT_GT(at_one[i].f.x, 0.0f) << name;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(above_one[i].f[c], at_one[i].f[c], ROUNDING * (double(at_one[i].f[c]) + 0.01))
                    << name;
        }
    }
}

// Under the strongest dispersion, facets hardly bend red, and all of it passes: its mean over directions is
// 1, within four standard errors.
TEST_F(PrincipledTest, NoRedIsLostWhereItsIndexIsLeast) {
    const PrincipledMaterial m{.base_color = vec3(1.0f),
                               .roughness = 0.55f,
                               .transmission = 1.0f,
                               .inside = Medium{},
                               .dispersion = 40.0f};
    Random random(78);
    for (const float cosine : {0.2f, 0.6f, 0.95f}) {
        const vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
        std::vector<BsdfItem> items(candela::samples(1u << 16u), bsdf_item(principled(m), wo, wo, 0));
        for (uint32_t i = 0; i < items.size(); ++i) {
            items[i].u = random.square();
            items[i].uc = random.unit();
            items[i].random = i;
        }
        RunningMoments red;
        const double eta = 1.0 + double(MIN_FACET_ALPHA);
        for (const BsdfResult& s : run(items))
            red.add(s.pdf > 0.0f ? double(s.weight.x) * (s.wi.z < 0.0f ? eta * eta : 1.0) : 0.0);
        const double error = std::sqrt(red.variance() / double(items.size()));
        EXPECT_LT(error, 0.05);
        EXPECT_NEAR(red.mean(), 1.0, 4.0 * error) << cosine;
    }
}

// Fuzz is not reciprocal, nor is a film, whose colour depends on the viewer.
TEST_F(PrincipledTest, SheenCoatAndDiffuseBaseAreReciprocal) {
    const vec3 orange(0.7f, 0.5f, 0.2f), black(0);
    const std::vector<NamedMaterial> lobes{
        {"diffuse", {.base_color = orange, .specular = 0.0f}},
        {"rough diffuse", {.base_color = orange, .diffuse_roughness = 0.8f, .specular = 0.0f}},
        {"sheen", {.base_color = black, .specular = 0.0f, .sheen_color = orange, .sheen_roughness = 0.6f}},
        {"coat", {.base_color = black, .specular = 0.0f, .coat = 1.0f, .coat_roughness = 0.4f}}};
    for (const auto& [name, material] : lobes) {
        const std::vector<BsdfResult> values = run(triangles(material, 0));
        for (size_t i = 0; i < values.size(); i += 2) {
            ASSERT_GT(values[i].f.x, 0.0f) << name;
            ASSERT_NEAR(values[i].f.x, values[i + 1].f.x, ROUNDING * double(values[i].f.x)) << name;
        }
    }
}

// What facets give back of lost light depends on the viewer alone, so that f(a, b) - f(b, a) is a difference
// of two numbers, one for a and one for b, if the lobe itself is reciprocal. Around a triangle, these add up
// to 0.
TEST_F(PrincipledTest, FacetsAreReciprocalButForLightThatTheyLose) {
    const vec3 orange(0.7f, 0.5f, 0.2f);
    const auto expect_reciprocal = [&](const char* name, const PrincipledMaterial& m, uint32_t back) {
        const std::vector<BsdfResult> values = run(triangles(m, back));
        for (size_t i = 0; i < values.size(); i += 6) {
            double difference = 0, sum = 0;
            for (size_t k = 0; k < 6; ++k) {
                sum += double(values[i + k].f.x);
                difference += (k % 2 == 0 ? 1 : -1) * double(values[i + k].f.x);
            }
            ASSERT_GT(sum, 0.0) << name;
            ASSERT_NEAR(difference, 0, ROUNDING * sum) << name << ", triangle " << i / 6;
        }
    };
    expect_reciprocal("metal", {.base_color = orange, .metalness = 1.0f, .roughness = 0.5f}, 0);
    expect_reciprocal("brushed metal",
                      {.base_color = orange, .metalness = 1.0f, .roughness = 0.5f, .anisotropy = 0.6f}, 0);
    expect_reciprocal("dielectric", {.base_color = vec3(0), .roughness = 0.5f}, 0);
    for (const uint32_t back : {0u, 1u})
        expect_reciprocal("glass", {.roughness = 0.5f, .transmission = 1.0f, .inside = Medium{}}, back);
}

// Light that goes through meets the same surface on its way back, from the other side: f from outside, times
// the square of the relative index, is f from inside. Here, too, what is lost depends on the viewer alone;
// with two directions on each side, the differences add up to 0.
TEST_F(PrincipledTest, TransmissionIsReciprocalButForLightThatFacetsLose) {
    PrincipledMaterial thin{.base_color = vec3(0.9f), .roughness = 0.7f, .transmission = 1.0f};
    PrincipledMaterial glass = thin;
    glass.inside = Medium{};
    for (const PrincipledMaterial& m : {thin, glass}) {
        const double eta = m.inside ? double(m.ior) : 1.0;
        Random random(13);
        const auto around = [&](vec3 w) { return normalize(w + 0.4f * random.direction()); };
        std::vector<BsdfItem> items;
        for (int i = 0; i < 500; ++i) {
            vec3 w = random.direction();
            w.z = 0.5f + std::abs(w.z);
            const vec3 outside[] = {around(w), around(w)}, inside[] = {around(w), around(w)};
            for (const vec3 a : outside) {
                for (const vec3 b : inside) {
                    items.push_back(bsdf_item(principled(m), a, -b, 0));
                    items.push_back(bsdf_item(principled(m), b, -a, 1));
                }
            }
        }
        const std::vector<BsdfResult> values = run(items);
        double transmitted = 0;
        for (size_t i = 0; i < values.size(); i += 8) {
            double difference = 0, sum = 0;
            for (size_t k = 0; k < 4; ++k) {
                const double out = eta * eta * double(values[i + 2 * k].f.x), in = values[i + 2 * k + 1].f.x;
                sum += out + in;
                difference += (k == 0 || k == 3 ? 1 : -1) * (out - in);
            }
            ASSERT_NEAR(difference, 0, ROUNDING * sum) << m.inside.has_value() << ", directions " << i / 8;
            transmitted += sum / double(values.size());
        }
        EXPECT_GT(transmitted, 0.1);
    }
}

// Lossless metal and glass return the light of an even sky, at every roughness and angle: within four
// standard errors, each of which is at most 0.4 %; that of all together is 0.03 %.
TEST_F(PrincipledTest, NothingIsLostAtAnyRoughnessAndAngle) {
    const uint32_t count = candela::samples(1u << 16u);
    double sum = 0.0, variance = 0.0, runs = 0.0;
    const auto measure = [&](const PrincipledMaterial& m, float cosine, uint32_t back) {
        Random random(77);
        const vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
        std::vector<BsdfItem> items(count, bsdf_item(principled(m), wo, wo, back));
        for (uint32_t i = 0; i < count; ++i) {
            items[i].u = random.square();
            items[i].uc = random.unit();
            items[i].random = i;
        }
        RunningMoments energy;
        for (const BsdfResult& s : run(items))
            energy.add(s.pdf > 0.0f ? double(s.weight.x) * double(s.eta) * double(s.eta) : 0.0);
        const double squared_error = energy.variance() / double(count);
        EXPECT_LE(squared_error, 1.0 / double(count));
        EXPECT_NEAR(energy.mean(), 1.0, 4.0 * std::sqrt(squared_error) + 0x1p-16)
            << "roughness " << m.roughness.factor << ", cosine " << cosine << ", metal " << m.metalness.factor
            << ", volume " << m.inside.has_value() << ", back " << back;
        sum += energy.mean(), variance += squared_error, ++runs;
    };
    for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f}) {
        for (const float cosine : {0.01f, 0.3f, 1.0f}) {
            measure({.base_color = vec3(1.0f), .metalness = 1.0f, .roughness = roughness}, cosine, 0);
            PrincipledMaterial glass{.base_color = vec3(1.0f), .roughness = roughness, .transmission = 1.0f};
            measure(glass, cosine, 0);
            glass.inside = Medium{};
            measure(glass, cosine, 0);
            measure(glass, cosine, 1);
        }
    }
    EXPECT_NEAR(sum / runs, 1.0, 4.0 * std::sqrt(variance) / runs + 0x1p-16);
}

}  // namespace
}  // namespace candela
