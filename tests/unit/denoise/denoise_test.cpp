// Denoising images: tiles, layers, and what goes to and from Open Image Denoise, for which a library of the
// tests stands in (tests/faults/fake_oidn.cpp).
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "denoise/denoise_image.h"
#include "denoise/level.h"
#include "denoise/oidn.h"
#include "denoise/smooth_albedo.h"
#include "denoise/tiles.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

constexpr float QUIET_NAN = std::numeric_limits<float>::quiet_NaN();
constexpr float INFINITY_ = std::numeric_limits<float>::infinity();

// Every pixel is kept once, at least `overlap` from the end of its tile unless the line ends there.
TEST(TileSpans, CoverALineOnceFarFromTheEdges) {
    constexpr uint32_t TILE_SIZE = 64, OVERLAP = 16;
    for (uint32_t length = 1; length < 400; ++length) {
        uint32_t next = 0;
        for (const TileSpan& span : tile_spans(length, TILE_SIZE, OVERLAP)) {
            const uint32_t size = std::min(TILE_SIZE, length), last = span.first + size;
            ASSERT_EQ(span.begin, next);
            ASSERT_GT(span.end, span.begin);
            ASSERT_LE(last, length);
            ASSERT_TRUE(span.begin == 0 || span.begin >= span.first + OVERLAP) << length;
            ASSERT_TRUE(span.end == length || span.end + OVERLAP <= last) << length;
            next = span.end;
        }
        ASSERT_EQ(next, length);
    }
}

// A variable of the environment, as long as this lives.
class Variable {
  public:
    Variable(const char* name, const std::string& value) : name_(name) { ::setenv(name, value.c_str(), 1); }
    ~Variable() { ::unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

  private:
    const char* name_;
};

std::unique_ptr<Denoiser> fake(DenoiserQuality quality = DenoiserQuality::high) {
    return make_oidn({CANDELA_FAKE_OIDN}, quality);
}

// An image whose channel of that name has the value number + i / 1024 at pixel i.
Image image_of(uint32_t width, uint32_t height, const std::vector<std::pair<std::string, float>>& channels) {
    Image image{
        .full = uvec2(width, height), .data = {0, 0, width, height}, .channels = {}, .attributes = {}};
    for (const auto& [name, number] : channels) {
        std::vector<float>& values = image.add(name).values;
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = number + float(i % 1024) / 1024.0f;
    }
    return image;
}

const std::vector<std::pair<std::string, float>> COLOUR = {{"R", 1}, {"G", 2}, {"B", 3}};
const std::vector<std::pair<std::string, float>> FIRST_HIT_LAYERS = {
    {"Albedo.R", 0}, {"Albedo.G", 0}, {"Albedo.B", 0}, {"N.X", -1}, {"N.Y", -1}, {"N.Z", -1}};
const std::vector<std::pair<std::string, float>> VARIANCE_LAYERS = {
    {"Variance.R", 0}, {"Variance.G", 0}, {"Variance.B", 0}};
const std::vector<std::pair<std::string, float>> GUIDES = {
    {"DenoisingAlbedo.R", 0.0f}, {"DenoisingAlbedo.G", 0.0f}, {"DenoisingAlbedo.B", 0.0f},
    {"DenoisingNormal.X", 0.0f}, {"DenoisingNormal.Y", 0.0f}, {"DenoisingNormal.Z", 0.0f}};

template <class T>
std::vector<T> operator+(std::vector<T> a, const std::vector<T>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

// The library gives 2 colour + albedo.
TEST(DenoiseImage, AddsLayersBesideTheNoisyOnes) {
    const Image noisy = image_of(20, 10, COLOUR + FIRST_HIT_LAYERS);
    Image image = noisy;
    const std::unique_ptr<Denoiser> denoiser = fake();
    EXPECT_EQ(denoiser->name(), "oidn");
    EXPECT_EQ(denoiser->description(), "Open Image Denoise 2.5.1");
    add_denoised(image, *denoiser, true, "a.exr");
    ASSERT_EQ(image.channels.size(), noisy.channels.size() + 3);
    for (size_t c = 0; c < noisy.channels.size(); ++c)
        EXPECT_EQ(image.channels[c].values, noisy.channels[c].values);
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_TRUE(is_denoised_channel(DENOISED[c]));
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            ASSERT_EQ(image.find(DENOISED[c])->values[i],
                      2.0f * noisy.channels[c].values[i] + noisy.channels[3 + c].values[i]);
        }
    }
    EXPECT_FALSE(is_denoised_channel("R"));
    // A second time, the layers are replaced.
    add_denoised(image, *denoiser, true, "a.exr");
    EXPECT_EQ(image.channels.size(), noisy.channels.size() + 3);
}

TEST(DenoiseImage, PrefersGuidesMadeForDenoisers) {
    const Image both = image_of(4, 4, COLOUR + FIRST_HIT_LAYERS + GUIDES + VARIANCE_LAYERS);
    const NoisyPicture input = noisy_picture(both, true, "a.exr");
    EXPECT_EQ(input.albedo->at(0).data(), both.find("DenoisingAlbedo.R")->values.data());
    EXPECT_EQ(input.normal->at(2).data(), both.find("DenoisingNormal.Z")->values.data());
    EXPECT_EQ(describe_guides(both), "with DenoisingAlbedo and DenoisingNormal");
    const Image first = image_of(4, 4, COLOUR + FIRST_HIT_LAYERS + VARIANCE_LAYERS);
    EXPECT_EQ(noisy_picture(first, true, "a.exr").albedo->at(1).data(),
              first.find("Albedo.G")->values.data());
    EXPECT_EQ(describe_guides(first), "with Albedo and N");
}

TEST(DenoiseImage, SaysWhatItLacks) {
    const Image colour = image_of(4, 4, COLOUR);
    EXPECT_FALSE(noisy_picture(colour, true, "a.exr").albedo);
    EXPECT_EQ(describe_guides(colour),
              "with colour alone: it has no layer Albedo (--aov albedo,n or, better, denoising); not blended "
              "with the noisy picture: it has no layer Variance (--aov variance)");
    const Image albedo = image_of(
        4, 4, COLOUR + VARIANCE_LAYERS + std::vector(FIRST_HIT_LAYERS.begin(), FIRST_HIT_LAYERS.begin() + 3));
    EXPECT_EQ(describe_guides(albedo), "with Albedo, but without normals: it has no layer N (--aov n)");
    EXPECT_EQ(
        error_of([] {
            noisy_picture(image_of(4, 4, {{"R", 0}, {"G", 0}}), true, "a.exr");
        }),
        "a.exr: it has no channels R, G and B, so that there is nothing to denoise; give an image such as "
        "candela render writes");
}

TEST(DenoiseImage, AnAlphaThatMattersAndVariesIsDenoisedToo) {
    Image image = image_of(4, 4, COLOUR);
    image.add("A", 1.0f);
    const std::unique_ptr<Denoiser> denoiser = fake();
    add_denoised(image, *denoiser, true, "a.exr");
    EXPECT_EQ(image.find(DENOISED_ALPHA), nullptr);
    std::vector<float>& alpha = image.channels[3].values;
    alpha[0] = 0.25f;
    alpha[1] = QUIET_NAN;
    add_denoised(image, *denoiser, true, "a.exr");
    const std::vector<float>& denoised = image.find(DENOISED_ALPHA)->values;
    EXPECT_EQ(denoised[0], 0.5f);
    EXPECT_EQ(denoised[1], 0.0f);
    EXPECT_EQ(denoised[2], 1.0f);  // Twice that, and at most 1.
    add_denoised(image, *denoiser, false, "a.exr");
    EXPECT_EQ(image.find(DENOISED_ALPHA), nullptr);
    alpha.assign(alpha.size(), 1.0f);
    add_denoised(image, *denoiser, true, "a.exr");
    EXPECT_EQ(image.find(DENOISED_ALPHA), nullptr);
}

TEST(DenoiseImage, PicturesAreOfTheDenoisedLayersWhileTheyAreMade) {
    Image image = image_of(4, 4, COLOUR);
    add_denoised(image, *fake(), true, "a.exr");
    const Image before = image;
    {
        const DenoisedView view(image);
        EXPECT_EQ(image.find("G")->values, before.find("Denoised.G")->values);
        EXPECT_EQ(image.find("Denoised.G")->values, before.find("G")->values);
    }
    EXPECT_EQ(image.find("G")->values, before.find("G")->values);
    Image noisy = image_of(4, 4, COLOUR);
    const DenoisedView view(noisy);
    EXPECT_EQ(noisy.find("R")->values, image_of(4, 4, COLOUR).find("R")->values);
}

// The library of the tests fails if it sees a number that is not finite.
TEST(Oidn, GetsNumbersThatItCanTakeWhateverTheImageHolds) {
    for (const auto& [width, height] : {std::pair(1u, 1u), std::pair(7u, 1u), std::pair(3u, 5u)}) {
        for (const float odd : {QUIET_NAN, INFINITY_, -INFINITY_, 1e38f, -1.0f}) {
            Image image = image_of(width, height, COLOUR + GUIDES);
            for (Channel& channel : image.channels)
                channel.values[0] = odd;
            add_denoised(image, *fake(), true, "a.exr");
            for (const char* name : DENOISED) {
                for (const float value : image.find(name)->values)
                    ASSERT_TRUE(std::isfinite(value) && value >= 0.0f) << odd;
            }
        }
    }
}

// The tests' library gives twice the colour plus the albedo.
TEST(Oidn, AlbedoComesWithoutItsNoise) {
    Image image = image_of(40, 30, COLOUR + GUIDES);
    for (size_t c = 0; c < 3; ++c) {
        std::vector<float>& values = image.channels[3 + c].values;
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = (i * 7919 + c) % 3 == 0 ? 0.5f : 0.4f;
    }
    image.add("DenoisingAlbedo.V").values.assign(image.pixel_count(), 0.02f);
    NoisyPicture picture = noisy_picture(image, false, "a.exr");
    const std::vector<vec3> smooth = smooth_albedo(picture, {0, 0, 40, 30});
    const Denoised result = fake()->run(picture);
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < smooth.size(); ++i)
            ASSERT_EQ(result.rgb[c][i], 2.0f * picture.rgb[c][i] + smooth[i][int(c)]);
    }
    EXPECT_NE(smooth[0], rgb_at(*picture.albedo, 0));
}

// The result of the tests' library depends on each pixel alone, so that a seam or a gap would show.
TEST(Oidn, TilesOfALargePictureCoverItOnce) {
    const Image noisy = image_of(600, 520, COLOUR);
    const TemporaryDirectory folder;
    const std::string log = (folder / "log").string();
    {
        const Variable logged("FAKE_OIDN_LOG", log);
        Image image = noisy;
        add_denoised(image, *fake(), true, "a.exr");
        for (size_t c = 0; c < 3; ++c) {
            for (size_t i = 0; i < image.pixel_count(); ++i)
                ASSERT_EQ(image.find(DENOISED[c])->values[i], 2.0f * noisy.channels[c].values[i]) << i;
        }
    }
    std::ifstream lines(log);
    std::string line, first;
    size_t count = 0;
    while (std::getline(lines, line)) {
        if (count++ == 0) first = line;
        EXPECT_EQ(line, first);  // The same size, and the same exposure.
    }
    EXPECT_EQ(count, 4u);
    EXPECT_NE(first.find("512x512"), std::string::npos) << first;
}

// A lamp far brighter than the picture would spread. The blend, which needs the variance, gives it back.
TEST(Oidn, LampsAreLimitedWhereTheBlendGivesThemBack) {
    Image image = image_of(32, 32, COLOUR);
    for (size_t c = 0; c < 3; ++c) {
        image.channels[c].values.assign(image.pixel_count(), 1.0f);
        image.channels[c].values[40] = 1e6f;
    }
    const auto lamp = [&] { return fake()->run(noisy_picture(image, false, "a.exr")).rgb[0][40]; };
    EXPECT_EQ(lamp(), 2e6f);
    for (const char* name : {"Variance.R", "Variance.G", "Variance.B"})
        image.add(name);
    // The mean of one block of four is 1 + (1e6 - 1) / 256, the others' is 1; the geometric mean becomes
    // 0.18.
    const double mean = std::pow(1.0 + (1e6 - 1.0) / 256.0, 0.25);
    EXPECT_NEAR(lamp(), 2.0 * 100.0 * mean / 0.18, 0.01);
    add_denoised(image, *fake(), false, "a.exr");
    EXPECT_EQ(image.find("Denoised.R")->values[40], 1e6f);
}

// What a filter was told: its images, and its numbers.
std::vector<std::string> told(DenoiserQuality quality, const Image& noisy) {
    const TemporaryDirectory folder;
    const std::string log = (folder / "log").string();
    const Variable logged("FAKE_OIDN_LOG", log);
    Image image = noisy;
    add_denoised(image, *fake(quality), true, "a.exr");
    std::ifstream file(log);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);)
        lines.push_back(line);
    return lines;
}

// The geometric mean of the luminances of one block, 2, becomes 0.18.
TEST(Oidn, FiltersAreToldWhatTheyDenoise) {
    Image image = image_of(2, 2, COLOUR + GUIDES);
    for (size_t c = 0; c < 3; ++c)
        image.channels[c].values.assign(4, 2.0f);
    image.add("A").values = {0, 1, 1, 1};
    EXPECT_EQ(
        told(DenoiserQuality::high, image),
        (std::vector<std::string>{
            "normal output maxMemoryMB=112 quality=6 2x2 inputScale=0",
            "albedo color normal output cleanAux=1 hdr=1 maxMemoryMB=112 quality=6 2x2 inputScale=0.09",
            "albedo color normal output cleanAux=1 maxMemoryMB=112 quality=6 srgb=1 2x2 inputScale=0"}));
    EXPECT_EQ(told(DenoiserQuality::fast, image).front(),
              "albedo color normal output cleanAux=0 hdr=1 maxMemoryMB=112 quality=4 2x2 inputScale=0.09");
    EXPECT_NE(told(DenoiserQuality::balanced, image).back().find("quality=5"), std::string::npos);
    EXPECT_EQ(told(DenoiserQuality::high, image_of(2, 2, {{"R", 0}, {"G", 0}, {"B", 0}})).size(), 1u);
}

TEST(Oidn, ALibraryThatIsMissingIsExplained) {
    const std::string message = error_of([] { make_oidn({"/nowhere/a.so", "/nowhere/b.so"}, {}); });
    EXPECT_EQ(
        message,
        "Open Image Denoise, a library that removes noise, is not there (looked for in \"/nowhere/a.so\", "
        "\"/nowhere/b.so\"); get it by `sh cmake/denoiser.sh`, or name its file libOpenImageDenoise.so.2 in "
        "CANDELA_OIDN");
}

TEST(Oidn, ALibraryThatIsNoneIsRefused) {
    const TemporaryDirectory folder;
    const std::filesystem::path text = folder / "text.so";
    std::ofstream(text) << "text";
    const std::string of_text = error_of([&] { make_oidn({text}, {}); });
    EXPECT_TRUE(of_text.starts_with("cannot load Open Image Denoise from \"" + text.string() + "\": "))
        << of_text;
    const std::string other = error_of([] { make_oidn({"libm.so.6"}, {}); });
    EXPECT_EQ(
        other,
        "cannot use \"libm.so.6\" as Open Image Denoise: it has no function oidnNewDevice; candela needs "
        "version 2 (`sh cmake/denoiser.sh` gets it)");
}

TEST(Oidn, FailuresOfTheLibraryAreErrors) {
    const std::string about = std::string("Open Image Denoise (\"") + CANDELA_FAKE_OIDN + "\") failed: ";
    {
        const Variable version("FAKE_OIDN_VERSION", "3");
        EXPECT_EQ(
            error_of([] { fake(); }),
            about + "it is version 3.5.1, and candela needs version 2 (`sh cmake/denoiser.sh` gets it)");
    }
    {
        const Variable device("FAKE_OIDN_DEVICE", "no");
        EXPECT_EQ(error_of([] { fake(); }), about + "it opens no device");
    }
    {
        const Variable fails("FAKE_OIDN_FAILS", "device");
        EXPECT_EQ(error_of([] { fake(); }), about + "out of luck in device");
    }
    const Image noisy = image_of(4, 4, COLOUR + GUIDES);
    for (const std::string where : {"filter", "execute"}) {
        const std::unique_ptr<Denoiser> denoiser = fake();
        Image image = noisy;
        {
            const Variable fails("FAKE_OIDN_FAILS", where), after("FAKE_OIDN_AFTER", "1");
            EXPECT_EQ(error_of([&] { add_denoised(image, *denoiser, true, "a.exr"); }),
                      about + "out of luck in " + where);
            EXPECT_EQ(image.channels.size(), noisy.channels.size());
        }
        add_denoised(image, *denoiser, true, "a.exr");  // The next time, it works.
        EXPECT_NE(image.find("Denoised.R"), nullptr);
    }
}

}  // namespace
}  // namespace candela
