// Image: channels are found by their exact names, and have one value per pixel.
#include "image/image.h"

#include <gtest/gtest.h>

namespace candela {
namespace {

Image crop_of_6_pixels() {
    Image image;
    image.full = {10, 20};
    image.data = {4, 5, 7, 7};
    return image;
}

TEST(Image, CountsThePixelsOfTheDataWindow) {
    EXPECT_EQ(Image{}.pixel_count(), 0u);
    EXPECT_EQ(crop_of_6_pixels().pixel_count(), 6u);
    Image large;
    large.data = {0, 0, 100'000, 100'000};
    EXPECT_EQ(large.pixel_count(), 10'000'000'000u);
}

TEST(Image, AddsChannelsOfOneValuePerPixel) {
    Image image = crop_of_6_pixels();
    Channel& z = image.add("Z", 2.5f);
    EXPECT_EQ(z.name, "Z");
    EXPECT_FALSE(z.half);
    EXPECT_EQ(z.values, std::vector<float>(6, 2.5f));
    EXPECT_EQ(image.add("A").values, std::vector<float>(6, 0.0f));
    EXPECT_EQ(image.channels.size(), 2u);
}

TEST(Image, FindsChannelsByExactName) {
    Image image = crop_of_6_pixels();
    image.add("Albedo.R", 1.0f);
    image.add("R", 2.0f);
    ASSERT_NE(image.find("R"), nullptr);
    EXPECT_EQ(image.find("R")->values[0], 2.0f);
    EXPECT_EQ(image.find("r"), nullptr);
    EXPECT_EQ(image.find("Albedo"), nullptr);
    EXPECT_EQ(image.find(""), nullptr);
}

TEST(Image, FindsTheColoursOfALayerInTheOrderRedGreenBlue) {
    Image image = crop_of_6_pixels();
    for (const char* name : {"B", "G", "R", "Variance.B", "Variance.R"}) {
        image.add(name, float(name[0] == 'V' ? 0 : name[0]));
    }
    const std::optional<RgbPlanes> rgb = image.find_rgb();
    ASSERT_TRUE(rgb);
    EXPECT_EQ((*rgb)[0][5], float('R'));
    EXPECT_EQ((*rgb)[1][5], float('G'));
    EXPECT_EQ((*rgb)[2][5], float('B'));
    EXPECT_EQ((*rgb)[0].size(), 6u);
    EXPECT_FALSE(image.find_rgb("Variance"));
    image.add("Variance.G", 7.0f);
    ASSERT_TRUE(image.find_rgb("Variance"));
    EXPECT_EQ((*image.find_rgb("Variance"))[1][0], 7.0f);
}

}  // namespace
}  // namespace candela
