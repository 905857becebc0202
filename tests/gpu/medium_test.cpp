// How far light comes in a medium.
#include "gpu/bsdf_fixture.h"
#include "selftest/media.h"

namespace candela {
namespace {

using MediumTest = BsdfTest;

TEST_F(MediumTest, DistancesFollowTheirDensity) {
    expect_holds(test_distances(device()));
}

// The mean of the cosine between the directions before and after is g: the definition of g.
TEST_F(MediumTest, TheMeanCosineOfThePhaseFunctionIsG) {
    for (const float g : {0.0f, 0.3f, -0.6f, 0.9f, -0.99f, 0.999f}) {
        RunningMoments cosines;
        for (const BsdfResult& s : samples(phase(g), vec3(0, 0, 1), 100000, 31))
            cosines.add(-double(s.wi.z));
        EXPECT_NEAR(cosines.mean(), double(g), 5.0 * std::sqrt(cosines.variance_of_mean())) << g;
    }
}

}  // namespace
}  // namespace candela
