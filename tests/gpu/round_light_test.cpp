// Samples of spheres and disks that emit: over the solid angle of a sphere from outside, over area otherwise.
#include "gpu/light_fixture.h"

namespace candela {
namespace {

TEST_F(LightTest, ASphereIsUniformOverTheSolidAngleThatItFills) {
    expect_holds(test_spheres_from_outside(device(), test_effort()));
}

TEST_F(LightTest, ASphereFromInsideIsUniformOverItsArea) {
    expect_holds(test_spheres_from_inside(device(), test_effort()));
}

TEST_F(LightTest, ADiskIsUniformOverItsArea) {
    expect_holds(test_disks(device(), test_effort()));
}

}  // namespace
}  // namespace candela
