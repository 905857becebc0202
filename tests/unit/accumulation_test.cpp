// The accumulation state: the means and variances that it stands for, and its file.
#include "render/accumulation.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/image_io.h"
#include "base_fixture.h"
#include "selftest/random.h"

namespace candela {
namespace {

// A state of 3 x 2 pixels of a crop, pixel i with i samples, each with a random L, and the samples
// themselves.
struct Sampled {
    Accumulation state;
    std::vector<std::vector<vec3>> samples;
};

// Fills the layers as the device does, but in double precision: the sum as float, what is missing as
// compensation.
void set_sum(Accumulation& state, uint32_t layer, size_t i, int component, double sum) {
    const size_t at = (layer * state.pixel_count() + i) * 4 + size_t(component);
    state.values[at] = float(sum);
    state.values[at + state.pixel_count() * 4] = float(double(float(sum)) - sum);
}

Sampled sampled(uint32_t layer_count) {
    Sampled s;
    s.state = {.full = uvec2(40, 30),
               .rect = {10, 20, 13, 22},
               .seed = 0xFFFFFFFEu,
               .layer_count = layer_count,
               .values = {}};
    s.state.values.resize(layer_count * s.state.pixel_count() * 4);
    s.samples.resize(s.state.pixel_count());
    Random random(70);
    for (size_t i = 0; i < s.state.pixel_count(); ++i) {
        for (size_t n = 0; n < i; ++n)
            s.samples[i].push_back(10.0f + random.cube());
        for (int c = 0; c < 3; ++c) {
            double sum = 0.0, squares = 0.0;
            for (const vec3 L : s.samples[i]) {
                sum += L[c];
                squares += double(L[c]) * L[c];
            }
            set_sum(s.state, LAYER_L, i, c, sum);
            set_sum(s.state, LAYER_SQUARE, i, c, squares);
            if (layer_count == LAYER_COUNT_AOVS) {
                set_sum(s.state, LAYER_ALBEDO, i, c, 0.25 * double(i));
                set_sum(s.state, LAYER_NORMAL, i, c, -0.5 * double(i));
            }
        }
        s.state.values[(LAYER_L * s.state.pixel_count() + i) * 4 + 3] = float(i / 2);
        s.state.values[(LAYER_L_COMPENSATION * s.state.pixel_count() + i) * 4 + 3] = float(i);
    }
    return s;
}

constexpr AovSelection ALL{true, true, true, true, true, true};

std::vector<float> some_positions(size_t pixels) {
    std::vector<float> positions(pixels * 4);
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i] = float(i);
    return positions;
}

TEST(Accumulation, CountsItsSamples) {
    const Sampled s = sampled(LAYER_COUNT_COLOUR);
    EXPECT_EQ(s.state.pixel_count(), 6u);
    EXPECT_EQ(s.state.total_samples(), 0u + 1 + 2 + 3 + 4 + 5);
}

TEST(Accumulation, MeansAreThoseOfTheSamples) {
    const Sampled s = sampled(LAYER_COUNT_AOVS);
    const Image image = make_image(s.state, ALL, some_positions(6));
    EXPECT_EQ(image.full, uvec2(40, 30));
    EXPECT_EQ(image.data, s.state.rect);
    const RgbPlanes rgb = *image.find_rgb();
    const RgbPlanes albedo = *image.find_rgb("Albedo");
    for (size_t i = 0; i < 6; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0.0;
            for (const vec3 L : s.samples[i])
                sum += L[glm::length_t(c)];
            EXPECT_FLOAT_EQ(rgb[c][i], i == 0 ? 0.0f : float(sum / double(i)));
            EXPECT_EQ(albedo[c][i], i == 0 ? 0.0f : 0.25f);
        }
        EXPECT_EQ(image.find("N.Z")->values[i], i == 0 ? 0.0f : -0.5f);
        EXPECT_FLOAT_EQ(image.find("A")->values[i], i == 0 ? 0.0f : float(i / 2) / float(i));
        EXPECT_EQ(image.find("SampleCount.V")->values[i], float(i));
        EXPECT_EQ(image.find("P.Y")->values[i], float(4 * i + 1));
        EXPECT_EQ(image.find("Z")->values[i], float(4 * i + 3));
    }
}

// Against the textbook's two passes over the samples. The sums hold some 48 bits, of which the difference of
// squares (about 1 part in 300 of them is variance) leaves more than enough for a relative error of 1e-6.
TEST(Accumulation, VarianceIsThatOfTheMean) {
    const Sampled s = sampled(LAYER_COUNT_COLOUR);
    const Image image = make_image(s.state, {.variance = true}, {});
    const RgbPlanes variance = *image.find_rgb("Variance");
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(variance[c][0], INFINITE);
        EXPECT_EQ(variance[c][1], INFINITE);
        for (size_t i = 2; i < 6; ++i) {
            double mean = 0.0, squares = 0.0;
            for (const vec3 L : s.samples[i])
                mean += double(L[glm::length_t(c)]) / double(i);
            for (const vec3 L : s.samples[i])
                squares += std::pow(double(L[glm::length_t(c)]) - mean, 2);
            const double expected = squares / double(i - 1) / double(i);
            EXPECT_NEAR(variance[c][i], expected, 1e-6 * expected);
        }
    }
}

TEST(Accumulation, OnlyTheChannelsAskedForAreThere) {
    const Sampled s = sampled(LAYER_COUNT_COLOUR);
    EXPECT_EQ(make_image(s.state, {}, {}).channels.size(), 4u);
    EXPECT_EQ(make_image(s.state, {.depth = true}, some_positions(6)).channels.size(), 5u);
    EXPECT_EQ(make_image(s.state, {.variance = true, .sample_count = true}, {}).channels.size(), 8u);
}

TEST(Accumulation, TheHashIsThatOfTheColoursInOrder) {
    Image image{.full = uvec2(2, 1), .data = {0, 0, 2, 1}, .channels = {}, .attributes = {}};
    image.add("B").values = {0.0f, 0.0f};
    image.add("A").values = {1.0f, 1.0f};
    image.add("R").values = {1.0f, 0.0f};
    image.add("G").values = {0.0f, -2.0f};
    // FNV-1a of the bytes 00 00 80 3f, 0 x 12, 00 00 00 c0, 0 x 4, computed by its definition.
    uint64_t expected = 14695981039346656037u;
    const float rgb[] = {1.0f, 0.0f, 0.0f, 0.0f, -2.0f, 0.0f};
    unsigned char bytes[sizeof rgb];
    std::memcpy(bytes, rgb, sizeof rgb);
    for (const unsigned char byte : bytes)
        expected = (expected ^ byte) * 1099511628211u;
    EXPECT_EQ(image_hash(image), expected);
    image.channels[2].values[1] = 1e-30f;
    EXPECT_NE(image_hash(image), expected);
}

TEST(Accumulation, TheFileKeepsEveryBit) {
    const TemporaryDirectory folder;
    for (const uint32_t layers : {LAYER_COUNT_COLOUR, LAYER_COUNT_AOVS}) {
        Accumulation state = sampled(layers).state;
        state.values[5] = -0.0f;
        state.values[6] = 0x1p-149f;
        state.values[7] = INFINITE;
        save_accumulation(folder / "state.exr", state);
        const Accumulation loaded = load_accumulation(folder / "state.exr");
        EXPECT_EQ(loaded.full, state.full);
        EXPECT_EQ(loaded.rect, state.rect);
        EXPECT_EQ(loaded.seed, state.seed);
        EXPECT_EQ(loaded.layer_count, state.layer_count);
        ASSERT_EQ(loaded.values.size(), state.values.size());
        EXPECT_EQ(std::memcmp(loaded.values.data(), state.values.data(), state.values.size() * sizeof(float)),
                  0);
    }
}

// Loads a state after `change` has had its way with the image in the file.
template <class Change>
std::string error_after(const Change& change) {
    const TemporaryDirectory folder;
    save_accumulation(folder / "state.exr", sampled(LAYER_COUNT_COLOUR).state);
    Image image = read_exr(folder / "state.exr");
    change(image);
    write_exr(folder / "state.exr", image);
    const std::string message = error_of([&] { load_accumulation(folder / "state.exr"); });
    const std::string prefix = (folder / "state.exr").string() + ": not a state of candela: ";
    EXPECT_EQ(message.substr(0, prefix.size()), prefix);
    return message.substr(std::min(prefix.size(), message.size()));
}

TEST(Accumulation, AFileThatIsNoStateIsRefused) {
    const std::string remedy = "; give a file that candela wrote as one";
    EXPECT_EQ(error_after([](Image& image) { image.attributes.erase("candela.seed"); }),
              "the attribute candela.seed is missing" + remedy);
    EXPECT_EQ(error_after([](Image& image) { image.attributes["candela.seed"] = 7.0f; }),
              "the attribute candela.seed is missing" + remedy);
    for (const std::string seed : {"", "seven", "7x", "-1", "4294967296"}) {
        EXPECT_EQ(error_after([&](Image& image) { image.attributes["candela.seed"] = seed; }),
                  "its seed is \"" + seed + "\"" + remedy);
    }
    EXPECT_EQ(error_after([](Image& image) {
                  std::erase_if(image.channels, [](const Channel& c) { return c.name == "Layer3.G"; });
              }),
              "the channel Layer3.G is missing" + remedy);
}

TEST(Accumulation, UnreadableAndUnwritableFilesAreNamed) {
    const TemporaryDirectory folder;
    const auto expect_named = [](const std::string& message, const std::filesystem::path& path) {
        EXPECT_NE(message.find(path.string()), std::string::npos) << message;
    };
    expect_named(error_of([&] { load_accumulation(folder / "missing.exr"); }), folder / "missing.exr");
    write_file_atomically(folder / "text.exr", "no image");
    expect_named(error_of([&] { load_accumulation(folder / "text.exr"); }), folder / "text.exr");
    const std::filesystem::path nowhere = folder / "none/state.exr";
    expect_named(error_of([&] { save_accumulation(nowhere, sampled(LAYER_COUNT_COLOUR).state); }), nowhere);
    EXPECT_EQ(folder.size(), 1);
}

}  // namespace
}  // namespace candela
