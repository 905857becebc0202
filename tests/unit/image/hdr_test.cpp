// Radiance pictures: each encoding, made here byte by byte, gives the exact values; damage is reported
// wherever it is.
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "image/image_io.h"
#include "unit/base/base_fixture.h"
#include "unit/image/image_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

using Pixel = std::array<int, 4>;

constexpr size_t HDR_COLUMNS = 300;  // Longer than the longest run.
constexpr size_t HDR_ROWS = 3;

// Normalised pixels (the greatest mantissa is at least 128) of all exponents: a third of them without any
// run, then runs of several lengths.
std::vector<Pixel> make_pixels(size_t total = HDR_COLUMNS * HDR_ROWS) {
    std::mt19937 random(5);
    std::vector<Pixel> pixels;
    for (int i = 0; pixels.size() < total / 3; ++i)
        pixels.push_back({128 + i % 128, i % 256, 7 * i % 256, i % 256});
    while (pixels.size() < total) {
        const Pixel pixel = {int(128 + random() % 128), int(random() % 256), int(random() % 256),
                             int(random() % 256)};
        const size_t length = random() % 3 == 0 ? 1 + random() % 280 : 1;
        pixels.insert(pixels.end(), std::min(length, total - pixels.size()), pixel);
    }
    return pixels;
}

std::string flat(const Pixel& pixel) {
    return rgbe(pixel[0], pixel[1], pixel[2], pixel[3]);
}

std::string encode_flat(const Pixel* row, size_t width) {
    std::string bytes;
    for (size_t x = 0; x < width; ++x)
        bytes += flat(row[x]);
    return bytes;
}

// The number of pixels from x on that equal the one at x.
template <class Equal>
size_t run_length(size_t x, size_t width, size_t limit, Equal equal) {
    size_t count = 1;
    while (x + count < width && count < limit && equal(x, x + count))
        ++count;
    return count;
}

// Runs as pixels (1, 1, 1, n); where they are longer than 255, in two digits.
std::string encode_old(const Pixel* row, size_t width) {
    std::string bytes;
    for (size_t x = 0; x < width;) {
        const size_t count =
            run_length(x, width, 60'000, [&](size_t a, size_t b) { return row[a] == row[b]; });
        bytes += flat(row[x]);
        if (count > 1) bytes += rgbe(1, 1, 1, int((count - 1) % 256));
        if (count > 256) bytes += rgbe(1, 1, 1, int((count - 1) / 256));
        x += count;
    }
    return bytes;
}

// Component by component, in runs of 2 to 127 and stretches of at most 128 bytes.
std::string encode_new(const Pixel* row, size_t width) {
    std::string bytes = rgbe(2, 2, int(width / 256), int(width % 256));
    for (size_t c = 0; c < 4; ++c) {
        const auto equal = [&](size_t a, size_t b) { return row[a][c] == row[b][c]; };
        std::string stretch;
        const auto flush = [&] {
            if (!stretch.empty()) bytes += char(stretch.size()) + stretch;
            stretch.clear();
        };
        for (size_t x = 0; x < width;) {
            const size_t count = run_length(x, width, 127, equal);
            if (count == 1) {
                stretch += char(row[x][c]);
                if (stretch.size() == 128) flush();
            } else {
                flush();
                bytes += char(128 + count);
                bytes += char(row[x][c]);
            }
            x += count;
        }
        flush();
    }
    return bytes;
}

using Encoder = std::string (*)(const Pixel* row, size_t width);
constexpr std::array<Encoder, 3> ENCODERS = {encode_flat, encode_old, encode_new};

std::string encode(Encoder encoder, const std::vector<Pixel>& pixels, size_t width) {
    std::string bytes = hdr_header(width, pixels.size() / width);
    for (size_t begin = 0; begin < pixels.size(); begin += width)
        bytes += encoder(&pixels[begin], width);
    return bytes;
}

class Hdr : public testing::Test {
  protected:
    Image read(const std::string& bytes) {
        write_quickly(path_, bytes);
        return read_hdr(path_);
    }
    // The message after `cannot read "PATH": `.
    std::string error(const std::string& bytes) {
        const std::string message = error_of([&] { read(bytes); });
        const std::string start = "cannot read \"" + path_.string() + "\": ";
        EXPECT_EQ(message.substr(0, start.size()), start);
        return message.substr(std::min(start.size(), message.size()));
    }

    TemporaryDirectory directory_;
    fs::path path_ = directory_ / "a.hdr";
};

std::string damaged(const std::string& what) {
    return "the file is damaged or incomplete (" + what + "); write it again";
}

void expect_pixels(const Image& image, const std::vector<Pixel>& pixels) {
    ASSERT_EQ(image.pixel_count(), pixels.size());
    const RgbPlanes planes = image.find_rgb().value();
    for (size_t i = 0; i < pixels.size(); ++i) {
        for (size_t c = 0; c < 3; ++c) {
            // In double, where neither the power nor the product is rounded; a float holds it exactly.
            const double expected = pixels[i][3] == 0 ? 0.0 : pixels[i][c] * std::exp2(pixels[i][3] - 136);
            ASSERT_EQ(double(planes[c][i]), expected) << i;
        }
    }
}

TEST_F(Hdr, EachEncodingGivesTheExactValues) {
    const std::vector<Pixel> pixels = make_pixels();
    for (const Encoder encoder : ENCODERS) {
        const Image image = read(encode(encoder, pixels, HDR_COLUMNS));
        EXPECT_EQ(image.full, uvec2(HDR_COLUMNS, HDR_ROWS));
        EXPECT_EQ(image.data, (PixelRect{0, 0, HDR_COLUMNS, HDR_ROWS}));
        EXPECT_EQ(image.channels.size(), 3u);
        expect_pixels(image, pixels);
    }
}

TEST_F(Hdr, RowsMayDifferInTheirEncoding) {
    const std::vector<Pixel> pixels = make_pixels();
    std::string bytes = hdr_header(HDR_COLUMNS, HDR_ROWS);
    for (size_t y = 0; y < HDR_ROWS; ++y)
        bytes += ENCODERS[(y + 1) % 3](&pixels[y * HDR_COLUMNS], HDR_COLUMNS);
    expect_pixels(read(bytes), pixels);
}

TEST_F(Hdr, TellsPixelsFromTheStartOfAnEncodedRow) {
    std::vector<Pixel> pixels = {{2, 2, 0, 7}, {200, 1, 2, 130}, {2, 2, 0, 7}, {0, 0, 0, 0}};
    expect_pixels(read(encode(encode_flat, pixels, 2)), pixels);  // Looks like the start of 7 encoded pixels.
    pixels.assign(32768, {2, 2, 5, 0});                           // Encoded rows are shorter.
    pixels[1] = {255, 255, 255, 255};
    expect_pixels(read(encode(encode_old, pixels, pixels.size())), pixels);
    pixels.assign(8, {2, 2, 200, 130});  // The width of an encoded row would be below 32768.
    expect_pixels(read(encode(encode_flat, pixels, 8)), pixels);
}

TEST_F(Hdr, AcceptsOtherHeaders) {
    const std::string picture = "\n-Y 1 +X 1\n" + rgbe(128, 64, 32, 129);
    for (const char* start : {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n", "#?RADIANCE\n# a comment\nGAMMA=1\n",
                              "#?RADIANCE\nVIEW= -vp 0 0 0\nFORMAT=32-bit_rle_rgbe\nSOFTWARE=a = b\n"}) {
        const Image image = read(start + picture);
        EXPECT_EQ(image.find("R")->values[0], 1.0f) << start;
        EXPECT_EQ(image.find("G")->values[0], 0.5f);
        EXPECT_EQ(image.find("B")->values[0], 0.25f);
    }
}

// As programs for Windows end lines, and with blanks where people put them. What begins with a blank tells of
// another picture.
TEST_F(Hdr, AcceptsOtherLineEndsAndBlanks) {
    const std::string pixel = rgbe(128, 64, 32, 129);
    for (const std::string start : {"#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\nEXPOSURE=2\r\n\r\n-Y 1 +X 1\r\n",
                                    "#?RADIANCE\nFORMAT= 32-bit_rle_rgbe \nEXPOSURE = 2 \n\n-Y  1   +X 1 \n",
                                    "#?RGBE\nFORMAT\t=\t32-bit_rle_rgbe\t\nEXPOSURE=2\n\tEXPOSURE=4\n "
                                    "FORMAT=32-bit_rle_xyze\n\n-Y 1 +X "
                                    "1\n"}) {
        const Image image = read(start + pixel);
        EXPECT_EQ(image.find("R")->values[0], 0.5f) << start;
        EXPECT_EQ(image.find("G")->values[0], 0.25f);
        EXPECT_EQ(image.find("B")->values[0], 0.125f);
    }
}

// A picture of 9 x 8 pixels, rows of which may be encoded either way. The pixel that is y from the top and x
// from the left has the mantissas 128 + x and y.
TEST_F(Hdr, ReadsRowsInEachOfTheEightOrders) {
    const size_t width = 9, height = 8;
    for (const bool columns : {false, true}) {
        for (const char x_sign : {'+', '-'}) {
            for (const char y_sign : {'+', '-'}) {
                std::vector<Pixel> pixels;
                const size_t rows = columns ? width : height, length = columns ? height : width;
                for (size_t i = 0; i < rows; ++i) {
                    for (size_t k = 0; k < length; ++k) {
                        const size_t x = columns ? i : k, y = columns ? k : i;
                        // x grows to the right, and y upwards.
                        pixels.push_back({int(128 + (x_sign == '+' ? x : width - 1 - x)),
                                          int(y_sign == '-' ? y : height - 1 - y), 0, 136});
                    }
                }
                const std::string x_text = {x_sign, 'X'}, y_text = {y_sign, 'Y'};
                const std::string order = (columns ? x_text : y_text) + ' ' + std::to_string(rows) + ' ' +
                                          (columns ? y_text : x_text) + ' ' + std::to_string(length);
                SCOPED_TRACE(order);
                std::string bytes = "#?RADIANCE\n\n" + order + '\n';
                for (size_t i = 0; i < rows; ++i)
                    bytes += (i % 2 == 0 ? encode_flat : encode_new)(&pixels[i * length], length);
                const Image image = read(bytes);
                ASSERT_EQ(image.full, uvec2(width, height));
                for (size_t y = 0, i = 0; y < height; ++y) {
                    for (size_t x = 0; x < width; ++x, ++i) {
                        EXPECT_EQ(image.find("R")->values[i], float(128 + x));
                        EXPECT_EQ(image.find("G")->values[i], float(y));
                    }
                }
            }
        }
    }
}

TEST_F(Hdr, DividesByTheExposure) {
    const std::string pixel = rgbe(128, 128, 128, 129);  // 1, 1, 1.
    const Image image =
        read(hdr_header(1, 1, "EXPOSURE=4\nCOLORCORR= 0.5 1 2\nEXPOSURE= 2.5e-1\nEXPOSURE=2.000000e+00\n") +
             pixel);
    EXPECT_EQ(image.find("R")->values[0], 1.0f);  // 1 / (4 * 0.25 * 2 * 0.5)
    EXPECT_EQ(image.find("G")->values[0], 0.5f);
    EXPECT_EQ(image.find("B")->values[0], 0.25f);
    for (const char* line : {"EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=bright", "EXPOSURE=inf",
                             "EXPOSURE=", "EXPOSURE=1e99", "COLORCORR=1 2"}) {
        EXPECT_EQ(error(hdr_header(1, 1, std::string(line) + '\n') + pixel),
                  damaged("its header line \"" + std::string(line) + "\" needs numbers above 0"));
    }
    for (const char* lines : {"EXPOSURE=1e30\nEXPOSURE=1e30\n", "EXPOSURE=1e-30\nEXPOSURE=1e-30\n"}) {
        EXPECT_EQ(error(hdr_header(1, 1, lines) + pixel),
                  damaged("its exposures multiply to no usable number"));
    }
}

TEST_F(Hdr, SaysWhatIsNoRadiancePicture) {
    EXPECT_EQ(error_of([&] { read_hdr(path_); }),
              "cannot read \"" + path_.string() + "\": the file does not exist; check the name");
    for (const char* text : {"", "#", "no image at all", "\x89PNG\r\n"})
        EXPECT_EQ(error(text), "it is not a Radiance picture; give an .hdr image");
}

TEST_F(Hdr, SaysWhatItCannotRead) {
    EXPECT_EQ(error("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + rgbe(128, 128, 128, 129)),
              "its format is \"32-bit_rle_xyze\"; convert it to \"32-bit_rle_rgbe\"");
}

TEST_F(Hdr, RefusesSizesThatCannotBe) {
    for (const char* size : {"-Y 0 +X 1", "-Y 1 +X 0", "-Y -1 +X 1", "-Y 1 +X -1", "-Y 1048577 +X 1",
                             "-Y 1 +X 1048577", "-Y 99999999999999999999 +X 1", "-Y 1 +Z 1", "-Y 1 +Y 1",
                             "+X 1 -X 1", "-Y a +X 1", "-Y 1", "", "1 1"}) {
        EXPECT_EQ(error("#?RADIANCE\n\n" + std::string(size) + '\n' + rgbe(128, 128, 128, 129)),
                  damaged('"' + std::string(size) + "\" is not a size"));
    }
}

TEST_F(Hdr, RefusesMorePixelsThanAllowedBeforeItReadsThem) {
    write_quickly(path_, hdr_header(20, 10));
    EXPECT_EQ(error_of([&] { read_hdr(path_, {.max_pixels = 199}); }),
              "cannot read \"" + path_.string() +
                  "\": its 20x10 pixels are more than the 199 allowed here; make the image smaller");
    EXPECT_EQ(error_of([&] { read_hdr(path_, {.max_pixels = 200}); }),
              "cannot read \"" + path_.string() + "\": " + damaged("it ends in row 1"));
}

TEST_F(Hdr, ReportsATruncatedFileWhereverItEnds) {
    const size_t width = 30;
    const std::vector<Pixel> pixels = make_pixels(3 * width);
    for (const Encoder encoder : ENCODERS) {
        const std::string bytes = encode(encoder, pixels, width);
        const size_t header = hdr_header(width, 3).size();
        std::vector<size_t> row_ends;
        for (size_t y = 0; y < 3; ++y)
            row_ends.push_back((y == 0 ? header : row_ends.back()) +
                               encoder(&pixels[y * width], width).size());
        size_t row = 0;
        for (size_t size = 2; size < bytes.size(); ++size) {
            if (size == row_ends[row]) ++row;
            const std::string place = size < header ? "its header" : "row " + std::to_string(row + 1);
            ASSERT_EQ(error(bytes.substr(0, size)), damaged("it ends in " + place)) << size;
        }
    }
}

TEST_F(Hdr, AHugePictureWithoutPixelsNeedsNoMemory) {
    EXPECT_EQ(error(hdr_header(1024, 1024)), damaged("it ends in row 1"));
    const std::string huge = hdr_header(32'768, 32'768);
    EXPECT_EQ(error(huge), "its 32768x32768 pixels are more than " + std::to_string(huge.size()) +
                               " bytes can plausibly hold; make the image smaller");
}

TEST_F(Hdr, ReportsDamagedRuns) {
    const std::string row = encode_new(std::vector<Pixel>(8, {128, 128, 128, 129}).data(), 8);
    const std::string exceeds = damaged("a run of pixels exceeds row 2");
    const std::string start = hdr_header(8, 2) + row;
    const std::string filler(64, '\x01');
    EXPECT_EQ(read(start + row).pixel_count(), 16u);
    EXPECT_EQ(error(start + rgbe(2, 2, 0, 9) + filler), damaged("row 2 has another width"));
    EXPECT_EQ(error(start + rgbe(2, 2, 0, 8) + '\x89' + filler), exceeds) << "a run of 9";
    EXPECT_EQ(error(start + rgbe(2, 2, 0, 8) + '\x09' + filler), exceeds) << "a stretch of 9";
    EXPECT_EQ(error(start + rgbe(2, 2, 0, 8) + "\x07" + "abcdefg" + '\x82' + filler), exceeds) << "7, then 2";
    EXPECT_EQ(error(start + rgbe(2, 2, 0, 8) + '\0' + filler), exceeds) << "a stretch of none";
    const std::string pixel = rgbe(200, 0, 0, 128);
    EXPECT_EQ(read(start + pixel + rgbe(1, 1, 1, 7)).pixel_count(), 16u);
    EXPECT_EQ(error(start + pixel + rgbe(1, 1, 1, 8)), exceeds) << "one too many";
    EXPECT_EQ(error(start + rgbe(1, 1, 1, 7) + pixel), exceeds) << "nothing to repeat";
    EXPECT_EQ(error(start + pixel + rgbe(1, 1, 1, 0) + rgbe(1, 1, 1, 1)), exceeds) << "256 more";
    std::string zeros = pixel;
    for (int digit = 0; digit < 12; ++digit)
        zeros += rgbe(1, 1, 1, 0);
    EXPECT_EQ(error(start + zeros + rgbe(1, 1, 1, 1)), exceeds) << "more digits than a number has";
}

TEST_F(Hdr, SurvivesDamage) {
    const std::vector<Pixel> pixels = make_pixels();
    std::mt19937 random(6);
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        std::string bytes = encode(ENCODERS[size_t(i % 3)], pixels, HDR_COLUMNS);
        bytes[random() % bytes.size()] = char(random());
        bytes[random() % 70] = char(random());  // In the header, mostly.
        try {
            read(bytes);
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace candela
