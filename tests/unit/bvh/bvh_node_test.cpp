// The node record: packing and unpacking, and boxes that are rounded outwards on any range of numbers.
#include "shared/bvh_node.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "bvh/quantise.h"

namespace candela {
namespace {

// Expects that quantised boxes contain the exact ones, with no face further out than a step of the grid and a
// rounding, and that scales are what a record can hold.
void expect_contained(const std::vector<Box>& boxes) {
    const BvhNode node = unpack(pack(quantise(boxes)));
    for (uint32_t i = 0; i < boxes.size(); ++i) {
        const Box decoded = child_box(node, i);
        for (int a = 0; a < 3; ++a) {
            const float lo = boxes[i].lo[a], hi = boxes[i].hi[a];
            EXPECT_LE(decoded.lo[a], lo);
            EXPECT_GE(decoded.hi[a], hi);
            const double largest = std::max(std::fabs(node.origin[a]), std::fabs(decoded.hi[a]));
            const double slack = double(node.scale[a]) + largest * 0x1p-23;
            EXPECT_GE(decoded.lo[a], lo - slack);
            EXPECT_LE(decoded.hi[a], hi + slack);
            int exponent;
            EXPECT_TRUE(std::isnormal(node.scale[a]));
            EXPECT_EQ(std::frexp(node.scale[a], &exponent), 0.5f);
        }
    }
}

Box cube(float lo, float hi) {
    return {vec3(lo), vec3(hi)};
}

TEST(BvhNode, PacksAndUnpacksEveryField) {
    const BvhNode node{vec3(1.5f, -2.0f, 3e30f),
                       vec3(0x1p-126f, 1.0f, 0x1p127f),
                       {uvec3(0x01020304u, 0x05060708u, 0x090A0B0Cu), uvec3(0x112233u, 0x445566u, 0x778899u)},
                       {uvec3(0xF1F2F3F4u, 0xF5F6F7F8u, 0xF9FAFBFCu), uvec3(0xA1A2A3u, 0xA4A5A6u, 0xA7A8A9u)},
                       uvec2(0xC3C2C1u, 0xD4D3D2D1u)};
    const PackedBvhNode words = pack(node);
    EXPECT_EQ(words[0].w, 0xD4FE7F01u);
    EXPECT_EQ(words[1], uvec4(0x01020304u, 0x05060708u, 0x090A0B0Cu, 0xF1F2F3F4u));
    EXPECT_EQ(words[2], uvec4(0xF5F6F7F8u, 0xF9FAFBFCu, 0xC1112233u, 0xC2445566u));
    EXPECT_EQ(words[3], uvec4(0xC3778899u, 0xD1A1A2A3u, 0xD2A4A5A6u, 0xD3A7A8A9u));
    const BvhNode back = unpack(words);
    EXPECT_EQ(back.origin, node.origin);
    EXPECT_EQ(back.scale, node.scale);
    for (const int group : {0, 1}) {
        EXPECT_EQ(back.q_lo[group], node.q_lo[group]);
        EXPECT_EQ(back.q_hi[group], node.q_hi[group]);
    }
    EXPECT_EQ(back.children, node.children);
}

TEST(BvhNode, ChildBoxReadsTheBytesOfItsChild) {
    const BvhNode node{vec3(10, 20, 30),
                       vec3(1, 2, 4),
                       {uvec3(0x04030201u, 0x08070605u, 0x0C0B0A09u), uvec3(0x131211u, 0x161514u, 0x191817u)},
                       {uvec3(0x44434241u, 0x48474645u, 0x4C4B4A49u), uvec3(0x535251u, 0x565554u, 0x595857u)},
                       uvec2(0)};
    EXPECT_EQ(child_box(node, 2).lo, vec3(10 + 3, 20 + 2 * 7, 30 + 4 * 11));
    EXPECT_EQ(child_box(node, 2).hi, vec3(10 + 0x43, 20 + 2 * 0x47, 30 + 4 * 0x4B));
    EXPECT_EQ(child_box(node, 5).lo, vec3(10 + 0x12, 20 + 2 * 0x15, 30 + 4 * 0x18));
    EXPECT_EQ(child_box(node, 5).hi, vec3(10 + 0x52, 20 + 2 * 0x55, 30 + 4 * 0x58));
}

TEST(BvhNode, ChildrenAreNodesThenPrimitives) {
    for (const uint32_t node : {1u, 99u, BVH_MAX_NODES - BVH_WIDTH}) {
        for (const uint32_t primitive : {0u, 77u, BVH_MAX_PRIMITIVES - BVH_WIDTH}) {
            for (uint32_t count = 1; count <= BVH_WIDTH; ++count) {
                for (uint32_t nodes = 0; nodes <= count; ++nodes) {
                    const uvec2 children = bvh_children(nodes, node, count, primitive);
                    EXPECT_EQ(children.x, node);  // The other bits are traversal's.
                    EXPECT_EQ(bvh_last_child(children), count - 1);
                    for (uint32_t i = 0; i < count; ++i) {
                        EXPECT_EQ(bvh_child(children, i),
                                  i < nodes ? node + i : BVH_LEAF_BIT | (primitive + i - nodes));
                    }
                }
            }
        }
    }
}

TEST(BvhNode, ChildrenThatDoNotExistGetAnInvertedBox) {
    const BvhNode node = quantise(std::vector<Box>{cube(0, 1), cube(2, 3)});
    EXPECT_EQ(node.q_lo[0].x >> 16, 0xFFFFu);
    EXPECT_EQ(node.q_hi[0].x >> 16, 0u);
    EXPECT_EQ(node.q_lo[1].x, 0xFFFFFFu);
    EXPECT_EQ(node.q_hi[1].x, 0u);
    EXPECT_EQ(quantise({}).q_lo[0], uvec3(0xFFFFFFFFu));
}

TEST(BvhNode, RoundsOutwardsOnAnyRange) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f), exponent(-44.0f, 36.0f);
    for (int trial = 0; trial < 20000; ++trial) {
        const float centre = unit(generator) * std::pow(10.0f, exponent(generator));
        const float size = std::pow(10.0f, exponent(generator));
        std::vector<Box> boxes(1 + size_t(trial) % BVH_WIDTH);
        for (Box& box : boxes) {
            for (int corner = 0; corner < 2; ++corner) {
                const float x = unit(generator), y = unit(generator), z = unit(generator);
                box.extend(vec3(centre) + size * vec3(x, y * y * y, z * 1e-3f));
            }
        }
        expect_contained(boxes);
        if (HasFailure()) FAIL() << "trial " << trial;
    }
}

TEST(BvhNode, RoundsOutwardsInAwkwardCases) {
    expect_contained({cube(0, 0)});
    expect_contained({cube(1e30f, 1e30f)});
    expect_contained({cube(-1e-45f, 1e-45f)});
    expect_contained({cube(-1e37f, 1e37f), cube(0, 1e-37f)});
    // One float apart, far out: the grid is finer than the floats.
    expect_contained({cube(1e30f, std::nextafter(1e30f, INFINITE)), cube(1e30f, 1e30f)});
    // Distances that no double holds: the last step, or step 128, is 0 and not 1e-30.
    expect_contained({cube(-255.0f, 1e-30f)});
    expect_contained({cube(-256.0f, 100.0f), cube(-1e-30f, 1e-30f)});
    expect_contained({cube(0, 255), cube(1, 254)});
    expect_contained({cube(0, 256), cube(1, 255.5f)});
}

TEST(BvhNode, UsesTheFinestGridThatFits) {
    EXPECT_EQ(quantise(std::vector<Box>{cube(0, 255)}).scale, vec3(1.0f));
    EXPECT_EQ(quantise(std::vector<Box>{cube(0, 256)}).scale, vec3(2.0f));
    EXPECT_EQ(quantise(std::vector<Box>{cube(5, 6)}).scale, vec3(0x1p-7f));
    EXPECT_EQ(quantise(std::vector<Box>{cube(-255.0f, 1e-30f)}).scale, vec3(2.0f));
}

}  // namespace
}  // namespace candela
