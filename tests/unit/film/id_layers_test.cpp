// From the shapes that rays hit to layers of ids.
#include "film/id_layers.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "image/cryptomatte.h"

namespace candela {
namespace {

// A pixel whose rays hit these shapes that often, and otherwise nothing.
void add_pixel(Coverage& coverage, const std::vector<std::pair<uint32_t, uint32_t>>& shown) {
    std::vector<ShapePart> parts(FIRST_HITS, NO_PART);
    size_t next = 0;
    for (const auto& [shape, hits] : shown) {
        for (uint32_t i = 0; i < hits; ++i)
            parts[next++] = {shape, 0};
    }
    std::ranges::reverse(parts);
    coverage.add(std::span<const ShapePart, FIRST_HITS>(parts.data(), FIRST_HITS));
}

// An image of one row with the layers of these pixels.
Image layers_of(const Coverage& coverage, const Labels& labels) {
    const auto width = uint32_t(coverage.pixel_count());
    Image image{.full = uvec2(width, 1), .data = {0, 0, width, 1}, .channels = {}, .attributes = {}};
    add_id_layers(image, {.ids = true, .cryptomatte = true}, coverage, labels);
    return image;
}

// Shapes 0 and 1 are parts of `a` in two materials, shape 2 is another copy of it, and 3 to 8 are others.
Labels some_labels() {
    Labels labels{.objects = {"a", "b", "c", "d", "e", "f", "g"},
                  .instances = {{1, 0}, {1, 1}},
                  .materials = {"m", "n"},
                  .shapes = {{1, 1, 1}, {1, 1, 2}, {1, 2, 1}}};
    for (uint32_t object = 2; object <= 7; ++object) {
        labels.instances.push_back({object, 0});
        labels.shapes.push_back({object, object + 1, 2});
    }
    return labels;
}

std::vector<float> values(const Image& image, const std::string& channel) {
    return image.find(channel)->values;
}

TEST(IdLayers, NumberWhatCoversMostOfAPixel) {
    Coverage coverage;
    add_pixel(coverage, {{0, 64}});
    add_pixel(coverage, {{0, 15}, {2, 15}, {3, 20}});  // The copies of `a` have 30 of 64.
    add_pixel(coverage, {{3, 33}});
    add_pixel(coverage, {{3, 32}});           // As much as nothing.
    add_pixel(coverage, {{4, 32}, {3, 32}});  // Equal.
    add_pixel(coverage, {});
    const Image image = layers_of(coverage, some_labels());
    EXPECT_EQ(values(image, OBJECT_ID), (std::vector<float>{1, 1, 2, 0, 2, 0}));
    EXPECT_EQ(values(image, INSTANCE_ID), (std::vector<float>{1, 3, 3, 0, 3, 0}));
    EXPECT_EQ(values(image, MATERIAL_ID), (std::vector<float>{1, 1, 2, 0, 2, 0}));
}

TEST(IdLayers, RanksAreIdsOfNamesWithTheirCoverage) {
    Coverage coverage;
    add_pixel(coverage, {{0, 10}, {1, 6}, {3, 32}});
    const Image image = layers_of(coverage, some_labels());
    const auto id = [&](const char* channel) { return std::bit_cast<uint32_t>(values(image, channel)[0]); };
    EXPECT_EQ(id("CryptoObject00.R"), crypto_id("b"));
    EXPECT_EQ(values(image, "CryptoObject00.G")[0], 0.5f);
    EXPECT_EQ(id("CryptoObject00.B"), crypto_id("a"));
    EXPECT_EQ(values(image, "CryptoObject00.A")[0], 0.25f);
    EXPECT_EQ(id("CryptoMaterial00.R"), crypto_id("n"));
    EXPECT_EQ(values(image, "CryptoMaterial00.G")[0], 38.0f / 64.0f);
    EXPECT_EQ(id("CryptoMaterial00.B"), crypto_id("m"));
    for (const char* empty : {"CryptoObject01.R", "CryptoObject01.G", "CryptoObject02.B", "CryptoObject02.A"})
        EXPECT_EQ(id(empty), 0u) << empty;
}

TEST(IdLayers, HaveSixRanks) {
    Coverage coverage;
    add_pixel(coverage, {{0, 14}, {3, 12}, {4, 11}, {5, 9}, {6, 8}, {7, 6}, {8, 4}});
    const Image image = layers_of(coverage, some_labels());
    const auto last = std::bit_cast<uint32_t>(values(image, "CryptoObject02.B")[0]);
    EXPECT_EQ(last, crypto_id("f"));
    EXPECT_EQ(values(image, "CryptoObject02.A")[0], 6.0f / 64.0f);
}

TEST(IdLayers, NamesOfOneIdAreOneMatte) {
    Labels labels = some_labels();
    labels.objects[1] = "part71663";
    labels.objects[2] = "part108007";
    Coverage coverage;
    add_pixel(coverage, {{3, 20}, {4, 30}, {0, 14}});
    const Image image = layers_of(coverage, labels);
    EXPECT_EQ(values(image, "CryptoObject00.G")[0], 50.0f / 64.0f);
    EXPECT_EQ(values(image, OBJECT_ID)[0], 3.0f);  // Their numbers differ.
}

TEST(IdLayers, GroupsOfAMeshAreObjectsInARow) {
    Coverage coverage;
    std::vector<ShapePart> parts(FIRST_HITS, {3, 0});
    std::fill_n(parts.begin(), 40, ShapePart{3, 2});
    coverage.add(std::span<const ShapePart, FIRST_HITS>(parts.data(), FIRST_HITS));
    const Image image = layers_of(coverage, some_labels());
    EXPECT_EQ(values(image, OBJECT_ID)[0], 4.0f);
    EXPECT_EQ(values(image, INSTANCE_ID)[0], 5.0f);
    EXPECT_EQ(values(image, MATERIAL_ID)[0], 2.0f);
    EXPECT_EQ(std::bit_cast<uint32_t>(values(image, "CryptoObject00.R")[0]), crypto_id("d"));
    EXPECT_EQ(values(image, "CryptoMaterial00.G")[0], 1.0f);
}

}  // namespace
}  // namespace candela
