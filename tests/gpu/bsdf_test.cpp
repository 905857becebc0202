// Every BSDF without ideal scattering: samples follow the density, weights are f cos / pdf, f is reciprocal
// and creates no energy.
#include "gpu/bsdf_fixture.h"

namespace candela {
namespace {

// All cases, each with a seed of its own.
template <class Judge>
Evidence evidence_of_cases(const vk::Device& device, const std::vector<BsdfCase>& cases, uint32_t first_seed,
                           const Judge& judge, bool any_facets = false) {
    Evidence evidence;
    for (const BsdfCase& c : cases)
        judge(c, run_bsdf_case(device, c, first_seed++, any_facets), evidence);
    return evidence;
}

TEST_F(BsdfTest, SamplesFollowTheDensity) {
    expect_holds(evidence_of_cases(device(), bsdf_cases(), 700, test_density));
}

TEST_F(BsdfTest, SamplesOfPrincipledMaterialsFollowTheDensity) {
    expect_holds(evidence_of_cases(device(), principled_cases(), 1700, test_density));
}

TEST_F(BsdfTest, SampleAndEvaluationAgree) {
    expect_holds(evidence_of_cases(device(), bsdf_cases(), 800, test_values));
}

TEST_F(BsdfTest, SampleAndEvaluationOfPrincipledMaterialsAgree) {
    expect_holds(evidence_of_cases(device(), principled_cases(), 1800, test_values, true));
}

TEST_F(BsdfTest, DiffuseWeightsAreTheReflectanceToTheBit) {
    for (const vec3 colour : {vec3(1.0f), vec3(0.8f, 0.3f, 0.0f)}) {
        for (const BsdfResult& s : samples(diffuse(colour), VIEWS[1], 10000, 9))
            ASSERT_EQ(s.weight, colour);
    }
}

TEST_F(BsdfTest, DiffuseReflectsOnlyUpwards) {
    const MaterialRecord white = diffuse(vec3(1.0f));
    const std::vector<BsdfResult> values =
        run({{.material = pack(white), .wi = vec3(0, 0, 1)},
             {.material = pack(white), .wi = normalize(vec3(1, 0, 1e-3f))},
             {.material = pack(white), .wi = normalize(vec3(1, 0, -1e-3f))},
             {.material = pack(white), .wi = vec3(0, 0, -1)}});
    for (const size_t above : {0u, 1u})
        EXPECT_FLOAT_EQ(values[above].f.x, float(1.0 / M_PI));
    for (const size_t below : {2u, 3u}) {
        EXPECT_EQ(values[below].f, vec3(0.0f));
        EXPECT_EQ(values[below].pdf_of_wi, 0.0f);
    }
}

TEST_F(BsdfTest, DiffuseTransmissionHasAValueOfItsOwnOnEachSide) {
    const MaterialRecord sheet = diffuse_transmission(vec3(0.5f), vec3(0.25f));
    const vec3 wi = normalize(vec3(1, 2, 3));
    const std::vector<BsdfResult> values =
        run({{.material = pack(sheet), .wi = wi}, {.material = pack(sheet), .wi = -wi}});
    const double cosine_pdf = double(wi.z) / M_PI;
    EXPECT_FLOAT_EQ(values[0].f.x, float(0.5 / M_PI));
    EXPECT_FLOAT_EQ(values[1].f.x, float(0.25 / M_PI));
    EXPECT_FLOAT_EQ(values[0].pdf_of_wi, float(2.0 / 3.0 * cosine_pdf));
    EXPECT_FLOAT_EQ(values[1].pdf_of_wi, float(1.0 / 3.0 * cosine_pdf));
}

// Light takes the same way back: wo and wi are swapped, and so is the viewer's side.
TEST_F(BsdfTest, DiffuseTransmissionIsReciprocal) {
    const MaterialRecord sheet = diffuse_transmission(vec3(0.5f, 0.2f, 0.4f), vec3(0.4f, 0.8f, 0.1f));
    Random random(11);
    std::vector<BsdfItem> there, back;
    for (int i = 0; i < 20000; ++i) {
        vec3 wo = random.direction(), wi = random.direction();
        wo.z = std::abs(wo.z);
        wi.z = -std::abs(wi.z);
        there.push_back({.material = pack(sheet), .wo = wo, .wi = wi});
        back.push_back({.material = pack(sheet), .wo = -wi, .wi = -wo, .back = 1});
    }
    const std::vector<BsdfResult> values = run(there), reversed = run(back);
    for (size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(values[i].f, reversed[i].f);
        ASSERT_GT(values[i].f.x, 0.0f);
    }
}

// Pairs all over the hemisphere, and pairs near the mirrored direction. Nothing in the models depends on the
// order of the two but signs, so that values agree to the bit.
TEST_F(BsdfTest, ReflectionIsReciprocal) {
    const std::vector<MaterialRecord> materials{
        diffuse(vec3(0.8f, 0.3f, 0.0f)),
        phong(vec3(0.5f, 0.2f, 0.4f), vec3(0.4f, 0.8f, 0.1f), 7.5f),
        phong(vec3(0.1f, 0.2f, 0.4f), vec3(0.4f, 0.8f, 0.1f), 1e5f),
        conductor(vec3(0.9f, 0.6f, 0.3f), 1e-3f),
        conductor(vec3(0.9f, 0.6f, 0.3f), 0.5f),
        diffuse_transmission(vec3(0.5f, 0.2f, 0.4f), vec3(0.4f, 0.8f, 0.1f)),
    };
    for (const MaterialRecord& material : materials) {
        Random random(10);
        std::vector<BsdfItem> there, back;
        for (int i = 0; i < 20000; ++i) {
            vec3 wo = random.direction(), wi = random.direction();
            wo.z = std::abs(wo.z);
            const float spread = std::exp2(-12.0f * random.unit());
            wi = i % 2 == 0 ? wi : normalize(vec3(-wo.x, -wo.y, wo.z) + spread * wi);
            wi.z = std::abs(wi.z);
            there.push_back({.material = pack(material), .wo = wo, .wi = wi});
            back.push_back({.material = pack(material), .wo = wi, .wi = wo});
        }
        const std::vector<BsdfResult> values = run(there);
        const std::vector<BsdfResult> reversed = run(back);
        for (size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(values[i].f, reversed[i].f);
    }
}

}  // namespace
}  // namespace candela
