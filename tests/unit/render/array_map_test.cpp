// The buffers of a scene's arrays, on devices of all limits.
#include "render/array_map.h"

#include <algorithm>
#include <random>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"

namespace candela {
namespace {

using Sizes = std::array<size_t, ARRAY_COUNT>;  // In words.

GpuScene scene_of_sizes(const Sizes& sizes) {
    GpuScene scene;
    for (uint32_t i = 0; i < ARRAY_COUNT; ++i)
        scene.arrays[i] = std::vector<uvec4>(sizes[i]);
    return scene;
}

vk::DeviceInfo device_of(uint32_t texels, uint32_t storage_words, uint32_t storage_buffers) {
    vk::DeviceInfo device;
    device.name = "a device";
    device.limits.max_texel_buffer_elements = texels;
    device.limits.max_storage_buffer_range = 16 * storage_words;
    device.limits.max_per_stage_descriptor_storage_buffers = storage_buffers;
    return device;
}

// The buffer of the device in which an array lies.
struct Place {
    bool texel;
    uint32_t buffer;

    bool operator==(const Place&) const = default;
};

Place place_of(const ArrayMap& map, const SceneArray& array) {
    const uint32_t slot = map.slots[array.buffer];
    return slot == NO_SLOT ? Place{true, array.buffer} : Place{false, slot};
}

// What a kernel relies on: no two arrays overlap, and none reaches beyond a buffer's range.
void expect_sound(const ArrayMap& map, const Sizes& sizes, uint32_t texels, uint32_t storage_words) {
    for (const SceneArray& array : SCENE_ARRAYS) {
        const uint32_t i = array.number;
        const Place place = place_of(map, array);
        EXPECT_LT(place.buffer, place.texel ? BUFFER_COUNT : map.storage_buffers);
        EXPECT_LE(map.starts[i] + sizes[i], place.texel ? texels : storage_words);
        const bool is_first = std::ranges::none_of(
            std::span(SCENE_ARRAYS).first(i), [&](const SceneArray& a) { return a.buffer == array.buffer; });
        EXPECT_TRUE(!is_first || (!place.texel && place.buffer == map.shared_slot) || map.starts[i] == 0);
        for (uint32_t k = 0; k < i; ++k) {
            if (place_of(map, SCENE_ARRAYS[k]) != place) continue;
            EXPECT_TRUE(SCENE_ARRAYS[k].buffer == array.buffer || place.buffer == map.shared_slot);
            EXPECT_TRUE(map.starts[k] + sizes[k] <= map.starts[i] ||
                        map.starts[i] + sizes[i] <= map.starts[k]);
        }
    }
}

const Sizes SIZES{400, 900, 300, 300, 20, 40, 10, 600, 300, 1};

TEST(ArrayMap, EachBufferIsATexelBufferIfThatMayHoldIt) {
    const ArrayMap map = map_arrays(device_of(900, 900, 4), scene_of_sizes(SIZES), SceneAccess::automatic);
    EXPECT_STREQ(to_text(map), "texel");
    EXPECT_EQ(map.shared_slot, NO_SLOT);
    EXPECT_EQ(map.storage_buffers, 1u);
    expect_sound(map, SIZES, 900, 900);
    EXPECT_EQ(map.starts[ARRAY_ENVIRONMENT_CDF], SIZES[ARRAY_ENVIRONMENT]);
}

TEST(ArrayMap, LongerOnesHaveStorageBuffersOfTheirOwn) {
    const ArrayMap map = map_arrays(device_of(500, 900, 4), scene_of_sizes(SIZES), SceneAccess::automatic);
    EXPECT_STREQ(to_text(map), "mixed");
    EXPECT_EQ(map.slots[BUFFER_PRIMITIVES], 0u);
    EXPECT_EQ(map.slots[BUFFER_ENVIRONMENT], 1u);
    EXPECT_EQ(std::ranges::count(map.slots, NO_SLOT), BUFFER_COUNT - 2);
    EXPECT_EQ(map.shared_slot, NO_SLOT);
    EXPECT_EQ(map.storage_buffers, 2u);
}

TEST(ArrayMap, WhereThereAreFewStorageBuffersAllButTheLongestShareOne) {
    const ArrayMap map =
        map_arrays(device_of(900, 2000, 4), scene_of_sizes(SIZES), SceneAccess::storage_buffers);
    EXPECT_STREQ(to_text(map), "storage");
    EXPECT_EQ(map.slots[BUFFER_PRIMITIVES], 0u);
    EXPECT_EQ(map.slots[BUFFER_ENVIRONMENT], 1u);
    EXPECT_EQ(std::ranges::count(map.slots, 2u), BUFFER_COUNT - 2);
    EXPECT_EQ(map.shared_slot, 2u);
    EXPECT_EQ(map.storage_buffers, 3u);
    expect_sound(map, SIZES, 900, 2000);
}

TEST(ArrayMap, NoneIsSharedWhereThereAreEnough) {
    const uint32_t enough = BUFFER_COUNT + 1;  // One is for counters.
    const ArrayMap map =
        map_arrays(device_of(900, 900, enough), scene_of_sizes(SIZES), SceneAccess::storage_buffers);
    EXPECT_EQ(map.shared_slot, NO_SLOT);
    EXPECT_EQ(map.storage_buffers, BUFFER_COUNT);
    expect_sound(map, SIZES, 900, 900);
}

// MoltenVK takes the lengths of arrays of buffers from the constants' defaults.
TEST(ArrayMap, OnMoltenVkThereAreAlwaysAsManyAsAKernelSaysByDefault) {
    vk::DeviceInfo device = device_of(900, 3000, 32);
    device.driver_id = VK_DRIVER_ID_MOLTENVK;
    for (const SceneAccess access : {SceneAccess::texel_buffers, SceneAccess::storage_buffers}) {
        const ArrayMap map = map_arrays(device, scene_of_sizes(SIZES), access);
        EXPECT_EQ(map.storage_buffers, KernelConstants{}[CONSTANT_STORAGE_BUFFERS]);
        expect_sound(map, SIZES, 900, 3000);
    }
}

// If nodes, primitives and all others together fit into a buffer each, so do the buffers of the map.
TEST(ArrayMap, WhatFitsIntoThreeBuffersByKindFits) {
    std::mt19937 random(1);
    int fitting = 0;
    for (int i = 0; i < 1000; ++i) {
        Sizes sizes;
        for (size_t& size : sizes)
            size = random() % 150;
        sizes[ARRAY_NODES] = random() % 1000, sizes[ARRAY_PRIMITIVES] = random() % 1000;
        size_t others = 0;
        for (uint32_t k = ARRAY_PRIMITIVES + 1; k < ARRAY_COUNT; ++k)
            others += sizes[k];
        if (std::max({sizes[ARRAY_NODES], sizes[ARRAY_PRIMITIVES], others}) > 1000) continue;
        ++fitting;
        const auto access = i % 2 == 0 ? SceneAccess::storage_buffers : SceneAccess::automatic;
        expect_sound(map_arrays(device_of(100, 1000, 4), scene_of_sizes(sizes), access), sizes, 100, 1000);
    }
    EXPECT_GT(fitting, 50);
}

std::string map_error_of(const vk::DeviceInfo& device, SceneAccess access) {
    try {
        map_arrays(device, scene_of_sizes(SIZES), access);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        return error.what();
    }
    return "no error";
}

TEST(ArrayMap, WhatIsTooLongIsNamed) {
    EXPECT_EQ(map_error_of(device_of(500, 899, 4), SceneAccess::automatic),
              "the scene's array primitives needs 900 texels (14400 bytes), but a device allows "
              "maxTexelBufferElements = 500 and maxStorageBufferRange = 14384 bytes; use a smaller scene, or "
              "another "
              "device (candela devices lists them)");
    EXPECT_EQ(
        map_error_of(device_of(500, 1070, 4), SceneAccess::storage_buffers),
        "the scene's arrays nodes, surfaces, normals, lights, light_alias, materials, media need 1071 texels "
        "(17136 bytes), but a device allows maxTexelBufferElements = 500 and "
        "maxStorageBufferRange = 17120 bytes; use a smaller scene, or another device (candela devices lists "
        "them)");
}

}  // namespace
}  // namespace candela
