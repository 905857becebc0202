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

TEST(Records, NormalsAreAWordForEachVertex) {
    const std::array<uvec4, NORMALS_WORDS> normals =
        pack_normals(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(-1, 0, 0));
    EXPECT_EQ(normals[0], uvec4(0x00007FFFu, 0x7FFF0000u, 0u, 0x00008001u));
}

TEST(Records, TheFourthVertexOrTheKindFillsTheLastWords) {
    const Primitive triangles{PRIMITIVE_TRIANGLES, vec3(1), vec3(2), vec3(3), vec3(4, 5, 6)};
    EXPECT_EQ(pack(triangles)[0].w, floatBitsToUint(4.0f));
    EXPECT_EQ(pack(triangles)[1].w, floatBitsToUint(5.0f));
    EXPECT_EQ(pack(triangles)[2].w, floatBitsToUint(6.0f));
    const Primitive disk{PRIMITIVE_DISK, vec3(1), vec3(2), vec3(3), vec3(0)};
    EXPECT_EQ(pack(disk)[0].w, 0x7FC00002u);
    EXPECT_TRUE(std::isnan(std::bit_cast<float>(pack(disk)[0].w)));
}

TEST(Records, SmoothErrorAndMaterialShareAWord) {
    const Surface surface{uvec2(1, 2), MAX_MATERIALS - 2, 1u, 3u, 0x1p-20f, 1u};
    EXPECT_EQ(pack(surface)[0], uvec4(1u, 2u, 0x80000000u | (127u - 20u) << 23 | 0x7FFFFEu, 3u));
}

}  // namespace
}  // namespace candela
