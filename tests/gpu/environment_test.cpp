// The sky: its texels are where they should be, and light samples find them in proportion to their light.
#include "gpu/device_fixture.h"
#include "selftest/skies.h"

namespace candela {
namespace {

using EnvironmentTest = DeviceTest;

TEST_F(EnvironmentTest, TexelsLieWhereTheConventionSays) {
    // Eight columns and four rows; each texel's red tells its index.
    Environment sky{.size = {8, 4}, .radiance = {}};
    for (int i = 0; i < 32; ++i)
        sky.radiance.emplace_back(float(i), 1.0f, 1.0f);
    // Texel (x, y) has its middle at longitude (x + 1/2) 45 degrees from the left edge, which is +Z.
    struct Seen {
        vec3 w;
        int x, y;
    };
    const float tilt = 0.1f;
    const std::vector<Seen> unturned{
        {vec3(tilt, 0.3f, -1), 4, 1},  // Right of the centre, above the middle.
        {vec3(-tilt, 0.3f, -1), 3, 1}, {vec3(-tilt, -0.3f, -1), 3, 2}, {vec3(1, 0.3f, -tilt), 5, 1},
        {vec3(1, 0.3f, tilt), 6, 1},   {vec3(-1, 0.3f, -tilt), 2, 1},  {vec3(tilt, 0.3f, 1), 7, 1},
        {vec3(-tilt, 0.3f, 1), 0, 1},  {vec3(tilt, 1, -0.01f), 5, 0},  {vec3(tilt, -1, -0.01f), 5, 3},
    };
    std::vector<vec3> directions;
    for (const Seen& s : unturned)
        directions.push_back(normalize(s.w));
    const std::vector<SkyTexel> texels = look_up(device(), sky, directions);
    for (size_t i = 0; i < unturned.size(); ++i)
        EXPECT_EQ(texels[i].radiance.x, float(unturned[i].y * 8 + unturned[i].x)) << i;

    // A quarter turn, counter-clockwise seen from above: what was ahead, at -Z, is at the left, -X.
    sky.rotation = 0.5f * PI;
    const std::vector<SkyTexel> turned =
        look_up(device(), sky, {normalize(vec3(-1, 0.3f, -tilt)), normalize(vec3(-1, 0.3f, tilt))});
    EXPECT_EQ(turned[0].radiance.x, 8.0f + 4.0f);
    EXPECT_EQ(turned[1].radiance.x, 8.0f + 3.0f);
}

TEST_F(EnvironmentTest, EveryDirectionHasItsTexel) {
    expect_holds(test_sky_lookup(device()));
}

TEST_F(EnvironmentTest, SamplesFollowTheLightOfTheSky) {
    expect_holds(test_sky_samples(device(), test_effort()));
}

TEST_F(EnvironmentTest, TheSkyAndOtherLightsAreChosenByPower) {
    expect_holds(test_choice_of_sky(device(), test_effort()));
}

}  // namespace
}  // namespace candela
