// The principled material: each of its lobes alone, and mixtures of them.
#include <cmath>
#include <utility>

#include "base/text.h"
#include "gpu_scene/material_record.h"
#include "selftest/bsdfs.h"

namespace candela {
namespace {

// The name of a case, and the lobe that its chart must resolve.
enum class Lobe { wide, reflection, refraction };
struct NamedMaterial {
    const char* name;
    PrincipledMaterial material;
    Lobe lobe = Lobe::wide;
};

constexpr Medium CLEAR{};

std::vector<NamedMaterial> single_lobes() {
    const vec3 orange(0.9f, 0.6f, 0.3f);
    return {
        {"metal", {.base_color = orange, .metalness = 1.0f, .roughness = 0.04f}, Lobe::reflection},
        {"metal", {.base_color = orange, .metalness = 1.0f, .roughness = 0.3f}, Lobe::reflection},
        {"metal", {.base_color = vec3(1.0f), .metalness = 1.0f, .roughness = 1.0f}, Lobe::reflection},
        {"brushed metal",
         {.base_color = orange, .metalness = 1.0f, .roughness = 0.5f, .anisotropy = 0.6f},
         Lobe::reflection},
        {"dielectric alone", {.base_color = vec3(0.0f), .roughness = 0.3f}, Lobe::reflection},
        {"diffuse base", {.base_color = orange, .roughness = 0.8f, .specular = 0.0f}},
        {"rough diffuse base", {.base_color = orange, .diffuse_roughness = 0.7f, .specular = 0.0f}},
        {"thin glass", {.base_color = orange, .roughness = 0.6f, .transmission = 1.0f}},
        {"smooth glass",
         {.base_color = vec3(1.0f), .roughness = 0.1f, .transmission = 1.0f, .inside = CLEAR},
         Lobe::refraction},
        {"rough glass",
         {.base_color = vec3(1.0f), .roughness = 0.6f, .transmission = 1.0f, .inside = CLEAR},
         Lobe::refraction},
        {"rougher glass",
         {.base_color = vec3(1.0f), .roughness = 1.0f, .transmission = 1.0f, .inside = CLEAR},
         Lobe::refraction},
        {"brushed glass",
         {.roughness = 0.55f, .anisotropy = 0.7f, .transmission = 1.0f, .inside = CLEAR},
         Lobe::refraction},
        {"prism",
         {.roughness = 0.7f, .transmission = 1.0f, .inside = CLEAR, .dispersion = 4.0f},
         Lobe::refraction},
        {"leaf",
         {.base_color = orange,
          .roughness = 0.7f,
          .diffuse_transmission = 0.6f,
          .diffuse_transmission_color = vec3(0.2f, 0.9f, 0.4f)}},
        {"sheen",
         {.base_color = vec3(0.0f), .specular = 0.0f, .sheen_color = orange, .sheen_roughness = 0.5f}},
        {"fuzz",
         {.base_color = vec3(0.0f),
          .specular = 0.0f,
          .fuzz = 1.0f,
          .fuzz_color = orange,
          .fuzz_roughness = 0.3f}},
        {"coat",
         {.base_color = vec3(0.0f), .specular = 0.0f, .coat = 1.0f, .coat_roughness = 0.4f},
         Lobe::reflection},
        {"film", {.base_color = vec3(0.0f), .roughness = 0.5f, .iridescence = 1.0f}, Lobe::reflection},
    };
}

std::vector<NamedMaterial> mixtures() {
    const vec3 orange(0.9f, 0.6f, 0.3f);
    return {
        {"plastic", {.base_color = orange, .roughness = 0.8f}},
        {"half a metal", {.base_color = orange, .metalness = 0.5f, .roughness = 0.6f, .specular = 0.5f}},
        {"half a glass",
         {.base_color = orange, .roughness = 0.6f, .transmission = 0.5f, .inside = CLEAR},
         Lobe::refraction},
        {"all layers",
         {.base_color = orange,
          .metalness = 0.3f,
          .roughness = 0.7f,
          .diffuse_roughness = 0.5f,
          .specular = 0.8f,
          .specular_color = vec3(0.4f, 0.9f, 1.0f),
          .anisotropy = 0.4f,
          .transmission = 0.4f,
          .inside = CLEAR,
          .dispersion = 1.0f,
          .diffuse_transmission = 0.3f,
          .coat = 0.7f,
          .coat_roughness = 0.6f,
          .coat_darkening = 0.5f,
          .sheen_color = vec3(0.5f, 0.2f, 0.1f),
          .sheen_roughness = 0.6f,
          .fuzz = 0.4f,
          .fuzz_color = vec3(0.3f, 0.6f, 0.9f),
          .fuzz_roughness = 0.4f,
          .iridescence = 0.5f}},
    };
}

}  // namespace

ProbedMaterial principled(const PrincipledMaterial& m) {
    const EncodedMaterial encoded = encode_material(m);
    return {encoded.record, encoded.principled.value().record};
}

std::vector<BsdfCase> principled_cases() {
    std::vector<BsdfCase> cases;
    std::vector<NamedMaterial> materials = single_lobes();
    for (const NamedMaterial& m : mixtures())
        materials.push_back(m);
    for (const auto& [name, material, lobe] : materials) {
        for (const vec3 wo : VIEWS) {
            for (const uint32_t back : {0u, 1u}) {
                if (back == 1 && !material.inside) continue;
                BsdfCase c{concat("principled: ", name, ' ', material.roughness.factor,
                                  back == 1 ? " from inside" : "", ", cosine ", wo.z),
                           principled(material), wo, SphereChart(), back};
                // The roughness along x, which is the greater.
                const double alpha =
                    std::lerp(double(material.roughness.factor) * double(material.roughness.factor), 1.0,
                              double(material.anisotropy.factor) * double(material.anisotropy.factor));
                const double coat =
                    double(material.coat_roughness.factor) * double(material.coat_roughness.factor);
                if (lobe == Lobe::reflection) c.chart = FacetChart(glm::dvec3(wo), coat > 0.0 ? coat : alpha);
                if (lobe == Lobe::refraction) {
                    const double ior = double(material.ior);
                    c.chart = RefractionChart(glm::dvec3(wo), alpha, back == 1 ? 1.0 / ior : ior);
                }
                cases.push_back(std::move(c));
            }
        }
    }
    return cases;
}

}  // namespace candela
