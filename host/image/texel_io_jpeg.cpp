// Reads JPEG files with libjpeg. An error of libjpeg's is a longjmp: it leaves only functions that have
// nothing to destroy.
#include <array>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <string>
#include <type_traits>

#include <jpeglib.h>
// After jpeglib.h, which it needs.
#include <jerror.h>

#include "base/memory_limit.h"
#include "image/image_io_parts.h"
#include "image/texel_io_parts.h"

namespace candela {
namespace {

// The most scans of a progressive file. A scan of a few bytes can take as long as the whole picture, and
// encoders make at most a few dozen.
constexpr int MAX_SCANS = 100;

class JpegDecoder {
  public:
    explicit JpegDecoder(const TexelSource& source) : source_(source) {
        jpeg_.err = jpeg_std_error(&errors_);
        errors_.error_exit = on_error;
        errors_.emit_message = on_message;
        jpeg_.client_data = this;
    }
    JpegDecoder(const JpegDecoder&) = delete;
    JpegDecoder& operator=(const JpegDecoder&) = delete;
    ~JpegDecoder() { jpeg_destroy_decompress(&jpeg_); }

    TexelImage decode();

  private:
    using Message = std::array<char, JMSG_LENGTH_MAX>;

    // Runs `step`, which libjpeg may leave by longjmp: then throws libjpeg's message.
    template <class Step>
    void attempt(const Step& step) {
        static_assert(std::is_trivially_destructible_v<Step>);
        if (!completes(step)) fail();
    }
    template <class Step>
    bool completes(const Step& step) {
        if (setjmp(jump_) != 0) return false;
        step();
        return true;
    }

    static JpegDecoder& decoder_of(j_common_ptr jpeg) {
        return *static_cast<JpegDecoder*>(jpeg->client_data);
    }
    [[noreturn]] static void on_error(j_common_ptr jpeg) {
        JpegDecoder& decoder = decoder_of(jpeg);
        jpeg->err->format_message(jpeg, decoder.error_.data());
        std::longjmp(decoder.jump_, 1);
    }
    // `level` is negative for a warning. libjpeg continues with what it has, or with grey.
    static void on_message(j_common_ptr jpeg, int level) {
        if (level >= 0) return;
        JpegDecoder& decoder = decoder_of(jpeg);
        if (!decoder.is_harmless_warning()) on_error(jpeg);
        Message& warning = decoder.warning_;
        if (warning[0] == '\0') jpeg->err->format_message(jpeg, warning.data());  // The first is enough.
    }
    static void on_progress(j_common_ptr jpeg) {
        JpegDecoder& decoder = decoder_of(jpeg);
        if (decoder.jpeg_.input_scan_number <= MAX_SCANS) return;
        decoder.too_many_scans_ = true;
        std::longjmp(decoder.jump_, 1);
    }

    bool is_harmless_warning() const;
    [[noreturn]] void fail() const;
    void read_header();
    void check_colors() const;
    void check_size() const;

    const TexelSource& source_;
    jpeg_decompress_struct jpeg_{};
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    std::jmp_buf jump_{};
    Message error_{};
    Message warning_{};
    bool header_is_read_ = false;
    bool too_many_scans_ = false;
};

// Whether the picture is unaffected by what libjpeg warns of.
bool JpegDecoder::is_harmless_warning() const {
    switch (errors_.msg_code) {
        case JWRN_ADOBE_XFORM:
        case JWRN_JFIF_MAJOR:
        case JWRN_NOT_SEQUENTIAL:
            return true;
        case JWRN_EXTRANEOUS_DATA:  // Between segments, or after the pixels, where cameras pad.
            return !header_is_read_ || errors_.msg_parm.i[1] == JPEG_EOI;
        default:
            return false;
    }
}

void JpegDecoder::fail() const {
    if (too_many_scans_) {
        source_.fail("it has more than " + std::to_string(MAX_SCANS) +
                     " scans; save it as a baseline JPEG, or with fewer");
    }
    switch (errors_.msg_code) {
        case JERR_OUT_OF_MEMORY:
            throw std::bad_alloc();
        case JERR_BAD_PRECISION:
        case JERR_SOF_UNSUPPORTED:
        case JERR_ARITH_NOTIMPL:
        case JERR_FRACT_SAMPLE_NOTIMPL:
            source_.fail("libjpeg does not decode its kind of JPEG (" + std::string(error_.data()) +
                         "); save it as a baseline or progressive JPEG of 8 bits");
        default:
            source_.fail_damaged(error_.data());
    }
}

void JpegDecoder::read_header() {
    attempt([this] {
        jpeg_create_decompress(&jpeg_);
        progress_.progress_monitor = on_progress;
        jpeg_.progress = &progress_;
        jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(source_.bytes.data()),
                     static_cast<unsigned long>(source_.bytes.size()));
        jpeg_read_header(&jpeg_, TRUE);
    });
    header_is_read_ = true;
}

void JpegDecoder::check_colors() const {
    switch (jpeg_.jpeg_color_space) {
        case JCS_GRAYSCALE:
        case JCS_RGB:
        case JCS_YCbCr:
            return;
        case JCS_CMYK:
        case JCS_YCCK:
            source_.fail("its colours are CMYK, which are for printing; convert it to RGB");
        default:
            source_.fail("it has " + std::to_string(jpeg_.num_components) +
                         " channels of unknown meaning; save it as grey or RGB");
    }
}

// The finest channels have a block for 8x8 pixels (or for 8x16, where one is finer across and another down),
// and a block needs at least one bit, or less with arithmetic coding.
void JpegDecoder::check_size() const {
    constexpr uint64_t PIXELS_PER_BYTE = uint64_t{8} * 128;
    const uvec2 size(jpeg_.image_width, jpeg_.image_height);
    check_pixel_count(source_.name, size.x, size.y, source_.limits.max_pixels);
    if (jpeg_.arith_code == 0 && uint64_t{size.x} * size.y > PIXELS_PER_BYTE * source_.bytes.size())
        source_.fail_too_short(size);
}

TexelImage JpegDecoder::decode() {
    read_header();
    check_size();
    check_colors();
    const uvec2 size(jpeg_.image_width, jpeg_.image_height);
    const bool grey = jpeg_.jpeg_color_space == JCS_GRAYSCALE;
    // For images in several scans, all coefficients are kept: at most two bytes for each channel of a pixel.
    const MemoryCharge coefficients(
        jpeg_has_multiple_scans(&jpeg_) != 0 ? 2 * uint64_t(jpeg_.num_components) * size.x * size.y : 0);
    attempt([&] {
        jpeg_.out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
        jpeg_.dct_method = JDCT_ISLOW;
        jpeg_.do_fancy_upsampling = TRUE;
        jpeg_.do_block_smoothing = FALSE;  // It guesses what an unfinished progressive file lacks.
        jpeg_start_decompress(&jpeg_);
    });
    TexelImage image = make_texels(size, grey ? 1 : 3, TexelType::unorm8);
    attempt([&] {
        const size_t row_bytes = size_t{size.x} * image.channels;
        while (jpeg_.output_scanline < size.y) {
            JSAMPROW row =
                reinterpret_cast<JSAMPROW>(image.texels.data()) + jpeg_.output_scanline * row_bytes;
            jpeg_read_scanlines(&jpeg_, &row, 1);
        }
        jpeg_finish_decompress(&jpeg_);
    });
    if (warning_[0] != '\0') source_.warn("libjpeg says: " + std::string(warning_.data()));
    return image;
}

}  // namespace

TexelImage decode_jpeg_texels(const TexelSource& source) {
    return JpegDecoder(source).decode();
}

}  // namespace candela
