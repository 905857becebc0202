// Rays that leave round shapes do not hit them again where they began, and rays that went into a sphere do
// not slip out.
#include "gpu/device_fixture.h"
#include "selftest/spheres.h"

namespace candela {
namespace {

using InteractionTest = DeviceTest;

TEST_F(InteractionTest, ARayFromOutsideASphereDoesNotMeetIt) {
    expect_holds(test_rays_outside_spheres(device(), test_effort()));
}

TEST_F(InteractionTest, ARayWithinASphereMeetsItsFarSide) {
    expect_holds(test_rays_within_spheres(device(), test_effort()));
}

TEST_F(InteractionTest, PointsLieOnTheSphere) {
    expect_holds(test_points_on_spheres(device(), test_effort()));
}

TEST_F(InteractionTest, ARayFromADiskDoesNotMeetIt) {
    expect_holds(test_rays_at_disks(device(), test_effort()));
}

}  // namespace
}  // namespace candela
