// Tests BSDFs on the device: their samples against their densities and values, and adversarial input.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "probe/probes.h"
#include "scene/principled.h"
#include "selftest/charts.h"
#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

MaterialRecord diffuse(vec3 reflectance);
MaterialRecord phong(vec3 kd, vec3 ks, float n);
MaterialRecord mirror(vec3 reflectance);
MaterialRecord conductor(vec3 reflectance, float alpha);
// `model` is one of MATERIAL_DIELECTRIC_*; `eta` is the index behind the surface divided by that in front of
// it.
MaterialRecord dielectric(uint32_t model, float eta);
MaterialRecord diffuse_transmission(vec3 reflectance, vec3 transmittance);
// A point in a medium, whose phase function has the mean cosine g.
MaterialRecord phase(float g);

// The records of a material.
struct ProbedMaterial {
    MaterialRecord record{};
    PrincipledRecord principled{};

    ProbedMaterial() = default;
    ProbedMaterial(const MaterialRecord& r) : record(r) {}  // Implicit: most materials have only this record.
    ProbedMaterial(const MaterialRecord& r, const PrincipledRecord& p) : record(r), principled(p) {}
};
// With a medium behind the surface if the material has one.
ProbedMaterial principled(const PrincipledMaterial& m);

// An item for that material. `back` is 1 if wo is on the back side of the surface.
BsdfItem bsdf_item(const ProbedMaterial& material, vec3 wo, vec3 wi = vec3(0, 0, 1), uint32_t back = 0);

// Head-on, oblique and grazing.
inline const std::vector<vec3> VIEWS{vec3(0, 0, 1), normalize(vec3(1, 0.5, 1)), normalize(vec3(-1, 2, 0.01))};

// A material whose BSDF is not a delta distribution, seen from wo, and a chart that resolves its samples.
struct BsdfCase {
    std::string name;
    ProbedMaterial material;
    vec3 wo;
    std::variant<SphereChart, LobeChart, ForwardChart, FacetChart, RefractionChart> chart;
    uint32_t back = 0;  // 1: wo is on the back side of the surface.
};
std::vector<BsdfCase> bsdf_cases();
// The cases of the principled material: each of its lobes, and mixtures.
std::vector<BsdfCase> principled_cases();

// BSDF_CASE_SAMPLES random samples of a case. The items' wi are the points of its chart, row by row. A
// principled material has the same random facets in all samples, and so one density; if `any_facets`,
// different facets in each sample, and so its albedo on average.
std::vector<BsdfResult> run_bsdf_case(const vk::Device& device, const BsdfCase& c, uint32_t seed,
                                      bool any_facets = false);
inline constexpr size_t BSDF_CASE_SAMPLES = size_t{320} * 320;

// Pearson's test of the samples against their density. `results` as run_bsdf_case() returns them.
void test_density(const BsdfCase& c, const std::vector<BsdfResult>& results, Evidence& evidence);
// Directions must be unit vectors, densities and weights must match the BSDF, and no energy may be gained.
void test_values(const BsdfCase& c, const std::vector<BsdfResult>& results, Evidence& evidence);

// Takes `count` samples of a model (MATERIAL_*) with random and extreme parameters, directions and random
// numbers. Results must be finite and not negative, and directions unit vectors.
Evidence test_soundness(const vk::Device& device, uint32_t model, size_t count, uint32_t seed);

}  // namespace candela
