// Writes JPEG files with libjpeg. An error of libjpeg's is a longjmp: it leaves only functions that have
// nothing to destroy.
#include <array>
#include <cassert>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <jpeglib.h>

#include "base/error.h"
#include "base/file.h"
#include "image/image_io_parts.h"

namespace candela {
namespace {

class JpegEncoder {
  public:
    explicit JpegEncoder(const TexelImage& picture) : picture_(picture) {
        jpeg_.err = jpeg_std_error(&errors_);
        errors_.error_exit = on_error;
        errors_.emit_message = [](j_common_ptr, int) {};
        jpeg_.client_data = this;
    }
    JpegEncoder(const JpegEncoder&) = delete;
    JpegEncoder& operator=(const JpegEncoder&) = delete;
    ~JpegEncoder() {
        jpeg_destroy_compress(&jpeg_);
        std::free(bytes_);
    }

    // Returns whether bytes() has the file; otherwise, message() says why not.
    bool encode(int quality) {
        if (setjmp(jump_) != 0) return false;
        jpeg_create_compress(&jpeg_);
        jpeg_mem_dest(&jpeg_, &bytes_, &size_);
        jpeg_.image_width = picture_.size.x;
        jpeg_.image_height = picture_.size.y;
        jpeg_.input_components = 3;
        jpeg_.in_color_space = JCS_RGB;
        jpeg_set_defaults(&jpeg_);
        jpeg_set_quality(&jpeg_, quality, TRUE);
        jpeg_.optimize_coding = TRUE;
        jpeg_.comp_info[0].h_samp_factor = jpeg_.comp_info[0].v_samp_factor = 1;
        jpeg_start_compress(&jpeg_, TRUE);
        const auto* const pixels = reinterpret_cast<const JSAMPLE*>(picture_.texels.data());
        while (jpeg_.next_scanline < jpeg_.image_height) {
            auto* row = const_cast<JSAMPLE*>(pixels + size_t{3} * jpeg_.image_width * jpeg_.next_scanline);
            jpeg_write_scanlines(&jpeg_, &row, 1);
        }
        jpeg_finish_compress(&jpeg_);
        return true;
    }
    std::string bytes() const { return {reinterpret_cast<const char*>(bytes_), size_}; }
    const char* message() const { return message_.data(); }

  private:
    [[noreturn]] static void on_error(j_common_ptr jpeg) {
        JpegEncoder& encoder = *static_cast<JpegEncoder*>(jpeg->client_data);
        jpeg->err->format_message(jpeg, encoder.message_.data());
        std::longjmp(encoder.jump_, 1);
    }

    const TexelImage& picture_;
    jpeg_compress_struct jpeg_{};
    jpeg_error_mgr errors_{};
    std::jmp_buf jump_{};
    std::array<char, JMSG_LENGTH_MAX> message_{};
    unsigned char* bytes_ = nullptr;
    unsigned long size_ = 0;
};

}  // namespace

std::string encode_jpeg(const std::filesystem::path& path, const TexelImage& picture, int quality) {
    assert(picture.channels == 3 && picture.type == TexelType::unorm8);
    check_sides(path, picture, JPEG_MAX_DIMENSION, "JPEG");
    JpegEncoder encoder(picture);
    if (!encoder.encode(quality)) {
        throw Error("cannot write " + quoted(path) + ": libjpeg says: " + encoder.message() +
                    "; write a PNG file");
    }
    return encoder.bytes();
}

}  // namespace candela
