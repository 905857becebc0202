// Targa and BMP files, byte by byte.
#include "unit/base/damage.h"
#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

using namespace std::string_literals;
using Values = std::vector<uint32_t>;

std::string little(uint64_t number, size_t count) {
    std::string bytes;
    for (size_t i = 0; i < count; ++i, number >>= 8)
        bytes += char(number & 0xFFu);
    return bytes;
}

// The header of a Targa file. `flags` are 32 for rows from above, and how many bits of a pixel are alpha.
std::string targa(uint32_t type, uvec2 size, uint32_t bits, uint32_t flags, uint32_t colors = 0) {
    return "\0"s + little(colors > 0, 1) + little(type, 1) + little(0, 2) + little(colors, 2) +
           little(colors > 0 ? 24 : 0, 1) + little(0, 4) + little(size.x, 2) + little(size.y, 2) +
           little(bits, 1) + little(flags, 1);
}

// The headers of a BMP file with a palette of `colors`, and that palette, which is grey.
std::string bmp(int32_t width, int32_t height, uint32_t bits, uint32_t colors = 0, uint32_t compression = 0) {
    std::string file = "BM" + little(0, 8) + little(54 + 4 * colors, 4) + little(40, 4) +
                       little(uint32_t(width), 4) + little(uint32_t(height), 4) + little(1, 2) +
                       little(bits, 2) + little(compression, 4) + little(0, 20);
    for (uint32_t i = 0; i < colors; ++i)
        file += little(i * 0x010101u, 4);
    return file;
}

// Rows run from below unless the header says otherwise; colours are blue, green, red.
TEST(TexelTarga, ReadsAllTypes) {
    const TexelImage rgb = decode_quietly(targa(2, {1, 2}, 24, 0) + "\1\2\3\4\5\6");
    EXPECT_EQ(rgb.size, uvec2(1, 2));
    EXPECT_EQ(rgb.channels, 3u);
    EXPECT_EQ(texel_values(rgb), (Values{6, 5, 4, 3, 2, 1}));
    EXPECT_EQ(texel_values(decode_quietly(targa(2, {1, 2}, 24, 32) + "\1\2\3\4\5\6")),
              (Values{3, 2, 1, 6, 5, 4}));
    EXPECT_EQ(texel_values(decode_quietly(targa(2, {1, 1}, 32, 8) + "\1\2\3\4")), (Values{3, 2, 1, 4}));
    EXPECT_EQ(texel_values(decode_quietly(targa(2, {1, 1}, 32, 0) + "\1\2\3\4")), (Values{3, 2, 1}));
    EXPECT_EQ(texel_values(decode_quietly(targa(3, {2, 1}, 8, 0) + "\7\x08")), (Values{7, 8}));
    EXPECT_EQ(texel_values(decode_quietly(targa(1, {2, 1}, 8, 0, 2) + "\1\2\3\4\5\6" + "\1\0"s)),
              (Values{6, 5, 4, 3, 2, 1}));
    EXPECT_EQ(texel_values(decode_quietly(targa(2, {1, 1}, 16, 0) + little(31u << 10, 2))),
              (Values{255, 0, 0}));
    // Two pixels that are equal, and two that are not.
    EXPECT_EQ(texel_values(decode_quietly(targa(11, {4, 1}, 8, 0) + "\x81\x09\x01\5\6"s)),
              (Values{9, 9, 5, 6}));
}

TEST(TexelTarga, RefusesWhatItCannotShow) {
    EXPECT_EQ(texel_error(targa(2, {1, 1}, 24, 16) + "\1\2\3"),
              "its rows run from right to left; convert it to PNG");
    std::string later = targa(1, {1, 1}, 8, 0, 1) + "\1\2\3" + "\0"s;
    later[3] = 1;
    EXPECT_EQ(texel_error(later), "its palette does not begin at 0; convert it to PNG");
    EXPECT_EQ(texel_error(targa(2, {1, 2}, 24, 0) + "\1\2\3\4\5"),
              damaged_file("its 1x2 pixels need more than 23 bytes"));
    for (const std::string& packets : {""s, "\xff"s, "\xff\1\xff\2"s, "\x7f\1\2"s})
        EXPECT_EQ(texel_error(targa(11, {1000, 1}, 8, 0) + packets).substr(0, 30),
                  damaged_file("").substr(0, 30));
    EXPECT_NE(texel_error(targa(11, {60000, 60000}, 8, 0)).find("pixels"), std::string::npos);
}

// Rows run from below unless the height is negative, and are filled up to four bytes.
TEST(TexelBmp, ReadsAllDepths) {
    const std::string rows = "\1\2\3\0\4\5\6\0"s;
    EXPECT_EQ(texel_values(decode_quietly(bmp(1, 2, 24) + rows)), (Values{6, 5, 4, 3, 2, 1}));
    EXPECT_EQ(texel_values(decode_quietly(bmp(1, -2, 24) + rows)), (Values{3, 2, 1, 6, 5, 4}));
    EXPECT_EQ(texel_values(decode_quietly(bmp(1, 1, 32) + "\1\2\3\4")), (Values{3, 2, 1, 4}));
    EXPECT_EQ(texel_values(decode_quietly(bmp(1, 1, 32) + "\1\2\3\0"s)), (Values{3, 2, 1, 255}));
    EXPECT_EQ(texel_values(decode_quietly(bmp(2, 1, 8, 256) + "\7\x09\0\0"s)), (Values{7, 7, 7, 9, 9, 9}));
    EXPECT_EQ(texel_values(decode_quietly(bmp(3, 1, 4, 16) + "\x12\x30\0\0"s)),
              (Values{1, 1, 1, 2, 2, 2, 3, 3, 3}));
    EXPECT_EQ(texel_values(decode_quietly(bmp(2, 1, 1, 2) + "\x40\0\0\0"s)), (Values{0, 0, 0, 1, 1, 1}));
}

TEST(TexelBmp, RefusesWhatItCannotShow) {
    EXPECT_EQ(texel_error("BM"), damaged_file("it ends in its header"));
    EXPECT_EQ(texel_error(bmp(1, 1, 8, 256, 1) + "\1\1\0\1"s), "it is compressed; convert it to PNG");
    EXPECT_EQ(texel_error(bmp(1, 1, 8, 17) + "\1\0\0\0"s),
              "its palette has only 17 colours; convert it to PNG");
    EXPECT_EQ(texel_error(bmp(1, 2, 24) + "\1\2\3\0\4\5\6"s),
              damaged_file("its 1x2 pixels need more than 61 bytes"));
    EXPECT_EQ(texel_error(bmp(0, 2, 24)), damaged_file("its header says 0x2 pixels"));
    EXPECT_EQ(texel_error(bmp(1, INT32_MIN, 24)), damaged_file("its header says 1x2147483648 pixels"));
    std::string contradiction = bmp(1, 1, 24) + "\1\2\3\0"s;
    contradiction[10] = 20;
    EXPECT_EQ(texel_error(contradiction), damaged_file("its header contradicts itself"));
    EXPECT_EQ(texel_error(bmp(1, 1, 7, 256) + "\0\0\0\0"s), "stb_image says: bad bpp; convert it to PNG");
}

TEST(TexelStb, LoadsOrIsRefusedAfterAnyChangeOfAByte) {
    for (const std::string& good : {targa(10, {3, 2}, 24, 0) + "\x82\1\2\3\2\1\2\3\4\5\6\7\x08\x09"s,
                                    bmp(3, 2, 4, 16) + "\x12\x30\0\0\x12\x30\0\0"s}) {
        const size_t refused =
            count_refused(good, "\0\1\2\3\x08\x10\x18\x20\xff"s, 2000, [&](const std::string& bytes) {
                std::vector<std::string> warnings;
                decode_texels(bytes, "a", warnings, {.max_pixels = 1 << 14});
            });
        EXPECT_GT(refused, 500u);
        EXPECT_LT(refused, 2000u);
    }
}

}  // namespace
}  // namespace candela
