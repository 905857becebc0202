// What the tests of BSDFs share: the kernel bsdf.comp.glsl, materials, and directions to look from.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/statistics.h"
#include "gpu/device_fixture.h"
#include "selftest/random.h"
#include "shared/material.h"

namespace candela {

inline MaterialRecord diffuse(vec3 reflectance) {
    return {MATERIAL_DIFFUSE, reflectance, vec3(0.0f), 0.0f};
}
inline MaterialRecord phong(vec3 kd, vec3 ks, float n) {
    return {MATERIAL_PHONG, kd, ks, n};
}
inline MaterialRecord mirror(vec3 reflectance) {
    return {MATERIAL_MIRROR, reflectance, vec3(0.0f), 0.0f};
}
inline MaterialRecord conductor(vec3 reflectance, float alpha) {
    return {MATERIAL_CONDUCTOR, reflectance, vec3(0.0f), alpha};
}
// `model` is one of MATERIAL_DIELECTRIC_*; `eta` the index behind the surface over that before it.
inline MaterialRecord dielectric(uint32_t model, float eta) {
    return {model, vec3(0.0f), vec3(0.0f), eta};
}

// Head-on, oblique and grazing.
inline const std::vector<vec3> VIEWS{vec3(0, 0, 1), normalize(vec3(1, 0.5, 1)), normalize(vec3(-1, 2, 0.01))};

class BsdfTest : public DeviceTest {
  protected:
    std::vector<BsdfResult> run(const std::vector<BsdfItem>& items) const {
        return map<BsdfResult>(kernels::bsdf, items);
    }
    std::vector<BsdfResult> samples(const MaterialRecord& material, vec3 wo, uint32_t count,
                                    uint32_t seed) const {
        Random random(seed);
        std::vector<BsdfItem> items(count, {.material = material, .wo = wo});
        for (BsdfItem& item : items) {
            item.u = random.square();
            item.uc = random.unit();
        }
        return run(items);
    }
};

}  // namespace candela
