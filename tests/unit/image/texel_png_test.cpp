// PNG files as textures: each colour type and depth gives the texels that were written, and damage is
// reported wherever it is.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <png.h>

#include "support/png_writer.h"
#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

// Not a multiple of eight in either direction, so that rows end within a byte, and passes within a block.
constexpr uvec2 PNG_SIZE{13, 11};

PngPicture make_picture(PngColor color, uint32_t bits, uvec2 size = PNG_SIZE) {
    PngPicture picture{.size = size, .bits = bits, .color = color};
    std::mt19937 random(bits);
    picture.samples.resize(size_t{size.x} * size.y * picture.channels());
    for (uint32_t& sample : picture.samples)
        sample = uint32_t(random() % (1u << bits));
    return picture;
}

// Samples as the texels of the same fractions of 1.
std::vector<uint32_t> scaled(std::vector<uint32_t> samples, uint32_t bits) {
    for (uint32_t& sample : samples) {
        if (bits < 8) sample = uint32_t(std::lround(255.0 * sample / ((1u << bits) - 1)));
    }
    return samples;
}

void expect_texels(const TexelImage& image, uvec2 size, uint32_t channels, TexelType type,
                   const std::vector<uint32_t>& values) {
    EXPECT_EQ(image.size, size);
    EXPECT_EQ(image.channels, channels);
    EXPECT_EQ(image.type, type);
    EXPECT_EQ(image.gamma, std::nullopt);
    EXPECT_EQ(texel_values(image), values);
}

struct Kind {
    PngColor color;
    std::vector<uint32_t> depths;
};
const std::vector<Kind> KINDS_OF_SAMPLES = {
    {png_grey, {1, 2, 4, 8, 16}}, {png_rgb, {8, 16}}, {png_grey_alpha, {8, 16}}, {png_rgb_alpha, {8, 16}}};

TEST(TexelPng, EveryColourTypeAndDepthGivesItsSamples) {
    for (const auto& [color, depths] : KINDS_OF_SAMPLES) {
        for (const uint32_t bits : depths) {
            const PngPicture picture = make_picture(color, bits);
            for (const bool interlaced : {false, true}) {
                SCOPED_TRACE(testing::Message() << color << ", " << bits << (interlaced ? ", passes" : ""));
                expect_texels(decode_quietly(encode_png(picture, "", interlaced)), PNG_SIZE,
                              picture.channels(), bits == 16 ? TexelType::unorm16 : TexelType::unorm8,
                              scaled(picture.samples, bits));
            }
        }
    }
}

TEST(TexelPng, ATransparentColourBecomesAnAlphaChannel) {
    for (const auto& [color, depths] : KINDS_OF_SAMPLES) {
        if (color != png_grey && color != png_rgb) continue;
        for (const uint32_t bits : depths) {
            SCOPED_TRACE(testing::Message() << color << ", " << bits);
            PngPicture picture = make_picture(color, bits);
            const uint32_t channels = picture.channels();
            // Another pixel differs from the first one in the lowest bit of its last sample alone.
            std::copy_n(picture.samples.begin(), channels, picture.samples.begin() + channels);
            picture.samples[2 * channels - 1] ^= 1;
            std::string key;
            for (uint32_t c = 0; c < channels; ++c)
                key += big_endian_bytes(picture.samples[c]).substr(2);
            const std::vector<uint32_t> samples = scaled(picture.samples, bits);
            std::vector<uint32_t> expected;
            for (size_t i = 0; i < samples.size(); i += channels) {
                expected.insert(expected.end(), &samples[i], &samples[i] + channels);
                const bool is_key =
                    std::equal(&picture.samples[i], &picture.samples[i] + channels, picture.samples.begin());
                expected.push_back(is_key ? 0 : (bits == 16 ? 65535 : 255));
            }
            expect_texels(decode_quietly(encode_png(picture, png_chunk("tRNS", key))), PNG_SIZE, channels + 1,
                          bits == 16 ? TexelType::unorm16 : TexelType::unorm8, expected);
        }
    }
}

TEST(TexelPng, APaletteGivesItsColours) {
    for (const uint32_t bits : {1u, 2u, 4u, 8u}) {
        const PngPicture picture = make_picture(png_palette, bits);
        const std::vector<uint8_t> palette = random_bytes(size_t{3} << bits);
        const std::string chunk = png_chunk("PLTE", std::string(palette.begin(), palette.end()));
        std::vector<uint32_t> opaque, transparent;
        for (const uint32_t index : picture.samples) {
            for (std::vector<uint32_t>* texels : {&opaque, &transparent})
                texels->insert(texels->end(), &palette[3 * index], &palette[3 * index] + 3);
            transparent.push_back(index == 0 ? 7 : 255);  // The chunk tRNS may end early.
        }
        for (const bool interlaced : {false, true}) {
            SCOPED_TRACE(bits);
            expect_texels(decode_quietly(encode_png(picture, chunk, interlaced)), PNG_SIZE, 3,
                          TexelType::unorm8, opaque);
            expect_texels(decode_quietly(encode_png(picture, chunk + png_chunk("tRNS", "\x07"), interlaced)),
                          PNG_SIZE, 4, TexelType::unorm8, transparent);
        }
    }
}

TEST(TexelPng, ColoursThatThePaletteLacksAreBlackAndCounted) {
    PngPicture picture{.size = {2, 2}, .bits = 4, .color = png_palette, .samples = {0, 1, 2, 15}};
    const std::string palette = png_chunk("PLTE", "\x0a\x14\x1e\x28\x32\x3c");
    std::vector<std::string> warnings;
    const TexelImage image = decode_texels(encode_png(picture, palette), "a", warnings);
    EXPECT_EQ(texel_values(image), (std::vector<uint32_t>{10, 20, 30, 40, 50, 60, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(warnings, std::vector<std::string>{
                            "a: 2 of 4 texels have colours that its palette lacks, and are black"});
}

TEST(TexelPng, ReadsCompressedRowsOfEveryFilter) {
    constexpr uint32_t WIDTH = 97, HEIGHT = 61;
    std::vector<uint8_t> samples = random_bytes(size_t{4} * WIDTH * HEIGHT);
    for (size_t i = 0; i < samples.size(); ++i)  // Smooth, so that each filter is the best somewhere.
        samples[i] = uint8_t(samples[i] % 4 + i % (4 * WIDTH) / 3 + i * i / (40 * WIDTH * WIDTH));
    for (const int filter : {PNG_FILTER_NONE, PNG_FILTER_SUB, PNG_FILTER_UP, PNG_FILTER_AVG, PNG_FILTER_PAETH,
                             PNG_ALL_FILTERS}) {
        std::string file;
        png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
        png_infop info = png_create_info_struct(png);
        png_set_write_fn(
            png, &file,
            [](png_structp p, png_bytep data, size_t count) {
                static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), count);
            },
            nullptr);
        png_set_IHDR(png, info, WIDTH, HEIGHT, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_filter(png, PNG_FILTER_TYPE_BASE, filter);
        png_write_info(png, info);
        for (size_t y = 0; y < HEIGHT; ++y)
            png_write_row(png, &samples[y * 4 * WIDTH]);
        png_write_end(png, nullptr);
        png_destroy_write_struct(&png, &info);
        expect_texels(decode_quietly(file), {WIDTH, HEIGHT}, 4, TexelType::unorm8,
                      {samples.begin(), samples.end()});
    }
}

TEST(TexelPng, TellsAGammaThatIsNotTheUsualOne) {
    const PngPicture picture = make_picture(png_rgb, 8);
    const auto gamma = [&](uint32_t hundred_thousandths, const std::string& chunks = "") {
        return decode_quietly(
                   encode_png(picture, png_chunk("gAMA", big_endian_bytes(hundred_thousandths)) + chunks))
            .gamma;
    };
    EXPECT_EQ(gamma(100000), 1.0);
    EXPECT_EQ(gamma(55556), 0.55556);
    EXPECT_EQ(gamma(45000), 0.45);
    EXPECT_EQ(gamma(10000), 0.1);
    EXPECT_EQ(gamma(1000000), 10.0);
    for (const uint32_t usual : {45455u, 45454u, 45450u, 45500u, 45405u})
        EXPECT_EQ(gamma(usual), std::nullopt) << usual;
    EXPECT_EQ(gamma(45404), 0.45404);
    EXPECT_EQ(gamma(100000, png_chunk("sRGB", std::string(1, '\0'))), std::nullopt);
    for (const auto& [value, text] :
         {std::pair{0u, "0"}, {9999u, "0.09999"}, {1000001u, "10"}, {~0u >> 1, "21474.8"}}) {
        const std::string file = encode_png(picture, png_chunk("gAMA", big_endian_bytes(value)));
        EXPECT_EQ(texel_warning(file),
                  "a: its gamma of " + std::string(text) + " is implausible, and is ignored");
    }
}

TEST(TexelPng, UsesTheDefaultImageOfAnAnimation) {
    const PngPicture picture = make_picture(png_rgb, 8);
    const std::string file =
        encode_png(picture, png_chunk("acTL", big_endian_bytes(2) + big_endian_bytes(0)));
    std::vector<std::string> warnings;
    expect_texels(decode_texels(file, "a", warnings), PNG_SIZE, 3, TexelType::unorm8, picture.samples);
    EXPECT_EQ(warnings, std::vector<std::string>{"a: it is animated; its default image is used"});
}

TEST(TexelPng, SkipsOtherChunksHoweverLong) {
    const PngPicture picture = make_picture(png_rgb, 8);
    const std::string chunks = png_chunk("iCCP", "no profile") + png_chunk("prVt", "private") +
                               png_chunk("tEXt", "Comment" + std::string(9'000'000, '\0'));
    expect_texels(decode_quietly(encode_png(picture, chunks) + "and what follows the end"), PNG_SIZE, 3,
                  TexelType::unorm8, picture.samples);
}

TEST(TexelPng, PassesOnWhatLibpngWarnsOf) {
    const std::string file = encode_png(make_picture(png_rgb_alpha, 8), png_chunk("tRNS", "123456"));
    EXPECT_TRUE(texel_warning(file).starts_with("a: libpng says: "));
}

TEST(TexelPng, RefusesSizesThatCannotBe) {
    for (const uvec2 size : {uvec2(0, 1), uvec2(1, 0), uvec2(1, 1048577), uvec2(~0u, 1)}) {
        PngPicture picture{.size = size, .bits = 8, .color = png_grey};
        EXPECT_EQ(texel_error(PNG_SIGNATURE + png_header(picture) + png_chunk("IEND", "")),
                  damaged_file("its header says " + std::to_string(size.x) + 'x' + std::to_string(size.y) +
                               " pixels"));
    }
    // 100 bytes can expand to 1032 * 100 bytes; a byte less cannot.
    PngPicture picture{.size = {1032, 100}, .bits = 8, .color = png_grey};
    const std::string file = PNG_SIGNATURE + png_header(picture);
    expect_damaged(file + std::string(100 - file.size(), '\0'));
    EXPECT_EQ(texel_error(file + std::string(99 - file.size(), '\0')),
              damaged_file("its 1032x100 pixels need more than 99 bytes"));
}

TEST(TexelPng, SaysWhatIsDamaged) {
    const PngPicture picture = make_picture(png_palette, 8);
    EXPECT_EQ(texel_error(PNG_SIGNATURE), damaged_file("it ends in its header"));
    EXPECT_EQ(texel_error(PNG_SIGNATURE + png_chunk("IEND", std::string(13, '\0'))),
              damaged_file("it begins with no header"));
    expect_damaged(encode_png(picture));  // It has no palette.
    expect_damaged(encode_png(make_picture(png_rgb, 8), png_chunk("NEED", "")));
    std::string file = encode_png(make_picture(png_grey, 8), png_chunk("tEXt", "abcdefgh"));
    EXPECT_EQ(texel_error(file.substr(0, file.size() - 20)), damaged_file("it ends early"));
    file[file.find("abcdefgh")] = 'b';
    expect_damaged(file);  // The checksum is wrong.
    PngPicture small = make_picture(png_grey, 8), large = small;
    large.size.y += 1;
    expect_damaged(PNG_SIGNATURE + png_header(large) +
                   png_chunk("IDAT", zlib_stored(png_pixels(small, false))) + png_chunk("IEND", ""));
}

}  // namespace
}  // namespace candela
