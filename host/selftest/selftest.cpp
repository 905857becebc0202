// See selftest.h: the list of checks, and how each is judged.
#include "selftest/selftest.h"

#include <chrono>

#include "base/statistics.h"
#include "selftest/bsdfs.h"
#include "selftest/exponentials.h"
#include "selftest/images.h"
#include "selftest/lights.h"
#include "selftest/records.h"
#include "selftest/samplers.h"
#include "selftest/scenes.h"
#include "selftest/skies.h"
#include "selftest/spheres.h"
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

Evidence test_all_records(const vk::Device& device) {
    Evidence evidence = test_records(device, SceneAccess::texel_buffers);
    evidence.add(test_records(device, SceneAccess::storage_buffers));
    evidence.add(test_octahedral_normals(device));
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

Evidence test_extreme_bsdfs(const vk::Device& device) {
    Evidence evidence;
    for (const uint32_t model : {MATERIAL_DIFFUSE, MATERIAL_PHONG, MATERIAL_MIRROR, MATERIAL_CONDUCTOR,
                                 MATERIAL_DIELECTRIC_SCHLICK, MATERIAL_DIELECTRIC_EXACT})
        evidence.add(test_soundness(device, model, 100000, 40 + model));
    return evidence;
}

Evidence test_flat_lights(const vk::Device& device) {
    Evidence evidence = test_flat_light_points(device);
    evidence.add(test_flat_light_values(device, SceneAccess::texel_buffers));
    evidence.add(test_flat_light_values(device, SceneAccess::storage_buffers));
    return evidence;
}

Evidence test_round_lights(const vk::Device& device) {
    Evidence evidence = test_spheres_from_outside(device);
    evidence.add(test_spheres_from_inside(device));
    evidence.add(test_disks(device));
    return evidence;
}

Evidence test_skies(const vk::Device& device) {
    Evidence evidence = test_sky_lookup(device);
    evidence.add(test_sky_samples(device));
    evidence.add(test_choice_of_sky(device));
    return evidence;
}

Evidence test_warps(const vk::Device& device) {
    Evidence evidence = test_basic_warps(device);
    evidence.add(test_power_cosines(device));
    evidence.add(test_sphere_and_cones(device));
    evidence.add(test_polygons(device));
    evidence.add(test_visible_normals(device));
    return evidence;
}

Evidence test_exponential_functions(const vk::Device& device) {
    Evidence evidence = test_logarithm(device);
    evidence.add(test_exponentials(device));
    return evidence;
}

Evidence test_round_shapes(const vk::Device& device) {
    Evidence evidence = test_rays_outside_spheres(device);
    evidence.add(test_rays_within_spheres(device));
    evidence.add(test_points_on_spheres(device));
    evidence.add(test_rays_at_disks(device));
    return evidence;
}

struct Row {
    const char* name;
    const char* unit;
    Evidence (*test)(const vk::Device&);
};

constexpr Row ROWS[] = {
    {"hashes", "values", test_integer_functions},
    {"samplers", "pairs", test_all_samplers},
    {"exp and log", "values", test_exponential_functions},
    {"records", "values", test_all_records},
    {"rays in closed meshes", "rays", test_closed_meshes},
    {"rays at nasty meshes", "rays", test_nasty_mesh},
    {"rays at spheres", "rays", test_round_shapes},
    {"warps", "samples", test_warps},
    {"BSDFs", "samples", test_bsdfs},
    {"BSDFs at extremes", "samples", test_extreme_bsdfs},
    {"flat lights", "samples", test_flat_lights},
    {"round lights", "samples", test_round_lights},
    {"skies", "samples", test_skies},
    {"furnace", "images", test_furnace},
    {"bsdf = light = mis", "images", test_estimators},
    {"identical bits", "images", test_identical_bits},
    {"Cornell box", "images", test_cornell_box},
};

}  // namespace

std::vector<Check> selftest_checks(const vk::Device& device) {
    std::vector<Check> checks;
    for (const Row& row : ROWS)
        checks.push_back({row.name, row.unit, [&device, test = row.test] { return test(device); }});
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
