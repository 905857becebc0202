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
    const BvhNode node{vec3(1.5f, -2.0f, 3e30f), vec3(0x1p-126f, 1.0f, 0x1p127f),
                       uvec3(0x01020304u, 0x05060708u, 0x090A0B0Cu),
                       uvec3(0xF1F2F3F4u, 0xF5F6F7F8u, 0xF9FAFBFCu), bvh_children(2u, 1234567u, 3u, 89u)};
    const PackedBvhNode words = pack(node);
    EXPECT_EQ(words[0].w, 1u | 127u << 8 | 254u << 16);
    EXPECT_EQ(words[1], uvec4(0x01020304u, 0x05060708u, 0x090A0B0Cu, 0xF1F2F3F4u));
    EXPECT_EQ(words[2], uvec4(0xF5F6F7F8u, 0xF9FAFBFCu, node.children));
    const BvhNode back = unpack(words);
    EXPECT_EQ(back.origin, node.origin);
    EXPECT_EQ(back.scale, node.scale);
    EXPECT_EQ(back.q_lo, node.q_lo);
    EXPECT_EQ(back.q_hi, node.q_hi);
    EXPECT_EQ(back.children, node.children);
}

TEST(BvhNode, ChildBoxReadsTheBytesOfItsChild) {
    const BvhNode node{vec3(10, 20, 30), vec3(1, 2, 4), uvec3(0x04030201u, 0x08070605u, 0x0C0B0A09u),
                       uvec3(0x44434241u, 0x48474645u, 0x4C4B4A49u), uvec2(0)};
    const Box box = child_box(node, 2);
    EXPECT_EQ(box.lo, vec3(10 + 3, 20 + 2 * 7, 30 + 4 * 11));
    EXPECT_EQ(box.hi, vec3(10 + 0x43, 20 + 2 * 0x47, 30 + 4 * 0x4B));
}

TEST(BvhNode, ChildrenAreNodesThenPrimitivesAndAnyOtherIsTheLast) {
    for (const uint32_t node : {1u, 99u, BVH_MAX_NODES - BVH_WIDTH}) {
        for (const uint32_t primitive : {0u, 77u, BVH_MAX_PRIMITIVES - BVH_WIDTH}) {
            for (uint32_t count = 1; count <= BVH_WIDTH; ++count) {
                for (uint32_t nodes = 0; nodes <= count; ++nodes) {
                    const uvec2 children = bvh_children(nodes, node, count, primitive);
                    for (uint32_t i = 0; i < BVH_WIDTH; ++i) {
                        const uint32_t existing = std::min(i, count - 1);
                        const uint32_t reference = bvh_child(children, i);
                        EXPECT_EQ(reference, existing < nodes
                                                 ? node + existing
                                                 : BVH_LEAF_BIT | (primitive + existing - nodes));
                    }
                }
            }
        }
    }
}

TEST(BvhNode, ChildrenThatDoNotExistGetAnInvertedBox) {
    const BvhNode node = quantise(std::vector<Box>{cube(0, 1), cube(2, 3)});
    EXPECT_EQ(node.q_lo.x >> 16, 0xFFFFu);
    EXPECT_EQ(node.q_hi.x >> 16, 0u);
    EXPECT_EQ(quantise({}).q_lo, uvec3(0xFFFFFFFFu));
}

TEST(BvhNode, RoundsOutwardsOnAnyRange) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f), exponent(-44.0f, 36.0f);
    for (int trial = 0; trial < 20000; ++trial) {
        const float centre = unit(generator) * std::pow(10.0f, exponent(generator));
        const float size = std::pow(10.0f, exponent(generator));
        std::vector<Box> boxes(1 + size_t(trial % 4));
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
