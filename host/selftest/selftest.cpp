// See selftest.h: the list of checks, and their verdicts.
#include "selftest/selftest.h"

#include <chrono>

#include "base/statistics.h"
#include "probe/scenes.h"
#include "selftest/bsdfs.h"
#include "selftest/exponentials.h"
#include "selftest/images.h"
#include "selftest/lights.h"
#include "selftest/media.h"
#include "selftest/records.h"
#include "selftest/samplers.h"
#include "selftest/skies.h"
#include "selftest/spheres.h"
#include "selftest/textures.h"
#include "selftest/traversal.h"
#include "selftest/warps.h"
#include "shared/constants.h"
#include "shared/material.h"

namespace candela {
namespace {

Evidence test_all_samplers(const vk::Device& device) {
    Evidence evidence;
    for (const uint32_t sampler : {SAMPLER_INDEPENDENT, SAMPLER_STRATIFIED, SAMPLER_SOBOL})
        evidence.add(test_sampler(device, sampler));
    return evidence;
}

Evidence test_bsdfs(const vk::Device& device) {
    Evidence evidence;
    uint32_t seed = 700;
    for (const BsdfCase& c : bsdf_cases()) {
        const std::vector<BsdfResult> results = run_bsdf_case(device, c, seed++);
        test_density(c, results, evidence);
        test_values(c, results, evidence);
    }
    return evidence;
}

Evidence test_layers(const vk::Device& device) {
    constexpr size_t EVERY = 5;  // The tests in tests/gpu use all.
    Evidence evidence;
    uint32_t seed = 1700;
    const std::vector<BsdfCase> cases = principled_cases();
    for (size_t i = 0; i < cases.size(); i += EVERY) {
        test_density(cases[i], run_bsdf_case(device, cases[i], seed++), evidence);
        test_values(cases[i], run_bsdf_case(device, cases[i], seed++, true), evidence);
    }
    return evidence;
}

Evidence test_extreme_bsdfs(const vk::Device& device) {
    Evidence evidence;
    for (uint32_t model = 0; model < MATERIAL_COUNT; ++model)
        evidence.add(test_soundness(device, model, 100000, 40 + model));
    return evidence;
}

// A test of how kernels read the scene, through both kinds of buffers.
template <Evidence (*test)(const vk::Device&, SceneAccess)>
Evidence through_both_buffers(const vk::Device& device) {
    Evidence evidence = test(device, SceneAccess::texel_buffers);
    evidence.add(test(device, SceneAccess::storage_buffers));
    return evidence;
}

Evidence test_some_textures(const vk::Device& device, SceneAccess access) {
    return test_textures(device, access, 100000);
}

// A test that is the same for every effort: it has no random part, or needs hardly any time.
template <Evidence (*test)(const vk::Device&)>
Evidence always(const vk::Device& device, Effort) {
    return test(device);
}

// A check, made of one test or several.
struct Row {
    const char* name;
    const char* unit;
    std::vector<Evidence (*)(const vk::Device&, Effort)> tests;
};

std::vector<Row> rows() {
    return {
        {"hashes", "values", {always<test_integer_functions>}},
        {"samplers", "pairs", {always<test_all_samplers>}},
        {"exp and log", "values", {always<test_logarithm>, always<test_exponentials>}},
        {"records", "values", {always<through_both_buffers<test_records>>, always<test_octahedral_normals>}},
        {"rays in closed meshes", "rays", {test_closed_meshes}},
        {"rays at nasty meshes", "rays", {test_nasty_mesh}},
        {"rays at spheres",
         "rays",
         {test_rays_outside_spheres, test_rays_within_spheres, test_points_on_spheres, test_rays_at_disks}},
        {"textures", "look-ups", {always<through_both_buffers<test_some_textures>>}},
        {"warps",
         "samples",
         {always<test_basic_warps>, always<test_power_cosines>, always<test_sphere_and_cones>,
          always<test_polygons>, always<test_pixel_filters>, always<test_visible_normals>}},
        {"BSDFs", "samples", {always<test_bsdfs>}},
        {"layered BSDFs", "samples", {always<test_layers>}},
        {"BSDFs at extremes", "samples", {always<test_extreme_bsdfs>}},
        {"media", "samples", {always<test_distances>}},
        {"flat lights",
         "samples",
         {test_flat_light_points, always<through_both_buffers<test_flat_light_values>>}},
        {"round lights", "samples", {test_spheres_from_outside, test_spheres_from_inside, test_disks}},
        {"punctual lights", "samples", {test_punctual_lights}},
        {"skies", "samples", {always<test_sky_lookup>, test_sky_samples, test_choice_of_sky}},
        {"furnace", "images", {test_furnace}},
        {"bsdf = light = mis", "images", {test_estimators}},
        {"identical bits", "images", {always<test_identical_bits>}},
        {"Cornell box", "images", {test_cornell_box}},
    };
}

}  // namespace

std::vector<Check> selftest_checks(const vk::Device& device, Effort effort) {
    std::vector<Check> checks;
    for (const Row& row : rows()) {
        const auto run = [&device, effort, tests = row.tests] {
            Evidence evidence;
            for (const auto& test : tests)
                evidence.add(test(device, effort));
            return evidence;
        };
        checks.push_back({row.name, row.unit, run});
    }
    return checks;
}

double check_level(size_t checks) {
    return sidak_level(SELFTEST_ALPHA, checks);
}

CheckResult run_check(const Check& check, double level) {
    CheckResult result{.name = check.name, .unit = check.unit, .evidence = {}, .error = {}};
    const auto start = std::chrono::steady_clock::now();
    try {
        result.evidence = check.run();
        result.passed = result.evidence.passes(level);
    } catch (const Error& error) {
        result.error = error;
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace candela
