// What the tests of BSDFs share: the kernel bsdf.comp.glsl; see selftest/bsdfs.h for materials and
// directions.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/statistics.h"
#include "gpu/device_fixture.h"
#include "probe/random.h"
#include "selftest/bsdfs.h"

namespace candela {

class BsdfTest : public DeviceTest {
  protected:
    std::vector<BsdfResult> run(const std::vector<BsdfItem>& items) const {
        return map<BsdfResult>(kernels::bsdf, items);
    }
    std::vector<BsdfResult> samples(const ProbedMaterial& material, vec3 wo, uint32_t count,
                                    uint32_t seed) const {
        Random random(seed);
        std::vector<BsdfItem> items(count, bsdf_item(material, wo));
        for (BsdfItem& item : items) {
            item.u = random.square();
            item.uc = random.unit();
        }
        return run(items);
    }
};

}  // namespace candela
