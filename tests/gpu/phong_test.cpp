// The Phong model at every exponent: values against double precision, albedo, and how much its samples vary.
#include "gpu/bsdf_fixture.h"

namespace candela {
namespace {

const std::vector<float> EXPONENTS{0.0f, 1.0f, 10.0f, 100.0f, 1e3f, 1e4f, 1e5f};

class PhongTest : public BsdfTest {};

// At wi around the mirrored direction, down to where the lobe has exp(-20) left. h = |wi - mirrored|^2 / 2
// has the roundings of the chord, 3 * 2^-24 of itself (twice that of each difference, and the sum), the
// logarithm 11 more, the product 2: 2^-20 of the exponent, 20. All other operations are some 8 roundings.
TEST_F(PhongTest, ValuesAgreeWithDoublePrecision) {
    const vec3 kd(0.1f, 0.2f, 0.0f), ks(0.4f, 0.0f, 1.0f);
    for (const float n : EXPONENTS) {
        Random random(20);
        std::vector<BsdfItem> items;
        for (int i = 0; i < 20000; ++i) {
            vec3 wo = random.direction();
            wo.z = std::abs(wo.z);
            const float size = std::sqrt(40.0f / std::max(n, 20.0f)) * random.unit();
            const vec3 wi = normalize(vec3(-wo.x, -wo.y, wo.z) + size * random.direction());
            items.push_back({.material = pack(phong(kd, ks, n)), .wo = wo, .wi = wi});
        }
        const std::vector<BsdfResult> results = run(items);
        for (size_t i = 0; i < items.size(); ++i) {
            const glm::dvec3 wo = normalize(glm::dvec3(items[i].wo)), wi = normalize(glm::dvec3(items[i].wi));
            const glm::dvec3 chord = wi - glm::dvec3(-wo.x, -wo.y, wo.z);
            const double h = 0.5 * dot(chord, chord);
            const double exponent = h < 1.0 ? double(n) * std::log1p(-h) : 0.0;
            if (exponent < -20.0) continue;
            const double lobe = h < 1.0 ? std::exp(exponent) : 0.0;
            const glm::dvec3 f =
                glm::dvec3(kd) / M_PI + glm::dvec3(ks) * (double(n) + 2.0) / (2.0 * M_PI) * lobe;
            const double of_h = h < 1.0 ? double(n) * h / (1.0 - h) : 0.0;
            const double error = 5 * 0x1p-24 * of_h + 13 * 0x1p-24 * -exponent + 8 * 0x1p-24;
            for (const int c : {0, 1, 2}) {
                const double expected = wi.z > 0.0 ? f[c] : 0.0;
                ASSERT_NEAR(results[i].f[c], expected, expected * error) << n;
            }
        }
    }
}

// The lobe around the normal lies above the horizon, so that all of its reflection is included: (n + 2) / (2
// pi) cos^(n + 1) integrates to 1. The mean of the weights is the albedo within 4 of its standard deviations
// (one false alarm in 16 000, for each of 63 tests).
TEST_F(PhongTest, TheAlbedoAtNormalIncidenceIsTheSumOfBaseAndLobe) {
    const vec3 ks(0.4f, 0.8f, 0.1f);
    for (const float n : EXPONENTS) {
        for (const vec3 kd : {vec3(0.0f), vec3(0.5f, 0.2f, 0.9f), vec3(0.6f, 0.01f, 0.1f)}) {
            RunningMoments moments[3];
            for (const BsdfResult& s : samples(phong(kd, ks, n), VIEWS[0], 50000, 21)) {
                for (const int c : {0, 1, 2})
                    moments[c].add(double(s.weight[c]));
            }
            for (const int c : {0, 1, 2}) {
                const double deviation = std::sqrt(moments[c].variance_of_mean());
                EXPECT_NEAR(moments[c].mean(), double(kd[c]) + double(ks[c]), 4.0 * deviation + 0x1p-20)
                    << "n " << n;
            }
        }
    }
}

// What the lobe reflects of light from all around. With a = 1 - cos(alpha)^(n + 1), uniform over the lobe,
// and the angle b around it, (n + 2) / (2 pi) cos(alpha)^n d(wi) is (n + 2) / (n + 1) da db; what is below
// the horizon is excluded. The midpoint rule is good to 10^-5.
double lobe_albedo(vec3 wo, double n) {
    constexpr int ALONG = 512;
    const double cosine = double(wo.z), sine = std::sqrt(1.0 - cosine * cosine);
    double sum = 0.0;
    for (int i = 0; i < ALONG; ++i) {
        const double cos_alpha = std::pow(1.0 - (i + 0.5) / ALONG, 1.0 / (n + 1.0));
        const double sin_alpha = std::sqrt(1.0 - cos_alpha * cos_alpha);
        for (int k = 0; k < ALONG; ++k)
            sum += std::max(0.0,
                            cosine * cos_alpha + sine * sin_alpha * std::cos(2.0 * M_PI * (k + 0.5) / ALONG));
    }
    return (n + 2.0) / (n + 1.0) * sum / (ALONG * ALONG);
}

// The mean of the weights is that albedo and the base's. A weight is good to 2^-15.
TEST_F(PhongTest, TheAlbedoElsewhereIsThatOfQuadrature) {
    const vec3 ks(0.4f, 0.8f, 0.1f);
    const std::vector<vec3> kds{vec3(0.0f), vec3(0.5f, 0.2f, 0.9f)};
    const std::vector<vec3> views{VIEWS[1], normalize(vec3(1, 0, 0.3f)), VIEWS[2]};
    const double level = sidak_level(CHI_SQUARED_ALPHA, 3 * EXPONENTS.size() * kds.size() * views.size());
    uint32_t seed = 26;
    for (const vec3 wo : views) {
        for (const float n : EXPONENTS) {
            const double lobe = lobe_albedo(wo, double(n));
            for (const vec3 kd : kds) {
                RunningMoments moments[3];
                for (const BsdfResult& s : samples(phong(kd, ks, n), wo, 30000, seed++)) {
                    for (const int c : {0, 1, 2})
                        moments[c].add(double(s.weight[c]));
                }
                for (const int c : {0, 1, 2}) {
                    const double expected = double(kd[c]) + double(ks[c]) * lobe;
                    const double beyond =
                        std::max(0.0, std::abs(moments[c].mean() - expected) - 0x1p-15 * expected);
                    EXPECT_GT(normal_p_value(beyond / std::sqrt(moments[c].variance_of_mean())), level)
                        << "n " << n << ", cosine " << wo.z << ": " << moments[c].mean() << ", not "
                        << expected;
                }
            }
        }
    }
}

// Under a constant environment a sample contributes its weight, whose relative variance does not depend on
// how narrow the lobe is.
TEST_F(PhongTest, SamplesVaryAlikeAtEveryExponent) {
    for (const vec3 wo : {VIEWS[0], normalize(vec3(1, 0, 1))}) {
        double min = 1e9, greatest = 0.0;
        for (const float n : EXPONENTS) {
            RunningMoments moments;
            for (const BsdfResult& s : samples(phong(vec3(0.5f), vec3(0.5f), n), wo, 100000, 22))
                moments.add(double(s.weight.x));
            const double relative = 1.0 + moments.variance() / (moments.mean() * moments.mean());
            min = std::min(min, relative);
            greatest = std::max(greatest, relative);
        }
        EXPECT_LE(greatest, 1.5 * min);
    }
}

// Where nothing is left of a narrow lobe, the density is the base's, times the base's share of the luminance
// of both.
TEST_F(PhongTest, LobeAndBaseAreChosenByTheirAlbedo) {
    const vec3 kd(0.5f, 0.2f, 0.9f), ks(0.4f, 0.8f, 0.1f), rgb(0.2126f, 0.7152f, 0.0722f);
    const vec3 aside = normalize(vec3(1, 0, 1));
    const BsdfResult at_aside =
        run({{.material = pack(phong(kd, ks, 1e5f)), .wo = VIEWS[0], .wi = aside}})[0];
    const double fraction = double(dot(kd, rgb)) / (double(dot(kd, rgb)) + double(dot(ks, rgb)));
    EXPECT_NEAR(at_aside.pdf_of_wi, fraction * std::sqrt(0.5) / M_PI, 0x1p-21);
}

// A material without lobe or base samples the other one alone.
TEST_F(PhongTest, ALobeWithoutAlbedoIsNotSampled) {
    for (const BsdfResult& s : samples(phong(vec3(0.5f), vec3(0.0f), 1e5f), VIEWS[1], 10000, 23)) {
        ASSERT_NEAR(s.weight.x, 0.5, 0x1p-22);
        ASSERT_NEAR(s.pdf, s.wi.z / M_PI, 0x1p-23);
    }
    const glm::dvec3 mirrored(-VIEWS[1].x, -VIEWS[1].y, VIEWS[1].z);
    for (const BsdfResult& s : samples(phong(vec3(0.0f), vec3(0.5f), 1e5f), VIEWS[1], 10000, 24))
        ASSERT_LT(length(glm::dvec3(s.wi) - mirrored), 0.02);  // exp(-10^5 h) is 2 * 10^-9 there.
    for (const BsdfResult& s : samples(phong(vec3(0.0f), vec3(0.0f), 10.0f), VIEWS[1], 10000, 25))
        ASSERT_EQ(s.weight, vec3(0.0f));
}

}  // namespace
}  // namespace candela
