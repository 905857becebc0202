// The host's side of the records that have no other test: octahedral normals and the packing of words.
#include <gtest/gtest.h>

#include "shared/primitive.h"

namespace candela {
namespace {

int high(uint bits) {
    return int(bits) >> 16;
}
int low(uint bits) {
    return int(bits << 16) >> 16;
}

TEST(Records, AxesAreExactInTheOctahedralMap) {
    EXPECT_EQ(pack_octahedral(vec3(0, 0, 1)), 0u);
    EXPECT_EQ(low(pack_octahedral(vec3(1, 0, 0))), 32767);
    EXPECT_EQ(low(pack_octahedral(vec3(-1, 0, 0))), -32767);
    EXPECT_EQ(high(pack_octahedral(vec3(0, 1, 0))), 32767);
    EXPECT_EQ(high(pack_octahedral(vec3(0, -1, 0))), -32767);
    for (const int coordinate :
         {low(pack_octahedral(vec3(0, 0, -1))), high(pack_octahedral(vec3(0, 0, -1)))}) {
        EXPECT_EQ(std::abs(coordinate), 32767);  // All four corners of the map are -z.
    }
}

TEST(Records, TheLowerHalfIsFoldedOver) {
    const float third = 1.0f / std::sqrt(3.0f);
    // |x| + |y| + |z| = 1 at a third each; below, (x, y) turns into (1 - |y|, 1 - |x|) with the signs kept.
    EXPECT_EQ(low(pack_octahedral(vec3(third, -third, third))), 10922);
    EXPECT_EQ(high(pack_octahedral(vec3(third, -third, third))), -10922);
    EXPECT_EQ(low(pack_octahedral(vec3(third, -third, -third))), 21845);
    EXPECT_EQ(high(pack_octahedral(vec3(third, -third, -third))), -21845);
}

TEST(Records, NormalsCarryTheirMark) {
    const std::array<uvec4, NORMALS_WORDS> normals =
        pack_normals(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1));
    EXPECT_EQ(normals[0], uvec4(0x00007FFFu, 0x7FFF0000u, 0u, 1u));
}

TEST(Records, KindAndMaterialShareAWord) {
    const Primitive p{PRIMITIVE_DISK, vec3(1, 2, 3), vec3(4, 5, 6), vec3(7, 8, 9), 10, 0x3FFFFFFFu, 11};
    EXPECT_EQ(pack(p)[0].w, 10u);
    EXPECT_EQ(pack(p)[1].w, 0xBFFFFFFFu);  // 2 in the two highest bits, ones below.
    EXPECT_EQ(pack(p)[2].w, 11u);
}

}  // namespace
}  // namespace candela
