// No input makes a BSDF return a number that is not finite, a negative one, or a direction that is not a unit
// vector.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "base/text.h"
#include "gpu_scene/material_record.h"
#include "probe/probe.h"
#include "probe/random.h"
#include "selftest/bsdfs.h"

namespace candela {
namespace {

constexpr float LAST = 1.0f - 0x1p-24f;  // The largest random number.

// Random parameters, many of them extreme.
class Adversary {
  public:
    explicit Adversary(uint32_t seed) : random_(seed) {}

    BsdfItem item(uint32_t model) {
        BsdfItem item = bsdf_item(material(model), direction(), direction());
        const vec3 mirrored(-item.wo.x, -item.wo.y, item.wo.z);
        const uint32_t choice = random_.bits() % 8;
        if (choice == 0) item.wi = mirrored;
        if (choice == 1) item.wi = -item.wo;
        if (choice == 2) item.wi = normalize(mirrored + 1e-3f * random_.direction());
        item.u.x = number();
        item.u.y = number();
        item.uc = number();
        item.back = random_.bits() % 2;
        return item;
    }

  private:
    // Numbers of all sizes from `lo` to `hi`; one in four is `lo` or `hi`.
    float of_any_size(float lo, float hi) {
        if (random_.bits() % 4 == 0) return random_.bits() % 2 == 0 ? lo : hi;
        return std::clamp(lo * std::pow(hi / lo, random_.unit()), lo, hi);
    }
    // In [0, 1], often one of the ends.
    float fraction() {
        const uint32_t choice = random_.bits() % 6;
        return choice == 0 ? 0.0f : choice == 1 ? 1.0f : random_.unit();
    }
    vec3 fractions() {
        const float x = fraction(), y = fraction();
        return {x, y, fraction()};
    }
    // In [0, 1), often one of the ends.
    float number() { return std::min(fraction(), LAST); }

    ProbedMaterial material(uint32_t model) {
        switch (model) {
            case MATERIAL_DIFFUSE:
                return diffuse(fractions());
            case MATERIAL_PHONG: {
                const vec3 ks = fractions();
                const float n = random_.bits() % 8 == 0 ? 0.0f : of_any_size(1e-3f, 1e5f);
                return phong((vec3(1.0f) - ks) * fractions(), ks, n);
            }
            case MATERIAL_MIRROR:
                return mirror(fractions());
            case MATERIAL_CONDUCTOR:
                return conductor(fractions(), of_any_size(1e-3f, 1.0f));
            case MATERIAL_DIELECTRIC_SCHLICK:
            case MATERIAL_DIELECTRIC_EXACT:
                return dielectric(model, random_.bits() % 8 == 0 ? 1.0f : of_any_size(0.1f, 10.0f));
            case MATERIAL_DIFFUSE_TRANSMISSION: {
                const vec3 reflectance = fractions();
                return diffuse_transmission(reflectance, (vec3(1.0f) - reflectance) * fractions());
            }
            case MATERIAL_PHASE:
                return phase((random_.bits() % 2 == 0 ? 1.0f : -1.0f) * (1.0f - of_any_size(1e-3f, 1.0f)));
            case MATERIAL_PRINCIPLED:
                return principled(layers());
            case MATERIAL_UNLIT:
                return encode_material(PrincipledMaterial{.base_color = fractions(), .unlit = true}).record;
            default:
                assert(false);
                return {};
        }
    }
    PrincipledMaterial layers() {
        PrincipledMaterial m{.base_color = fractions(),
                             .metalness = fraction(),
                             .roughness = fraction(),
                             .diffuse_roughness = fraction(),
                             .ior = random_.bits() % 8 == 0 ? 0.0f : of_any_size(1.0f, 10.0f),
                             .specular = fraction(),
                             .specular_color = fractions(),
                             .anisotropy = fraction(),
                             .transmission = fraction(),
                             .dispersion = fraction(),
                             .diffuse_transmission = fraction(),
                             .diffuse_transmission_color = fractions(),
                             .coat = fraction(),
                             .coat_roughness = fraction(),
                             .coat_ior = of_any_size(1.0f, 3.0f),
                             .coat_darkening = fraction(),
                             .sheen_color = fractions(),
                             .sheen_roughness = fraction(),
                             .fuzz = fraction(),
                             .fuzz_color = fractions(),
                             .fuzz_roughness = fraction(),
                             .iridescence = fraction(),
                             .iridescence_ior = of_any_size(1.0f, 3.0f),
                             .iridescence_thickness = of_any_size(1.0f, 2000.0f)};
        if (random_.bits() % 2 == 0) m.inside = Medium{};
        return m;
    }
    // Anywhere on the sphere; in the surface, or just above or below it; along an axis.
    vec3 direction() {
        vec3 w = random_.direction();
        const uint32_t choice = random_.bits() % 8;
        if (choice < 4) return w;
        if (choice == 4) w.z = 0.0f;
        if (choice == 5) w.z = std::copysign(std::exp2(-40.0f * random_.unit()), w.z);
        if (choice == 6) w = vec3(1e-4f, 1e-4f, 1.0f) * w;
        if (choice == 7) {
            const uint32_t axis = random_.bits() % 3;
            w = vec3(0.0f);
            w[int(axis)] = random_.bits() % 2 == 0 ? -1.0f : 1.0f;
        }
        return normalize(w);
    }

    Random random_;
};

bool is_sound(vec3 v) {
    return is_finite(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f;
}

bool is_sound(const BsdfResult& s) {
    const bool densities = is_sound(vec3(s.pdf, s.pdf_of_sample, s.pdf_of_wi));
    const bool values = is_sound(s.weight) && is_sound(s.f_of_sample) && is_sound(s.f);
    const bool unit = std::abs(length(glm::dvec3(s.wi)) - 1.0) <= 0x1p-20;
    return densities && values && unit && is_finite(vec3(s.eta)) && s.eta > 0.0f;
}

}  // namespace

Evidence test_soundness(const vk::Device& device, uint32_t model, size_t count, uint32_t seed) {
    Adversary adversary(seed);
    std::vector<BsdfItem> items;
    for (size_t i = 0; i < count; ++i)
        items.push_back(adversary.item(model));
    const std::vector<BsdfResult> results = probe<BsdfResult>(device, kernels::bsdf, items);
    Evidence evidence;
    const bool scatters = std::ranges::any_of(results, [](const BsdfResult& s) { return s.pdf > 0.0f; });
    evidence.expect(scatters == (model != MATERIAL_UNLIT),
                    [&] { return concat("model ", model, scatters ? " scatters" : ": no sample succeeds"); });
    for (size_t i = 0; i < count; ++i) {
        const BsdfItem& it = items[i];
        const BsdfResult& s = results[i];
        evidence.expect(is_sound(s), [&] {
            return concat("model ", model, ", parameter ", std::bit_cast<float>(it.material[1].w), ", wo ",
                          it.wo.x, ' ', it.wo.y, ' ', it.wo.z, ", u ", it.u.x, ' ', it.u.y, ' ', it.uc,
                          "; wi ", s.wi.x, ' ', s.wi.y, ' ', s.wi.z, ", weight ", s.weight.x, ", pdf ", s.pdf,
                          ", f ", s.f_of_sample.x, ", for another wi ", s.f.x, ", ", s.pdf_of_wi);
        });
    }
    return evidence;
}

}  // namespace candela
