// KTX 2 textures of Basis Universal: blocks of one colour each that the tests write, and files of its own
// encoder. Ref: Binomial, "UASTC LDR 4x4 Texture Specification"; IETF, RFC 8878 (Zstandard), section 3.1.1.
#include <gtest/gtest.h>

#include "base/file.h"
#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

#ifdef CANDELA_BASISU_FILES

constexpr uint32_t NO_COMPRESSION = 0, ZSTANDARD = 2;
constexpr uint32_t RGB = 0, RGBA = 3;

template <typename T>
void append(std::string& bytes, T value) {
    for (size_t i = 0; i < sizeof value; ++i)
        bytes += char(uint64_t(value) >> (8 * i));
}

// A block of UASTC's mode 8: one colour, after five bits of the mode.
std::string solid_block(std::array<uint8_t, 4> color) {
    std::string bytes;
    append(bytes, uint64_t{0x17} | uint64_t{color[0]} << 5 | uint64_t{color[1]} << 13 |
                      uint64_t{color[2]} << 21 | uint64_t{color[3]} << 29);
    append(bytes, uint64_t{0});
    return bytes;
}

// A frame of Zstandard with one block that is not compressed.
std::string raw_frame(const std::string& bytes) {
    std::string frame = "\x28\xb5\x2f\xfd\xa0";
    append(frame, uint32_t(bytes.size()));
    const auto header = uint32_t(1 | bytes.size() << 3);
    append(frame, uint16_t(header));
    append(frame, uint8_t(header >> 16));
    return frame + bytes;
}

struct KtxFile {
    uvec2 size;
    std::string blocks;
    uint32_t scheme = NO_COMPRESSION;
    uint32_t channels = RGBA;
    uint32_t format = 0;
    uint32_t layers = 0;
    uint32_t faces = 1;
    uint64_t unpacked_bytes = 0;  // 0: as many as there are.

    std::string bytes() const {
        constexpr uint32_t INDEX = 80, DESCRIPTION = INDEX + 24, DESCRIPTION_BYTES = 44;
        const std::string data = scheme == ZSTANDARD ? raw_frame(blocks) : blocks;
        std::string file = "\xabKTX 20\xbb\r\n\x1a\n";
        for (const uint32_t word : {format, 1u, size.x, size.y, 0u, layers, faces, 1u, scheme, DESCRIPTION,
                                    DESCRIPTION_BYTES, 0u, 0u})
            append(file, word);
        append(file, uint64_t{0});
        append(file, uint64_t{0});
        append(file, uint64_t{DESCRIPTION} + DESCRIPTION_BYTES);
        append(file, uint64_t{data.size()});
        append(file, unpacked_bytes != 0 ? unpacked_bytes : uint64_t{blocks.size()});
        constexpr uint32_t UASTC = 166, BT709 = 1, SRGB = 2;
        for (const uint32_t word : {DESCRIPTION_BYTES, 0u, 2u | 40u << 16, UASTC | BT709 << 8 | SRGB << 16,
                                    3u | 3u << 8, 16u, 0u, 127u << 16 | channels << 24, 0u, 0u, ~0u})
            append(file, word);
        return file + data;
    }
};

// Of 6x5 pixels: four blocks.
KtxFile four_blocks() {
    return {.size = {6, 5},
            .blocks = solid_block({1, 2, 3, 4}) + solid_block({250, 0, 128, 255}) +
                      solid_block({9, 99, 199, 0}) + solid_block({255, 255, 255, 128})};
}

std::array<uint32_t, 4> texel(const TexelImage& image, uint32_t x, uint32_t y) {
    const std::vector<uint32_t> values = texel_values(image);
    std::array<uint32_t, 4> result{0, 0, 0, 255};
    for (uint32_t i = 0; i < image.channels; ++i)
        result[i] = values.at((size_t{y} * image.size.x + x) * image.channels + i);
    return result;
}

constexpr const char* OTHER_CODEC =
    "its pixels are neither ETC1S nor UASTC, as Basis Universal writes them for glTF; write it as one of "
    "these";

using Texel = std::array<uint32_t, 4>;

TEST(TexelKtx, BlocksOfOneColourAreExact) {
    for (const uint32_t scheme : {NO_COMPRESSION, ZSTANDARD}) {
        KtxFile file = four_blocks();
        file.scheme = scheme;
        const TexelImage image = decode_quietly(file.bytes());
        ASSERT_EQ(image.size, uvec2(6, 5));
        ASSERT_EQ(image.channels, 4u);
        EXPECT_EQ(texel(image, 0, 0), (Texel{1, 2, 3, 4}));
        EXPECT_EQ(texel(image, 3, 3), (Texel{1, 2, 3, 4}));
        EXPECT_EQ(texel(image, 4, 0), (Texel{250, 0, 128, 255}));
        EXPECT_EQ(texel(image, 0, 4), (Texel{9, 99, 199, 0}));
        EXPECT_EQ(texel(image, 5, 4), (Texel{255, 255, 255, 128}));
    }
}

TEST(TexelKtx, WithoutAlphaThereAreThreeChannels) {
    KtxFile file = four_blocks();
    file.channels = RGB;
    const TexelImage image = decode_quietly(file.bytes());
    ASSERT_EQ(image.channels, 3u);
    EXPECT_EQ(image.texels.size(), 90u);
    EXPECT_EQ(texel(image, 3, 3), (Texel{1, 2, 3, 255}));
    EXPECT_EQ(texel(image, 0, 4), (Texel{9, 99, 199, 255}));
}

// The colours that fixtures/colours.json names: ETC1S gives nearly them.
TEST(TexelKtx, ReadsWhatTheEncoderWrites) {
    const std::filesystem::path folder = CANDELA_BASISU_FILES;
    for (const auto& [name, last, bound] : {std::tuple{"etc1s_srgb_mips.ktx2", Texel{255, 255, 255, 255}, 3},
                                            {"uastc_rgba.ktx2", Texel{255, 255, 255, 64}, 0}}) {
        const TexelImage image = decode_quietly(read_file(folder / name), name);
        ASSERT_EQ(image.size, uvec2(16, 16));
        EXPECT_EQ(image.channels, last[3] == 255 ? 3u : 4u);
        const std::array<Texel, 4> colors{Texel{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, last};
        for (uint32_t i = 0; i < 4; ++i) {
            const Texel found = texel(image, i % 2 * 15, i / 2 * 15);
            for (size_t c = 0; c < 4; ++c)
                EXPECT_NEAR(int(found[c]), int(colors[i][c]), bound) << name << ", quarter " << i;
        }
    }
    EXPECT_EQ(decode_quietly(read_file(folder / "uastc_odd.ktx2")).size, uvec2(6, 5));
    EXPECT_EQ(texel_error(read_file(folder / "etc1s_cube.ktx2")),
              "it has several images (a cube map, an array or a volume); write one as a file of its own");
    EXPECT_EQ(texel_error(read_file(folder / "uastc_hdr.ktx2")), OTHER_CODEC);
}

TEST(TexelKtx, RefusesWhatGltfDoesNotHave) {
    KtxFile file = four_blocks();
    file.format = 37;  // VK_FORMAT_R8G8B8A8_UNORM.
    EXPECT_EQ(texel_error(file.bytes()), OTHER_CODEC);
    file = four_blocks();
    file.layers = 2;
    EXPECT_EQ(texel_error(file.bytes()),
              "it has several images (a cube map, an array or a volume); write one as a file of its own");
    file = four_blocks();
    file.channels = 6;  // Red and green.
    EXPECT_EQ(texel_error(file.bytes()), "its channels are neither RGB nor RGBA; write it with these");
    file = four_blocks();
    EXPECT_EQ(texel_error(file.bytes(), {.max_pixels = 29}),
              "its 6x5 pixels are more than the 29 allowed here; make the image smaller");
}

// As in a .glb file, whose views begin anywhere.
TEST(TexelKtx, TheBytesMayLieAnywhere) {
    const std::string bytes = four_blocks().bytes();
    for (size_t shift = 0; shift < 4; ++shift) {
        const std::string moved = std::string(shift, ' ') + bytes;
        std::vector<std::string> warnings;
        const TexelImage image = decode_texels(std::string_view(moved).substr(shift), "a", warnings);
        EXPECT_EQ(texel(image, 4, 0), (Texel{250, 0, 128, 255}));
    }
}

TEST(TexelKtx, DamageCausesOnlyAnError) {
    KtxFile file = four_blocks();
    file.unpacked_bytes = uint64_t{1} << 30;
    file.scheme = ZSTANDARD;
    EXPECT_EQ(texel_error(file.bytes()), damaged_file("the size of its pixels is wrong"));
    file = four_blocks();
    file.blocks.resize(48);
    EXPECT_EQ(texel_error(file.bytes()), damaged_file("the size of its pixels is wrong"));
    std::vector<std::string> files{four_blocks().bytes()};
    for (const char* name : {"etc1s_srgb_mips.ktx2", "uastc_rgba.ktx2"})
        files.push_back(read_file(std::filesystem::path(CANDELA_BASISU_FILES) / name));
    for (const std::string& whole : files) {
        for (size_t length = 12; length < whole.size(); ++length)
            texel_error(whole.substr(0, length));
        // Any byte may be wrong: the file is refused, or gives an image.
        for (size_t i = 12; i < whole.size(); ++i) {
            std::string bytes = whole;
            bytes[i] = char(~bytes[i]);
            std::vector<std::string> warnings;
            try {
                decode_texels(bytes, "a", warnings, {.max_pixels = 1 << 16});
            } catch (const Error& error) {
                EXPECT_TRUE(std::string(error.what()).starts_with("cannot read \"a\": "));
            }
        }
    }
}

// Without the change that cmake/basisu.sh makes, the decoder reads beyond the tree of such a code.
TEST(TexelKtx, ACodeOfOneSymbolHasOneBit) {
    const std::filesystem::path corpora = CANDELA_CORPORA;
    EXPECT_EQ(texel_error(read_file(corpora / "ktx" / "one-symbol-of-many-bits")),
              damaged_file("its pixels are not valid"));
}

#else

TEST(TexelKtx, SaysHowToBuildWithADecoder) {
    EXPECT_EQ(
        texel_error("\xabKTX 20\xbb\r\n\x1a\n"),
        "this program is built without a decoder of KTX 2: run sh cmake/basisu.sh and build it again, or "
        "convert the texture to PNG, JPEG, WebP, Radiance HDR or OpenEXR");
}

#endif

}  // namespace
}  // namespace candela
