// JPEG files as textures. At the highest quality every step of the quantisation is 1, so that blocks of one
// value come back exactly, and all else within the rounding of coefficients and colours.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

constexpr uint32_t BLOCK = 8;
constexpr uvec2 JPEG_SIZE{45, 35};  // Ends within blocks.

// Samples that are constant in each block; those of neighbours differ.
std::vector<uint8_t> make_blocks(uint32_t channels, uvec2 size = JPEG_SIZE, uint32_t block = BLOCK) {
    const std::vector<uint8_t> values = random_bytes(1024);
    std::vector<uint8_t> samples;
    for (uint32_t y = 0; y < size.y; ++y) {
        for (uint32_t x = 0; x < size.x; ++x) {
            for (uint32_t c = 0; c < channels; ++c)
                samples.push_back(values[(y / block * 31 + x / block) * channels % 1000 + c]);
        }
    }
    return samples;
}

void expect_near(const TexelImage& image, uint32_t channels, const std::vector<uint8_t>& samples,
                 int tolerance, uvec2 size = JPEG_SIZE) {
    EXPECT_EQ(image.size, size);
    EXPECT_EQ(image.channels, channels);
    EXPECT_EQ(image.type, TexelType::unorm8);
    EXPECT_EQ(image.gamma, std::nullopt);
    const std::vector<uint32_t> values = texel_values(image);
    ASSERT_EQ(values.size(), samples.size());
    for (size_t i = 0; i < values.size(); ++i)
        ASSERT_NEAR(int(values[i]), int(samples[i]), tolerance) << i;
}

using Adjust = void (*)(j_compress_ptr);
void one_to_one(j_compress_ptr jpeg) {  // No channel has fewer samples than another.
    for (int c = 0; c < jpeg->num_components; ++c)
        jpeg->comp_info[c].h_samp_factor = jpeg->comp_info[c].v_samp_factor = 1;
}
constexpr std::array<Adjust, 5> PROCESSES = {one_to_one,
                                             [](j_compress_ptr jpeg) {
                                                 one_to_one(jpeg);
                                                 jpeg_simple_progression(jpeg);
                                             },
                                             [](j_compress_ptr jpeg) {
                                                 one_to_one(jpeg);
                                                 jpeg->arith_code = TRUE;
                                             },
                                             [](j_compress_ptr jpeg) {
                                                 one_to_one(jpeg);
                                                 jpeg_simple_progression(jpeg);
                                                 jpeg->arith_code = TRUE;
                                             },
                                             [](j_compress_ptr jpeg) {
                                                 one_to_one(jpeg);
                                                 jpeg->restart_interval = 2;
                                                 jpeg->optimize_coding = TRUE;
                                             }};

TEST(TexelJpeg, BlocksOfOneValueComeBackExactly) {
    for (const Adjust adjust : PROCESSES) {
        expect_near(decode_quietly(encode_jpeg(JPEG_SIZE, make_blocks(1), JCS_GRAYSCALE, adjust)), 1,
                    make_blocks(1), 0);
        const auto as_rgb = [&](j_compress_ptr jpeg) {
            jpeg_set_colorspace(jpeg, JCS_RGB);
            adjust(jpeg);
        };
        expect_near(decode_quietly(encode_jpeg(JPEG_SIZE, make_blocks(3), JCS_RGB, as_rgb)), 3,
                    make_blocks(3), 0);
    }
}

// Y, Cb and Cr are rounded, by up to 1/2 each, and so is the result: B is off by at most (1 + 1.772) / 2 +
// 1/2 < 2, and the others by less.
TEST(TexelJpeg, ColoursComeBackWithinTheirRounding) {
    for (const Adjust adjust : PROCESSES)
        expect_near(decode_quietly(encode_jpeg(JPEG_SIZE, make_blocks(3), JCS_RGB, adjust)), 3,
                    make_blocks(3), 1);
}

// The value of a sample before it is rounded, from the coefficients of its block.
// Ref: ITU-T T.81 (1992), A.3.3.
double inverse_transform(const JCOEF* coefficients, uint32_t x, uint32_t y) {
    double sum = 0.0;
    for (uint32_t v = 0; v < BLOCK; ++v) {
        for (uint32_t u = 0; u < BLOCK; ++u) {
            const double scale = (u == 0 ? std::sqrt(0.5) : 1.0) * (v == 0 ? std::sqrt(0.5) : 1.0);
            sum += scale * coefficients[v * BLOCK + u] *
                   std::cos((2.0 * x + 1.0) * u * std::numbers::pi / 16.0) *
                   std::cos((2.0 * y + 1.0) * v * std::numbers::pi / 16.0);
        }
    }
    return sum / 4.0 + 128.0;
}

// The samples of a grey file of the highest quality, as double precision gives them.
std::vector<double> reference_samples(const std::string& file, uvec2 size) {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), uint32_t(file.size()));
    jpeg_read_header(&jpeg, TRUE);
    jvirt_barray_ptr* const arrays = jpeg_read_coefficients(&jpeg);
    std::vector<double> samples;
    for (uint32_t y = 0; y < size.y; ++y) {
        JBLOCKARRAY rows = jpeg.mem->access_virt_barray(reinterpret_cast<j_common_ptr>(&jpeg), arrays[0],
                                                        y / BLOCK, 1, FALSE);
        for (uint32_t x = 0; x < size.x; ++x)
            samples.push_back(inverse_transform(rows[0][x / BLOCK], x % BLOCK, y % BLOCK));
    }
    jpeg_destroy_decompress(&jpeg);
    return samples;
}

// IEEE 1180-1990 asks of an inverse transform that no sample be off by more than 1, and that the mean square
// of the errors be at most 0.02. libjpeg's fast transform is not that good.
TEST(TexelJpeg, NoiseIsDecodedByTheAccurateTransform) {
    constexpr uvec2 NOISE_SIZE(128);
    const std::string file = encode_jpeg(NOISE_SIZE, random_bytes(size_t{NOISE_SIZE.x} * NOISE_SIZE.y));
    const std::vector<uint32_t> values = texel_values(decode_quietly(file));
    const std::vector<double> expected = reference_samples(file, NOISE_SIZE);
    ASSERT_EQ(values.size(), expected.size());
    double sum = 0.0;
    for (size_t i = 0; i < values.size(); ++i) {
        const double error = values[i] - std::clamp(std::round(expected[i]), 0.0, 255.0);
        ASSERT_LE(std::abs(error), 1.0);
        sum += error * error;
    }
    EXPECT_LE(sum / double(values.size()), 0.02);
}

// Two halves of one brightness, Cr = 100 on the left and 150 on the right, of which the file has every second
// sample: between the last of the left and the first of the right, linear interpolation adds a quarter and
// three quarters.
TEST(TexelJpeg, CoarserColoursAreInterpolated) {
    constexpr uint32_t WIDTH = 64, HEIGHT = 16;
    std::vector<uint8_t> samples;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i)
        samples.insert(samples.end(), {128, 128, uint8_t(i % WIDTH < WIDTH / 2 ? 100 : 150)});
    const std::string file = encode_jpeg({WIDTH, HEIGHT}, samples, JCS_YCbCr, [](j_compress_ptr jpeg) {
        one_to_one(jpeg);
        jpeg->comp_info[0].h_samp_factor = 2;
    });
    const TexelImage image = decode_quietly(file);
    const std::vector<uint32_t> values = texel_values(image);
    ASSERT_EQ(values.size(), samples.size());
    for (uint32_t x = 0; x < WIDTH; ++x) {
        const double cr = x < 31 ? 100.0 : x == 31 ? 112.5 : x == 32 ? 137.5 : 150.0;
        EXPECT_NEAR(values[size_t{3} * x], 128.0 + 1.402 * (cr - 128.0), 1.0 + 1.402 / 2) << x;
    }
}

// The segment that starts with this marker, without the two bytes of the marker.
size_t find_segment(const std::string& file, char marker) {
    return file.find(std::string{'\xff', marker}) + 2;
}

TEST(TexelJpeg, RefusesColoursForPrinting) {
    const std::vector<uint8_t> samples = random_bytes(size_t{4} * JPEG_SIZE.x * JPEG_SIZE.y);
    for (const J_COLOR_SPACE space : {JCS_CMYK, JCS_YCCK}) {
        EXPECT_EQ(texel_error(encode_jpeg(JPEG_SIZE, samples, JCS_CMYK,
                                          [&](j_compress_ptr jpeg) { jpeg_set_colorspace(jpeg, space); })),
                  "its colours are CMYK, which are for printing; convert it to RGB");
    }
    EXPECT_EQ(
        texel_error(encode_jpeg(JPEG_SIZE, random_bytes(size_t{2} * JPEG_SIZE.x * JPEG_SIZE.y), JCS_UNKNOWN)),
        "it has 2 channels of unknown meaning; save it as grey or RGB");
}

TEST(TexelJpeg, RefusesKindsThatLibjpegDoesNotDecode) {
    std::string lossless = encode_jpeg(JPEG_SIZE, make_blocks(1));
    lossless[find_segment(lossless, '\xc0') - 1] = '\xc3';
    EXPECT_EQ(
        texel_error(lossless),
        "libjpeg does not decode its kind of JPEG (Unsupported JPEG process: SOF type 0xc3); save it as "
        "a baseline or progressive JPEG of 8 bits");
    std::string deep = encode_jpeg(JPEG_SIZE, make_blocks(1));
    deep[find_segment(deep, '\xc0') + 2] = 12;
    EXPECT_EQ(texel_error(deep),
              "libjpeg does not decode its kind of JPEG (Unsupported JPEG data precision 12); save it as a "
              "baseline or progressive JPEG of 8 bits");
}

TEST(TexelJpeg, RefusesEndlessScans) {
    // Each coefficient of each channel in a scan of its own.
    std::vector<jpeg_scan_info> scans(1, {3, {0, 1, 2}, 0, 0, 0, 0});
    for (int c = 0; c < 3; ++c) {
        for (int k = 1; k < 64; ++k)
            scans.push_back({1, {c, 0, 0}, k, k, 0, 0});
    }
    const auto encode = [&](size_t count) {
        return encode_jpeg(JPEG_SIZE, make_blocks(3), JCS_RGB, [&](j_compress_ptr jpeg) {
            one_to_one(jpeg);
            jpeg->scan_info = scans.data();
            jpeg->num_scans = int(count);
        });
    };
    expect_near(decode_quietly(encode(100)), 3, make_blocks(3), 1);
    EXPECT_EQ(texel_error(encode(190)),
              "it has more than 100 scans; save it as a baseline JPEG, or with fewer");
}

TEST(TexelJpeg, RefusesMorePixelsThanItsBytesCanHold) {
    std::string file = encode_jpeg(JPEG_SIZE, make_blocks(1));
    const size_t frame = find_segment(file, '\xc0');
    file.replace(frame + 3, 4, "\x3e\x80\x3e\x80", 4);
    EXPECT_EQ(texel_error(file), damaged_file("its 16000x16000 pixels need more than " +
                                              std::to_string(file.size()) + " bytes"));
    file.replace(frame + 3, 4, "\x00\x00\x00\x01", 4);
    expect_damaged(file);  // It has no rows.
}

TEST(TexelJpeg, AnIncompleteFileIsRefused) {
    for (const Adjust adjust : PROCESSES) {
        const std::string file = encode_jpeg(JPEG_SIZE, make_blocks(3), JCS_RGB, adjust);
        for (const size_t end : {file.size() - 1, file.size() - 2, file.size() * 9 / 10})
            expect_damaged(file.substr(0, end));
    }
    // With an end, but without the pixels before it. Arithmetic coding may leave out the zeros at an end.
    for (const Adjust adjust : {PROCESSES[0], PROCESSES[1], PROCESSES[4]}) {
        const std::string file = encode_jpeg(JPEG_SIZE, make_blocks(3), JCS_RGB, adjust);
        expect_damaged(file.substr(0, file.size() * 9 / 10) + "\xff\xd9");
    }
    expect_damaged("\xff\xd8\xff\xd9");
}

TEST(TexelJpeg, WarnsOfWhatDoesNoHarm) {
    std::string file = encode_jpeg(JPEG_SIZE, make_blocks(1));
    std::vector<std::string> warnings;
    // libjpeg takes some of the padding for pixels that it does not need.
    const std::string padded = file.substr(0, file.size() - 2) + std::string(100, 'a') + "\xff\xd9";
    expect_near(decode_texels(padded, "a", warnings), 1, make_blocks(1), 0);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(warnings[0].starts_with("a: libjpeg says: ")) << warnings[0];
    std::string spaced = file;
    spaced.insert(find_segment(spaced, '\xdb') - 2, "ab");
    EXPECT_TRUE(texel_warning(spaced).starts_with("a: libjpeg says: "));
    std::string version = file;
    version[version.find("JFIF") + 5] = 9;
    EXPECT_TRUE(texel_warning(version).starts_with("a: libjpeg says: "));
    expect_near(decode_quietly(file + "and what follows the end"), 1, make_blocks(1), 0);
}

TEST(TexelJpeg, BytesThatAreLeftOverWithinThePictureAreDamage) {
    std::string file = encode_jpeg(JPEG_SIZE, make_blocks(1), JCS_GRAYSCALE, PROCESSES[4]);
    file.insert(find_segment(file, '\xd1') - 2, std::string(100, 'a'));
    expect_damaged(file);
}

}  // namespace
}  // namespace candela
