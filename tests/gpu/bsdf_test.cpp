// Every BSDF: samples follow the density, weights are f cos / pdf, f is reciprocal and creates no energy.
#include <cmath>

#include "chi_squared.h"
#include "gpu/device_fixture.h"
#include "shared/material.h"
#include "support/reference_random.h"

namespace candela {
namespace {

struct BsdfItem {
    MaterialRecord material;
    vec3 wo;
    float unused0 = 0.0f;
    vec3 wi{0, 0, 1};
    float unused1 = 0.0f;
    vec2 u{0};
    uint32_t uc = 0;
    uint32_t unused2 = 0;
};
static_assert(sizeof(BsdfItem) == 64);

struct BsdfResult {
    vec3 wi, weight;
    float pdf;
    vec3 f_of_sample;
    float pdf_of_sample;
    vec3 f;
    float pdf_of_wi;
};

const std::vector<MaterialRecord> MATERIALS{{MATERIAL_DIFFUSE, vec3(1.0f)},
                                            {MATERIAL_DIFFUSE, vec3(0.8f, 0.3f, 0.0f)}};

// From head-on to grazing.
const std::vector<vec3> VIEWS{vec3(0, 0, 1), normalize(vec3(1, 0.5, 1)), normalize(vec3(-1, 2, 0.01))};

class BsdfTest : public DeviceTest {
  protected:
    static constexpr uint32_t SAMPLES = 100000;

    std::vector<BsdfResult> run(const std::vector<BsdfItem>& items) const {
        return map<BsdfResult>(kernels::bsdf, items);
    }
    std::vector<BsdfResult> samples(const MaterialRecord& material, vec3 wo, uint32_t seed) const {
        Random random(seed);
        std::vector<BsdfItem> items(SAMPLES, {.material = material, .wo = wo});
        for (BsdfItem& item : items) {
            item.u = random.square();
            item.uc = random.bits();
        }
        return run(items);
    }
};

// Cells of equal solid angle over the whole sphere: z times angle.
constexpr uint32_t HEIGHTS = 32, TURNS = 16, FINE = 8;

uint32_t cell_of(vec3 w) {
    const double height = (double(w.z) + 1.0) / 2.0;
    const double turn = std::atan2(double(w.y), double(w.x)) / (2.0 * M_PI) + 0.5;
    return std::min(uint32_t(height * HEIGHTS), HEIGHTS - 1) * TURNS +
           std::min(uint32_t(turn * TURNS), TURNS - 1);
}

// FINE^2 directions in each cell.
std::vector<vec3> directions_of_cells() {
    std::vector<vec3> directions;
    for (uint32_t i = 0; i < HEIGHTS * FINE; ++i) {
        for (uint32_t k = 0; k < TURNS * FINE; ++k) {
            const double z = 2.0 * (i + 0.5) / (HEIGHTS * FINE) - 1.0;
            const double phi = 2.0 * M_PI * ((k + 0.5) / (TURNS * FINE) - 0.5);
            const double r = std::sqrt(1.0 - z * z);
            directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
        }
    }
    return directions;
}

// The density is integrated over each cell by the midpoint rule, which is exact for a density that is linear
// in z. It integrates to 1: all samples are counted.
TEST_F(BsdfTest, SamplesFollowTheDensityWhichIntegratesToOne) {
    const std::vector<vec3> directions = directions_of_cells();
    const double level = sidak_level(CHI_SQUARED_ALPHA, MATERIALS.size() * VIEWS.size());
    for (const MaterialRecord& material : MATERIALS) {
        for (const vec3 wo : VIEWS) {
            std::vector<BsdfItem> items;
            for (const vec3 wi : directions)
                items.push_back({.material = material, .wo = wo, .wi = wi});
            std::vector<double> expected(HEIGHTS * TURNS);
            double integral = 0.0;
            const std::vector<BsdfResult> values = run(items);
            for (size_t i = 0; i < values.size(); ++i) {
                const double share = double(values[i].pdf_of_wi) * 4.0 * M_PI / double(values.size());
                expected[cell_of(directions[i])] += share;
                integral += share;
            }
            EXPECT_NEAR(integral, 1.0, 1e-5);

            std::vector<double> counts(HEIGHTS * TURNS);
            for (const BsdfResult& s : samples(material, wo, 7))
                ++counts[cell_of(s.wi)];
            EXPECT_GT(chi_squared_p_value_of(counts, expected), level);
        }
    }
}

TEST_F(BsdfTest, SampleAndEvaluationAgree) {
    for (const MaterialRecord& material : MATERIALS) {
        for (const vec3 wo : VIEWS) {
            for (const BsdfResult& s : samples(material, wo, 8)) {
                ASSERT_NEAR(length(glm::dvec3(s.wi)), 1.0, 0x1p-20);
                ASSERT_EQ(s.pdf, s.pdf_of_sample);
                if (s.pdf == 0.0f) continue;  // wi lies in the surface: it carries nothing.
                for (const int c : {0, 1, 2}) {
                    const double cosine = std::abs(s.wi.z);
                    const double carried = s.f_of_sample[c] * cosine;
                    // Two constants and three products, each rounded to 2^-24.
                    ASSERT_NEAR(carried, double(s.weight[c]) * s.pdf, carried * 0x1p-21);
                }
            }
        }
    }
}

TEST_F(BsdfTest, DiffuseWeightsAreTheReflectanceToTheBit) {
    for (const MaterialRecord& material : MATERIALS) {
        for (const BsdfResult& s : samples(material, VIEWS[1], 9))
            ASSERT_EQ(s.weight, material.reflectance);
    }
}

TEST_F(BsdfTest, DiffuseReflectsOnlyUpwards) {
    const std::vector<BsdfResult> values =
        run({{.material = MATERIALS[0], .wo = VIEWS[0], .wi = vec3(0, 0, 1)},
             {.material = MATERIALS[0], .wo = VIEWS[0], .wi = normalize(vec3(1, 0, 1e-3f))},
             {.material = MATERIALS[0], .wo = VIEWS[0], .wi = normalize(vec3(1, 0, -1e-3f))},
             {.material = MATERIALS[0], .wo = VIEWS[0], .wi = vec3(0, 0, -1)}});
    for (const size_t above : {0u, 1u})
        EXPECT_FLOAT_EQ(values[above].f.x, float(1.0 / M_PI));
    for (const size_t below : {2u, 3u}) {
        EXPECT_EQ(values[below].f, vec3(0.0f));
        EXPECT_EQ(values[below].pdf_of_wi, 0.0f);
    }
}

TEST_F(BsdfTest, ReciprocalAndWithoutGain) {
    const std::vector<vec3> directions = directions_of_cells();
    for (const MaterialRecord& material : MATERIALS) {
        for (const vec3 wo : VIEWS) {
            std::vector<BsdfItem> there, back;
            for (const vec3 wi : directions) {
                if (wi.z <= 0.0f) continue;
                there.push_back({.material = material, .wo = wo, .wi = wi});
                back.push_back({.material = material, .wo = wi, .wi = wo});
            }
            const std::vector<BsdfResult> values = run(there);
            const std::vector<BsdfResult> reversed = run(back);
            glm::dvec3 albedo(0.0);
            for (size_t i = 0; i < values.size(); ++i) {
                ASSERT_EQ(values[i].f, reversed[i].f);
                albedo +=
                    glm::dvec3(values[i].f) * double(there[i].wi.z) * 2.0 * M_PI / double(values.size());
            }
            for (const int c : {0, 1, 2})
                EXPECT_NEAR(albedo[c], material.reflectance[c], 1e-5);
        }
    }
}

}  // namespace
}  // namespace candela
