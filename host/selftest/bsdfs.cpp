// BSDFs that are not delta distributions: samples follow the density, weights are f cos / pdf, and no energy
// is gained.
#include "selftest/bsdfs.h"

#include <cmath>
#include <utility>

#include "base/statistics.h"
#include "base/text.h"
#include "gpu_scene/material_record.h"
#include "probe/probe.h"
#include "probe/random.h"
#include "selftest/histogram.h"

namespace candela {
namespace {

// Cells of equal size in a chart, BSDF_FINE^2 points in each.
constexpr size_t BSDF_CELLS = 16, BSDF_FINE = 20;
constexpr size_t BSDF_ALONG = BSDF_CELLS * BSDF_FINE;
static_assert(BSDF_ALONG * BSDF_ALONG == BSDF_CASE_SAMPLES);
constexpr size_t BSDF_REST = BSDF_CELLS * BSDF_CELLS;  // Samples in no cell.

ChartPoint point_of(const BsdfCase& c, size_t i) {
    const size_t row = i / BSDF_ALONG, column = i % BSDF_ALONG;
    const double a = (double(row) + 0.5) / BSDF_ALONG, b = (double(column) + 0.5) / BSDF_ALONG;
    return std::visit([&](const auto& chart) { return chart.at(a, b); }, c.chart);
}

size_t cell_of(const BsdfCase& c, const Histogram& cells, vec3 w) {
    const auto at = std::visit([&](const auto& chart) { return chart.find(glm::dvec3(w)); }, c.chart);
    return at ? cells.cell(at->x, at->y) : BSDF_REST;
}

// One-sided: the probability of a mean at least this far above 1, beyond rounding, if the expectation is 1.
double p_value_of_gain(double mean, double variance, double rounding) {
    const double excess = mean - 1.0 - rounding;
    if (excess <= 0.0) return 1.0;
    return variance > 0.0 ? 0.5 * normal_p_value(excess / std::sqrt(variance)) : 0.0;
}

}  // namespace

MaterialRecord diffuse(vec3 reflectance) {
    return encode_material(DiffuseMaterial{reflectance}).record;
}

MaterialRecord phong(vec3 kd, vec3 ks, float n) {
    return encode_material(PhongMaterial{kd, ks, n}).record;
}

MaterialRecord mirror(vec3 reflectance) {
    return encode_material(MirrorMaterial{reflectance}).record;
}

MaterialRecord conductor(vec3 reflectance, float alpha) {
    return encode_material(ConductorMaterial{reflectance, alpha}).record;
}

MaterialRecord dielectric(uint32_t model, float eta) {
    const Fresnel fresnel = model == MATERIAL_DIELECTRIC_EXACT ? Fresnel::exact : Fresnel::schlick;
    return encode_material(DielectricMaterial{.ior = eta, .fresnel = fresnel, .inside{}}).record;
}

MaterialRecord diffuse_transmission(vec3 reflectance, vec3 transmittance) {
    return encode_material(DiffuseTransmissionMaterial{reflectance, transmittance, {}}).record;
}

MaterialRecord phase(float g) {
    return {.model = MATERIAL_PHASE, .medium = MEDIUM_SAME, .base = vec3(1.0f), .specular{}, .parameter = g};
}

BsdfItem bsdf_item(const ProbedMaterial& material, vec3 wo, vec3 wi, uint32_t back) {
    return {.material = pack(material.record),
            .wo = wo,
            .wi = wi,
            .back = back,
            .principled = pack(material.principled)};
}

std::vector<BsdfCase> bsdf_cases() {
    std::vector<BsdfCase> cases;
    for (const vec3 wo : VIEWS) {
        const std::string view = concat(", cosine ", wo.z);
        const auto add = [&](const std::string& name, const MaterialRecord& material, const auto& chart) {
            cases.push_back({name + view, material, wo, chart, 0});
        };
        const glm::dvec3 mirrored(-wo.x, -wo.y, wo.z);
        for (const vec3 colour : {vec3(1.0f), vec3(0.8f, 0.3f, 0.0f)})
            add("diffuse", diffuse(colour), SphereChart());
        for (const vec3 kd : {vec3(0.0f), vec3(0.5f, 0.2f, 0.4f)}) {
            const vec3 ks(0.4f, 0.8f, 0.1f);
            for (const float n : {0.0f, 1.0f, 7.5f})
                add(concat("phong ", n), phong(kd, ks, n), SphereChart());
            for (const float n : {100.0f, 1e3f, 1e4f, 1e5f})
                add(concat("phong ", n), phong(kd, ks, n), LobeChart(mirrored, n));
        }
        for (const vec3 transmittance : {vec3(0.0f), vec3(0.1f, 0.6f, 0.5f)}) {
            for (const vec3 reflectance : {vec3(0.0f), vec3(0.9f, 0.3f, 0.2f)})
                add("diffuse transmission", diffuse_transmission(reflectance, transmittance), SphereChart());
        }
        add("phong without a lobe", phong(vec3(0.7f, 0.2f, 0.0f), vec3(0.0f), 50.0f), SphereChart());
        for (const float alpha : {1e-3f, 0.01f, 0.1f, 0.5f, 1.0f})
            add(concat("conductor ", alpha), conductor(vec3(0.9f, 0.6f, 0.3f), alpha),
                FacetChart(glm::dvec3(wo), alpha));
    }
    for (const float g : {0.0f, 0.3f, -0.6f, 0.9f, -0.99f, 0.999f})
        cases.push_back({concat("phase ", g), phase(g), vec3(0, 0, 1), ForwardChart(double(g)), 0});
    return cases;
}

std::vector<BsdfResult> run_bsdf_case(const vk::Device& device, const BsdfCase& c, uint32_t seed,
                                      bool any_facets) {
    Random random(seed);
    std::vector<BsdfItem> items(BSDF_CASE_SAMPLES, bsdf_item(c.material, c.wo, {}, c.back));
    for (size_t i = 0; i < items.size(); ++i) {
        items[i].wi = vec3(point_of(c, i).w);
        items[i].u = random.square();
        items[i].uc = random.unit();
        items[i].random = any_facets ? uint32_t(i) : seed;
    }
    return probe<BsdfResult>(device, kernels::bsdf, items);
}

// Integrates the density over each cell by the midpoint rule. One more cell has the remainder to 1: cells
// that the horizon crosses, where the density jumps to 0; directions outside the chart; and samples that
// failed.
void test_density(const BsdfCase& c, const std::vector<BsdfResult>& results, Evidence& evidence) {
    std::vector<double> expected(BSDF_REST + 1), counts(BSDF_REST + 1);
    std::vector<bool> above(BSDF_REST + 1, true);
    const Histogram cells(BSDF_CELLS);
    for (size_t i = 0; i < results.size(); ++i) {
        const size_t cell = i / BSDF_ALONG / BSDF_FINE * BSDF_CELLS + i % BSDF_ALONG / BSDF_FINE;
        const double solid_angle = point_of(c, i).solid_angle / double(results.size());
        expected[cell] += double(results[i].pdf_of_wi) * solid_angle;
        above[cell] = above[cell] && results[i].pdf_of_wi > 0.0f;
        ++counts[results[i].pdf > 0.0f ? cell_of(c, cells, results[i].wi) : BSDF_REST];
    }
    expected[BSDF_REST] = 1.0;
    for (size_t cell = 0; cell < BSDF_REST; ++cell) {
        if (above[cell]) {
            expected[BSDF_REST] -= expected[cell];
        } else {
            expected[cell] = 0.0;
            counts[BSDF_REST] += std::exchange(counts[cell], 0.0);
        }
    }
    // If there is no remainder, the rest is the error of the integral: a few times 10^-4.
    const double rest = expected[BSDF_REST];
    evidence.expect(rest >= -1e-3, [&] { return concat(c.name, ": the density adds up to ", 1.0 - rest); });
    if (!(rest >= 1e-3)) {
        evidence.expect(counts[BSDF_REST] <= 2e-3 * double(results.size()), [&] {
            return concat(c.name, ": ", counts[BSDF_REST], " samples are where the density leaves no room");
        });
        expected[BSDF_REST] = counts[BSDF_REST] = 0.0;
    }
    evidence.add_p_value(c.name, pearson_p_value(counts, expected));
}

// Phong: the exponent of the lobe is below 17 where it was sampled (u >= 2^-24) and has the roundings of the
// chord and of the logarithm, 12 * 2^-24 of itself: the lobe is off by 2^-16 of itself. Conductor: the
// relative error of F is 5 times that of its cosine, which has a few roundings, so that the weight is off by
// 2^-19 of itself. Everything else has about a dozen roundings.
void test_values(const BsdfCase& c, const std::vector<BsdfResult>& results, Evidence& evidence) {
    glm::dvec3 albedo(0.0), squares(0.0);
    const uint32_t model = c.material.record.model;
    for (const BsdfResult& s : results) {
        bool holds = s.delta == 0 && (s.eta == 1.0f || model == MATERIAL_PRINCIPLED);
        if (s.pdf != 0.0f) {  // Otherwise the sample failed.
            const bool transmits = model == MATERIAL_DIFFUSE_TRANSMISSION || model == MATERIAL_PRINCIPLED ||
                                   model == MATERIAL_PHASE;
            const double cosine = model == MATERIAL_PHASE ? 1.0 : std::abs(double(s.wi.z));
            holds = holds && std::abs(length(glm::dvec3(s.wi)) - 1.0) <= 0x1p-20 &&
                    (s.wi.z > 0.0f || transmits) &&
                    std::abs(double(s.pdf) - double(s.pdf_of_sample)) <= double(s.pdf) * 0x1p-15;
            for (const int i : {0, 1, 2}) {
                const double weight = double(s.f_of_sample[i]) * cosine / double(s.pdf_of_sample);
                holds = holds && std::abs(double(s.weight[i]) - weight) <= weight * 0x1p-15 + 0x1p-19;
            }
            // Refraction divides radiance by eta^2, but does not change energy.
            const glm::dvec3 fraction = glm::dvec3(s.weight) * (double(s.eta) * double(s.eta));
            albedo += fraction;
            squares += fraction * fraction;
        }
        evidence.expect(holds, [&] {
            return concat(c.name, ": wi ", s.wi.x, ' ', s.wi.y, ' ', s.wi.z, ", pdf ", s.pdf, " and ",
                          s.pdf_of_sample, ", weight ", s.weight.x, ' ', s.weight.y, ' ', s.weight.z, ", f ",
                          s.f_of_sample.x, ' ', s.f_of_sample.y, ' ', s.f_of_sample.z, ", delta ", s.delta,
                          ", eta ", s.eta);
        });
    }
    // No more light leaves than arrives. In the principled material, lobes and the facets' losses add up to
    // 1, with some dozens of roundings, which are as coarse as Vulkan allows.
    const double rounding = model == MATERIAL_PRINCIPLED ? 0x1p-16 : 0x1p-20;
    const auto count = double(results.size());
    for (const int i : {0, 1, 2}) {
        const double mean = albedo[i] / count;
        const double variance = (squares[i] / count - mean * mean) / count;
        evidence.add_p_value(concat(c.name, ": albedo ", mean), p_value_of_gain(mean, variance, rounding));
    }
}

}  // namespace candela
