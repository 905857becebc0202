// Ideal mirrors and smooth dielectrics: Snell's law, and Fresnel's equations in double precision.
#include "gpu/bsdf_fixture.h"

namespace candela {
namespace {

constexpr float LAST = 1.0f - 0x1p-24f;  // The last random number below 1.

// Indices of refraction behind the surface over those in front of it.
const std::vector<float> ETAS{1.5f, 1.33f, 2.4f, 1.0f / 1.5f, 0.25f, 1.0f};

// Reflectance of unpolarised light at a boundary with the relative index eta, from the angles alone; 1 beyond
// the critical angle. Ref: Born and Wolf, Principles of Optics, section 1.5.2, equation 21a, which gives the
// amplitudes in this form.
double reflectance(double sine, double eta, bool exact) {
    if (eta == 1.0) return 0.0;  // As if there were no boundary, though Schlick's approximation reflects.
    if (sine >= eta) return 1.0;
    const double i = std::asin(sine), t = std::asin(sine / eta);
    const double at_normal = (eta - 1.0) * (eta - 1.0) / ((eta + 1.0) * (eta + 1.0));
    if (!exact) return at_normal + (1.0 - at_normal) * std::pow(1.0 - std::cos(std::max(i, t)), 5.0);
    if (i + t < 1e-6) return at_normal;
    const double s = std::sin(i - t) / std::sin(i + t), p = std::tan(i - t) / std::tan(i + t);
    return 0.5 * (s * s + p * p);
}

double sine_of(vec3 w) {
    return length(glm::dvec2(normalize(glm::dvec3(w))));
}

class DielectricTest : public BsdfTest {
  protected:
    // From normal incidence to a cosine of 0.02.
    static std::vector<vec3> views() {
        std::vector<vec3> views{vec3(0, 0, 1)};
        for (int i = 1; i <= 1000; ++i) {
            const double cosine = 1.0 - 0.98 * i / 1000.0, sine = std::sqrt(1.0 - cosine * cosine);
            views.emplace_back(sine * std::cos(double(i)), sine * std::sin(double(i)), cosine);
        }
        return views;
    }
    // For each view the reflected ray (or the refracted one, if nothing is reflected), then the refracted one
    // (or the reflected one, if all is).
    std::vector<BsdfResult> run_both(uint32_t model, float eta, const std::vector<vec3>& views,
                                     uint32_t back = 0) const {
        std::vector<BsdfItem> items;
        for (const float uc : {0.0f, LAST}) {
            for (const vec3 wo : views)
                items.push_back({.material = pack(dielectric(model, eta)), .wo = wo, .uc = uc, .back = back});
        }
        return run(items);
    }
    // The error of a reflectance R = ((a - b) / (a + b))^2 whose cosine of refraction b is off by 2^-22 / b,
    // since its square has 8 roundings of a number up to 1 (a division has 5); dR / db <= 4 / a, and a >=
    // 0.25 where eta < 1 and b is small. All else is relative to terms up to 1: 2^-20.
    static double tolerance(double cos_t) { return 16.0 * 0x1p-22 / cos_t + 0x1p-20; }
};

TEST_F(DielectricTest, ReflectsByFresnelsEquationsOrSchlicksApproximation) {
    const std::vector<vec3> all = views();
    for (const float eta : ETAS) {
        for (const bool exact : {false, true}) {
            const uint32_t model = exact ? MATERIAL_DIELECTRIC_EXACT : MATERIAL_DIELECTRIC_SCHLICK;
            const std::vector<BsdfResult> results = run_both(model, eta, all);
            for (size_t i = 0; i < all.size(); ++i) {
                const double sine = sine_of(all[i]);
                const double cos_t =
                    std::sqrt(std::max(0.0, 1.0 - sine * sine / (double(eta) * double(eta))));
                if (std::abs(sine / double(eta) - 1.0) < 1e-4)
                    continue;  // The critical angle, but for rounding.
                const double R = reflectance(sine, double(eta), exact);
                const BsdfResult& one = results[i];
                const BsdfResult& other = results[all.size() + i];
                const bool splits = one.wi.z > 0.0f && other.wi.z < 0.0f;
                const double reflected = splits || one.wi.z > 0.0f ? double(one.pdf) : 0.0;
                ASSERT_NEAR(reflected, R, R == 1.0 ? 0.0 : tolerance(cos_t)) << eta << ' ' << all[i].z;
                if (splits) {
                    ASSERT_NEAR(double(one.pdf) + double(other.pdf), 1.0, 0x1p-24);
                } else {
                    ASSERT_EQ(one.pdf, 1.0f);
                    ASSERT_EQ(one.wi, other.wi);
                }
            }
        }
    }
}

TEST_F(DielectricTest, RefractsBySnellsLaw) {
    const std::vector<vec3> all = views();
    for (const float eta : ETAS) {
        const std::vector<BsdfResult> results = run_both(MATERIAL_DIELECTRIC_EXACT, eta, all);
        size_t refracted = 0;
        for (size_t i = 0; i < results.size(); ++i) {
            const vec3 wo = all[i % all.size()];
            const BsdfResult& s = results[i];
            ASSERT_EQ(s.delta, 1u);
            ASSERT_EQ(s.f_of_sample, vec3(0.0f));
            ASSERT_EQ(s.pdf_of_sample, 0.0f);
            ASSERT_NEAR(length(glm::dvec3(s.wi)), 1.0, 0x1p-21);
            if (s.wi.z > 0.0f) {
                ASSERT_EQ(s.wi, vec3(-wo.x, -wo.y, wo.z));
                ASSERT_EQ(s.weight, vec3(1.0f));
                ASSERT_EQ(s.eta, 1.0f);
                continue;
            }
            if (i >= all.size()) ++refracted;
            // A division and a normalisation.
            ASSERT_NEAR(s.wi.x, -double(wo.x) / double(eta), 0x1p-21);
            ASSERT_NEAR(s.wi.y, -double(wo.y) / double(eta), 0x1p-21);
            ASSERT_EQ(s.eta, eta);
            const double weight = 1.0 / (double(eta) * double(eta));
            for (const int c : {0, 1, 2})
                ASSERT_NEAR(s.weight[c], weight, weight * 0x1p-21);
        }
        const auto passing =
            std::count_if(all.begin(), all.end(), [&](vec3 wo) { return sine_of(wo) < eta; });
        EXPECT_NEAR(double(refracted), double(passing), 2.0) << eta;
    }
}

// Light that went in comes out on the way it came, with the same reflectance: the refracted ray, seen from
// the back, where z is flipped.
TEST_F(DielectricTest, BothSidesReflectAlike) {
    for (const uint32_t model : {MATERIAL_DIELECTRIC_SCHLICK, MATERIAL_DIELECTRIC_EXACT}) {
        for (const float eta : {1.5f, 1.33f, 2.4f}) {
            const std::vector<vec3> all = views();
            const std::vector<BsdfResult> in = run_both(model, eta, all);
            std::vector<vec3> inside;
            for (size_t i = 0; i < all.size(); ++i) {
                const vec3 wi = in[all.size() + i].wi;
                inside.emplace_back(wi.x, wi.y, -wi.z);
            }
            const std::vector<BsdfResult> out = run_both(model, eta, inside, 1);
            for (size_t i = 0; i < all.size(); ++i) {
                // The cosine outside, 0.02 or more, has the error of its square over twice itself: 8
                // roundings.
                const double cosine = double(all[i].z), error = eta * eta * 8 * 0x1p-24 / cosine;
                ASSERT_NEAR(out[i].pdf, in[i].pdf, 8.0 * error) << cosine;
                const vec3 wi = out[all.size() + i].wi;
                ASSERT_LE(length(glm::dvec3(wi.x - all[i].x, wi.y - all[i].y, -wi.z - all[i].z)),
                          0x1p-20 + error);
                ASSERT_NEAR(double(out[all.size() + i].eta) * double(eta), 1.0, 0x1p-21);
                // What is refracted, times eta^2, is the same both ways: f / eta^2 is reciprocal.
                const auto through = [](const BsdfResult& s) {
                    return double(s.pdf) * double(s.weight.x) * double(s.eta) * double(s.eta);
                };
                ASSERT_NEAR(through(out[all.size() + i]), through(in[all.size() + i]), 8.0 * error + 0x1p-20);
            }
        }
    }
}

TEST_F(DielectricTest, NothingIsRefractedBeyondTheCriticalAngle) {
    const double critical = std::asin(1.0 / 1.5);
    std::vector<vec3> beyond;
    for (const double angle : {critical + 1e-3, 1.0, 1.5, 1.57})
        beyond.emplace_back(std::sin(angle), 0.0, std::cos(angle));
    for (const uint32_t model : {MATERIAL_DIELECTRIC_SCHLICK, MATERIAL_DIELECTRIC_EXACT}) {
        for (const BsdfResult& s : run_both(model, 1.5f, beyond, 1)) {
            EXPECT_GT(s.wi.z, 0.0f);
            EXPECT_EQ(s.pdf, 1.0f);
        }
    }
}

// The share of random choices that reflect is what the density says, within 4 standard deviations.
TEST_F(DielectricTest, TheChoiceIsMadeWithItsProbability) {
    for (const vec3 wo : VIEWS) {
        const uint32_t count = 100000;
        double reflected = 0.0, R = 0.0;
        for (const BsdfResult& s : samples(dielectric(MATERIAL_DIELECTRIC_EXACT, 1.5f), wo, count, 30)) {
            if (s.wi.z < 0.0f) continue;
            ++reflected;
            R = double(s.pdf);
        }
        EXPECT_NEAR(reflected / count, R, 4.0 * std::sqrt(R * (1.0 - R) / count));
    }
}

TEST_F(DielectricTest, AMirrorReflectsIdeally) {
    const vec3 tint(0.9f, 0.5f, 0.0f);
    for (const vec3 wo : VIEWS) {
        const BsdfResult s =
            run({{.material = pack(mirror(tint)), .wo = wo, .wi = vec3(-wo.x, -wo.y, wo.z)}})[0];
        EXPECT_EQ(s.wi, vec3(-wo.x, -wo.y, wo.z));
        EXPECT_EQ(s.weight, tint);
        EXPECT_EQ(s.pdf, 1.0f);
        EXPECT_EQ(s.delta, 1u);
        EXPECT_EQ(s.eta, 1.0f);
        EXPECT_EQ(s.f, vec3(0.0f));
        EXPECT_EQ(s.pdf_of_wi, 0.0f);
    }
    EXPECT_EQ(run({{.material = pack(mirror(tint)), .wo = vec3(0, 0, -1)}})[0].pdf, 0.0f);
}

}  // namespace
}  // namespace candela
