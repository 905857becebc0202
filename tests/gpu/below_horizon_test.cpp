// Directions below the horizon of the shading normal, which arise from smooth normals and grazing lights:
// nothing is scattered there, and what is seen from there is consistent.
#include "base/text.h"
#include "gpu/bsdf_fixture.h"

namespace candela {
namespace {

class BelowHorizonTest : public BsdfTest {
  protected:
    // Down to straight below; in the plane itself, with either sign of zero; a little below.
    static std::vector<vec3> directions_below() {
        std::vector<vec3> all{vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, -1, -0.0f),
                              normalize(vec3(1, 2, -1e-6f))};
        Random random(220);
        for (int i = 0; i < 1000; ++i) {
            vec3 w = random.direction();
            w.z = -std::abs(w.z) * std::exp2(-20.0f * random.unit());
            all.push_back(normalize(w));
        }
        return all;
    }
    static std::vector<MaterialRecord> materials() {
        const vec3 base(0.5f, 0.2f, 0.4f), lobe(0.4f, 0.8f, 0.1f);
        return {diffuse(base),
                phong(base, lobe, 0.0f),
                phong(base, lobe, 7.5f),
                phong(base, lobe, 1e5f),
                conductor(lobe, 1e-3f),
                conductor(lobe, 1.0f),
                mirror(base),
                dielectric(MATERIAL_DIELECTRIC_SCHLICK, 1.5f),
                dielectric(MATERIAL_DIELECTRIC_EXACT, 1.0f / 1.5f)};
    }
};

// Light from below the horizon has neither value nor density, wherever the viewer is.
TEST_F(BelowHorizonTest, NothingIsScatteredTowardsLightFromBelow) {
    const std::vector<vec3> below = directions_below();
    std::vector<BsdfItem> items;
    for (const MaterialRecord& material : materials()) {
        for (const vec3 wo : {VIEWS[0], VIEWS[1], VIEWS[2], -VIEWS[1], -VIEWS[2]}) {
            for (const vec3 wi : below)
                items.push_back({.material = pack(material), .wo = wo, .wi = wi});
        }
    }
    const std::vector<BsdfResult> results = run(items);
    for (size_t i = 0; i < items.size(); ++i) {
        ASSERT_EQ(results[i].f, vec3(0.0f))
            << "model " << (items[i].material[0].x & 255u) << ", " << items[i].wi.z;
        ASSERT_EQ(results[i].pdf_of_wi, 0.0f)
            << "model " << (items[i].material[0].x & 255u) << ", " << items[i].wi.z;
    }
}

// For a viewer below the horizon, surfaces that mirror or refract scatter nothing.
TEST_F(BelowHorizonTest, IdealAndMicrofacetSurfacesAreBlackFromBelow) {
    std::vector<BsdfItem> items;
    Random random(221);
    for (const MaterialRecord& material : materials()) {
        if (material.model == MATERIAL_DIFFUSE || material.model == MATERIAL_PHONG) continue;
        for (const vec3 wo : directions_below()) {
            const vec3 wi = random.direction();
            items.push_back(
                {.material = pack(material), .wo = wo, .wi = wi, .u = random.square(), .uc = random.unit()});
        }
    }
    for (const BsdfResult& s : run(items)) {
        ASSERT_EQ(s.pdf, 0.0f);
        ASSERT_EQ(s.weight, vec3(0.0f));
        ASSERT_EQ(s.f, vec3(0.0f));
        ASSERT_EQ(s.pdf_of_wi, 0.0f);
    }
}

// The diffuse base does not depend on the viewer. The Phong lobe lies around the mirrored direction, which is
// now below the horizon, so that only its rim is above. Samples follow the density and agree with it as they
// do from above.
TEST_F(BelowHorizonTest, DiffuseAndPhongSamplesFollowTheirDensityFromBelow) {
    const vec3 colour(0.4f, 0.8f, 0.1f);
    std::vector<BsdfCase> cases;
    for (const vec3 view : VIEWS) {
        const vec3 wo(view.x, view.y, -view.z);
        const std::string from = concat(", seen from below, cosine ", wo.z);
        cases.push_back({"diffuse" + from, diffuse(colour), wo, SphereChart()});
        for (const vec3 kd : {vec3(0.0f), vec3(0.5f, 0.2f, 0.4f)}) {
            for (const float n : {0.0f, 1.0f, 7.5f})
                cases.push_back({concat("phong ", n, from), phong(kd, colour, n), wo, SphereChart()});
        }
    }
    const vec3 grazing(VIEWS[2].x, VIEWS[2].y, -VIEWS[2].z);
    const glm::dvec3 mirrored(-grazing.x, -grazing.y, grazing.z);
    for (const float n : {100.0f, 1e3f, 1e4f})
        cases.push_back({concat("phong ", n, " from a little below"), phong(vec3(0.0f), colour, n), grazing,
                         LobeChart(mirrored, n)});
    Evidence evidence;
    uint32_t seed = 900;
    for (const BsdfCase& c : cases) {
        const std::vector<BsdfResult> results = run_bsdf_case(device(), c, seed++);
        test_density(c, results, evidence);
        test_values(c, results, evidence);
    }
    expect_holds(evidence);
}

}  // namespace
}  // namespace candela
