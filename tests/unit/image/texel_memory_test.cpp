// Images of textures that memory does not hold: sizes are checked before memory is taken, and where there is
// not enough of it, that is the error. (Sanitizers need more address space.)
#include <fstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/error.h"
#include "unit/image/image_fixture.h"
#include "unit/image/texel_fixture.h"

#ifndef CANDELA_SANITIZE

namespace candela {
namespace {

// As long as it lives, the process gets no more than 64 MiB of memory in addition.
class LittleMemory {
  public:
    LittleMemory() {
        rlim_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        ::getrlimit(RLIMIT_AS, &old_limit_);
        rlimit limit = old_limit_;
        limit.rlim_cur = pages * rlim_t(::sysconf(_SC_PAGESIZE)) + (rlim_t(64) << 20);
        ::setrlimit(RLIMIT_AS, &limit);
    }
    LittleMemory(const LittleMemory&) = delete;
    LittleMemory& operator=(const LittleMemory&) = delete;
    ~LittleMemory() { ::setrlimit(RLIMIT_AS, &old_limit_); }

  private:
    rlimit old_limit_{};
};

// A WebP file of that many black pixels across and down: of each Huffman code it says that there is one
// symbol, 0, and so the pixels take no bits.
std::string black_webp(uint32_t size) {
    const uint32_t header = (size - 1) | (size - 1) << 14;
    const std::string pixels{
        '\x2f', char(header), char(header >> 8), char(header >> 16), char(header >> 24), '\x88',
        '\x88', '\x08'};
    return std::string("RIFF\x14\0\0\0WEBPVP8L\x08\0\0\0", 20) + pixels;
}

// A progressive JPEG file with arithmetic coding, whose header says 16000x16000.
std::string huge_jpeg() {
    std::string file = encode_jpeg({16, 16}, random_bytes(256), JCS_GRAYSCALE, [](j_compress_ptr jpeg) {
        jpeg_simple_progression(jpeg);
        jpeg->arith_code = TRUE;
    });
    return file.replace(file.find("\xff\xca") + 5, 4, "\x3e\x80\x3e\x80");
}

// The message after `cannot read "a": ` of a file that memory does not hold.
std::string memory_error(const std::string& bytes) {
    std::vector<std::string> warnings;
    try {
        const LittleMemory limit;
        decode_texels(bytes, "a", warnings);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        return error.what();
    }
    return "";
}

TEST(TexelMemory, ThatDoesNotSufficeIsTheError) {
    const std::string message =
        "cannot read \"a\": there is not enough memory for its pixels; use a smaller image or a larger "
        "machine";
    EXPECT_EQ(memory_error(black_webp(16384)), message);
    EXPECT_EQ(memory_error(huge_jpeg()), message);
}

TEST(TexelMemory, IsNotTakenForMorePixelsThanAllowed) {
    const LittleMemory limit;
    EXPECT_EQ(texel_error(black_webp(16384), {.max_pixels = (uint64_t{1} << 28) - 1}),
              "its 16384x16384 pixels are more than the 268435455 allowed here; make the image smaller");
    EXPECT_EQ(texel_error(huge_jpeg(), {.max_pixels = 255'999'999}),
              "its 16000x16000 pixels are more than the 255999999 allowed here; make the image smaller");
}

TEST(TexelMemory, ABlackImageOfAFewBytesIsRead) {
    const TexelImage image = decode_quietly(black_webp(64));
    EXPECT_EQ(image.size, uvec2(64));
    EXPECT_EQ(texel_values(image), std::vector<uint32_t>(size_t{3} * 64 * 64, 0));
}

}  // namespace
}  // namespace candela

#endif  // CANDELA_SANITIZE
