// No input makes a BSDF return a number that is not finite, a negative one, or a direction that is not a unit
// vector.
#include "gpu/bsdf_fixture.h"

namespace candela {
namespace {

TEST_F(BsdfTest, AMillionRandomParametersOfEveryModelGiveSoundSamples) {
    for (uint32_t model = 0; model < MATERIAL_COUNT; ++model) {
        for (uint32_t batch = 0; batch < 4; ++batch)
            expect_holds(test_soundness(device(), model, 250000, 40 + 4 * model + batch));
    }
}

}  // namespace
}  // namespace candela
