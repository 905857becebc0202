// OpenEXR files: what is written is read back, and damage is reported.
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <random>

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/file.h"
#include "image/image_io.h"
#include "unit/base/base_fixture.h"
#include "unit/image/image_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// A crop with two layers of noise, extreme values among them.
Image make_image(uvec2 full = {40, 50}, PixelRect data = {3, 7, 36, 45}) {
    Image image;
    image.full = full;
    image.data = data;
    std::mt19937 random(1);
    for (const char* name : {"R", "Albedo.G", "Z"}) {
        for (float& value : image.add(name).values)
            value = float(random()) / 1e6f;
    }
    image.channels[0].values[0] = INFINITE;
    image.channels[0].values[1] = -INFINITE;
    image.channels[0].values[2] = std::numeric_limits<float>::denorm_min();
    image.channels[0].values[3] = std::numeric_limits<float>::max();
    image.channels[0].values[4] = -0.0f;
    return image;
}

void expect_same_bits(const Channel& a, const Channel& b) {
    EXPECT_EQ(a.half, b.half);
    ASSERT_EQ(a.values.size(), b.values.size());
    for (size_t i = 0; i < a.values.size(); ++i) {
        ASSERT_EQ(std::bit_cast<uint32_t>(a.values[i]), std::bit_cast<uint32_t>(b.values[i])) << a.name << i;
    }
}

TEST(Exr, FloatsSurviveAnExrFileBitByBit) {
    const TemporaryDirectory directory;
    Image image = make_image();
    image.channels[2].values[5] = std::bit_cast<float>(0x7fc00123u);  // A NaN with a payload.
    write_exr(directory / "a.exr", image);
    const Image copy = read_exr(directory / "a.exr");
    EXPECT_EQ(copy.full, image.full);
    EXPECT_EQ(copy.data, image.data);
    ASSERT_EQ(copy.channels.size(), 3u);
    for (const Channel& channel : image.channels)
        expect_same_bits(*copy.find(channel.name), channel);
    EXPECT_EQ(copy.channels[0].name, "Albedo.G") << "channels come in the order of their names";
}

TEST(Exr, HalvesSurviveWithinTheirPrecision) {
    const TemporaryDirectory directory;
    Image image = make_image();
    std::mt19937 random(2);
    Channel& albedo = image.channels[1];
    albedo.half = true;
    for (float& value : albedo.values)
        value = float(random()) / 4294967296.0f;
    albedo.values[0] = 65504.0f;
    albedo.values[1] = INFINITE;
    write_exr(directory / "a.exr", image);
    const Image copy = read_exr(directory / "a.exr");
    const Channel& read = *copy.find("Albedo.G");
    EXPECT_TRUE(read.half);
    EXPECT_FALSE(copy.find("R")->half);
    EXPECT_EQ(read.values[0], 65504.0f);
    EXPECT_EQ(read.values[1], INFINITE);
    for (size_t i = 2; i < read.values.size(); ++i) {
        ASSERT_NEAR(read.values[i], albedo.values[i], albedo.values[i] / 2048 + 3e-8) << i;
    }
    expect_same_bits(*copy.find("Z"), image.channels[2]);
    // Halves that were read are halves exactly: a second round changes no bit.
    write_exr(directory / "b.exr", copy);
    expect_same_bits(*read_exr(directory / "b.exr").find("Albedo.G"), read);
}

TEST(Exr, RefusesAHalfThatWouldOverflow) {
    const TemporaryDirectory directory;
    Image image = make_image();
    image.channels[1].half = true;
    std::ranges::fill(image.channels[1].values, 0.0f);
    image.channels[1].values[33 + 2] = -70000.0f;  // The third pixel of the second row of a crop 33 wide.
    const fs::path path = directory / "a.exr";
    EXPECT_EQ(
        error_of([&] { write_exr(path, image); }),
        "cannot write \"" + path.string() +
            "\": channel \"Albedo.G\" is -70000.000000 at pixel (5, 8), more than a 16-bit float can hold "
            "(65504); write 32-bit floats");
    EXPECT_EQ(directory.size(), 0);
}

TEST(Exr, AttributesSurvive) {
    const TemporaryDirectory directory;
    Image image = make_image();
    image.attributes["device"] = "llvmpipe \xc3\xa4";
    image.attributes["renderTimeSeconds"] = 12.5f;
    image.attributes["worldToCamera"] = mat4(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
    write_exr(directory / "a.exr", image);
    EXPECT_EQ(read_exr(directory / "a.exr").attributes, image.attributes);
}

TEST(Exr, MatricesMoveRowVectorsInTheFile) {
    const TemporaryDirectory directory;
    Image image = make_image();
    mat4 translation(1.0f);
    translation[3] = vec4(10, 20, 30, 1);  // Column vectors: x' = M x.
    image.attributes["worldToCamera"] = translation;
    write_exr(directory / "a.exr", image);
    const Imf::InputFile file((directory / "a.exr").c_str());
    const Imath::M44f& stored = Imf::worldToCamera(file.header());
    EXPECT_EQ(Imath::V3f(1, 2, 3) * stored, Imath::V3f(11, 22, 33));
    EXPECT_EQ(stored[3][1], 20.0f);
}

TEST(Exr, WritesTheHeaderThatOthersExpect) {
    const TemporaryDirectory directory;
    write_exr(directory / "a.exr", make_image());
    const Imf::InputFile file((directory / "a.exr").c_str());
    const Imf::Header& header = file.header();
    EXPECT_EQ(header.displayWindow(), Imath::Box2i({0, 0}, {39, 49}));
    EXPECT_EQ(header.dataWindow(), Imath::Box2i({3, 7}, {35, 44}));
    EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(header.channels()["Z"].type, Imf::FLOAT);
    EXPECT_FALSE(header.hasTileDescription());
    const Imf::Chromaticities rec709({0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f}, {0.3127f, 0.3290f});
    EXPECT_EQ(Imf::chromaticities(header), rec709);
    EXPECT_FALSE(Imf::hasWhiteLuminance(header));
}

TEST(Exr, TheSameImageGivesTheSameBytes) {
    const TemporaryDirectory directory;
    write_exr(directory / "a.exr", make_image());
    write_exr(directory / "b.exr", make_image());
    EXPECT_EQ(read_file(directory / "a.exr"), read_file(directory / "b.exr"));
}

TEST(Exr, SaysWhyAnExrFileCannotBeRead) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    EXPECT_EQ(error_of([&] { read_exr(path); }),
              "cannot read \"" + path.string() + "\": the file does not exist; check the name");
    for (const char* text : {"", "v/1", "no image at all"}) {
        write_quickly(path, text);
        EXPECT_EQ(error_of([&] { read_exr(path); }),
                  "cannot read \"" + path.string() + "\": it is not an OpenEXR file; give an .exr image");
    }
}

TEST(Exr, ReportsATruncatedExrFileWhereverItEnds) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    write_exr(path, make_image());
    const std::string bytes = read_file(path);
    const std::string start = "cannot read \"" + path.string() + "\": the file is damaged or incomplete (";
    for (size_t size = 8; size < bytes.size(); size += 97) {
        write_quickly(path, bytes.substr(0, size));
        const std::string message = error_of([&] { read_exr(path); });
        EXPECT_EQ(message.substr(0, start.size()), start) << size;
        EXPECT_TRUE(message.ends_with("); write it again")) << message;
    }
}

TEST(Exr, SurvivesDamagedExrFiles) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    write_exr(path, make_image());
    const std::string bytes = read_file(path);
    std::mt19937 random(3);
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        std::string damaged = bytes;
        damaged[random() % 600] = char(random());  // In the header and the table of offsets.
        write_quickly(path, damaged);
        try {
            read_exr(path);
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 50);
}

TEST(Exr, AHeaderThatClaimsAHugePictureIsRefused) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    write_exr(path, make_image({64, 64}, {0, 0, 64, 64}));
    const std::string bytes = read_file(path);
    const auto window_end = [](int x, int y) {  // The two integers that end both windows.
        std::string text(8, '\0');
        std::memcpy(text.data(), &x, 4);
        std::memcpy(text.data() + 4, &y, 4);
        return text;
    };
    const std::vector<std::array<int, 2>> huge = {{63, 900'000}, {900'000, 63}, {2'000'000, 63}};
    for (const auto& [x, y] : huge) {
        std::string damaged = bytes;
        for (size_t at = 0; (at = damaged.find(window_end(63, 63), at)) != std::string::npos;) {
            damaged.replace(at, 8, window_end(x, y));
        }
        write_quickly(path, damaged);
        const std::string message = error_of([&] { read_exr(path); });
        EXPECT_TRUE(
            message.starts_with("cannot read \"" + path.string() + "\": the file is damaged or incomplete ("))
            << message;
        EXPECT_EQ(message.find("Invalid width (2000001) too large (max 1048576)") != std::string::npos,
                  x > 1 << 20)
            << message;
    }
}

// The file keeps its length without its pixels; a long header is read to its end.
TEST(Exr, AHeaderIsReadWithoutThePixels) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    Image image = make_image();
    for (const size_t length : {10u, 200'000u}) {
        image.attributes["notes"] = std::string(length, 'x');
        write_exr(path, image);
        const Image whole = read_exr(path);
        const uint64_t size = fs::file_size(path);
        fs::resize_file(path, length + 1500);
        fs::resize_file(path, size);
        const Image header = read_exr_header(path);
        EXPECT_EQ(header.full, image.full);
        EXPECT_EQ(header.data, image.data);
        EXPECT_EQ(header.attributes, whole.attributes);
        ASSERT_EQ(header.channels.size(), 3u);
        EXPECT_TRUE(header.find("R")->values.empty());
    }
    write_quickly(path, "P6 no OpenEXR file");
    EXPECT_EQ(error_of([&] { read_exr_header(path); }),
              "cannot read \"" + path.string() + "\": it is not an OpenEXR file; give an .exr image");
    EXPECT_THROW(read_exr_header(directory / "b.exr"), Error);
    ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(error_of([&] { read_exr_header(directory / "pipe"); }),
              "cannot read \"" + (directory / "pipe").string() +
                  "\": it is a pipe, but must be read more than once; give the name of a file");
}

TEST(Exr, ReadsNoValuesOfOtherChannelsThanThoseAskedFor) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    write_exr(path, make_image());
    const Image all = read_exr(path), some = read_exr(path, {.channels = {"Z", "B"}});
    ASSERT_EQ(some.channels.size(), 3u);
    expect_same_bits(*some.find("Z"), *all.find("Z"));
    EXPECT_TRUE(some.find("R")->values.empty());
    EXPECT_TRUE(some.find("Albedo.G")->values.empty());
}

TEST(Exr, ReportsAnUnwritablePlace) {
    EXPECT_EQ(error_of([] { write_exr("/none/a.exr", make_image()); }),
              "cannot write \"/none/a.exr\": the directory \"/none\" does not exist; create it first");
}

TEST(Exr, RefusesMorePixelsThanAllowedBeforeItReadsThem) {
    const TemporaryDirectory directory;
    const fs::path path = directory / "a.exr";
    write_exr(path, make_image());  // 33 x 38 pixels of a larger picture.
    EXPECT_EQ(read_exr(path, {.max_pixels = 33 * 38}).pixel_count(), 33u * 38u);
    const std::string bytes = read_file(path);
    write_quickly(path, bytes.substr(0, bytes.size() - 100));
    EXPECT_EQ(error_of([&] { read_exr(path, {.max_pixels = 33 * 38 - 1}); }),
              "cannot read \"" + path.string() +
                  "\": its 33x38 pixels are more than the 1253 allowed here; make the image smaller");
}

TEST(Exr, ReportsAnAttributeThatOpenExrRefuses) {
    const TemporaryDirectory directory;
    Image image = make_image();
    image.attributes["channels"] = 1.0f;
    const std::string message = error_of([&] { write_exr(directory / "a.exr", image); });
    EXPECT_NE(message.find("OpenEXR refuses the image ("), std::string::npos) << message;
    EXPECT_EQ(directory.size(), 0);
}

TEST(Exr, RefusesMoreChannelsThanAnyProgramWrites) {
    // A chunk of 300 000 bytes, in a file that ends before them.
    const std::string file = std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) +
                             std::string("a\0int\0\4\0\0\0\0\0\0\0", 14) +
                             std::string("channels\0chlist\0\xe0\x93\x04\0", 20);
    EXPECT_EQ(error_of([&] { decode_exr(file, "a.exr"); }),
              "cannot read \"a.exr\": it has thousands of channels; write fewer");
}

}  // namespace
}  // namespace candela
