// Reads PNG files with libpng. An error of libpng's is a longjmp: it leaves only functions that have nothing
// to destroy.
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <png.h>

#include "base/text.h"
#include "image/image_io_parts.h"
#include "image/texel_io_parts.h"

namespace candela {
namespace {

// Values from the chunks before the pixels that are needed before libpng reads them, or that libpng does not
// report.
struct PngStart {
    uvec2 size{0};
    uint32_t bits = 0;  // Bits of a sample, or of an index into the palette.
    uint32_t color_type = 0;
    bool srgb = false;
    bool animated = false;
    std::optional<uint32_t> gamma;  // In units of 1/PNG_FP_1.
};

uint32_t big_endian(std::string_view bytes, size_t at) {
    uint32_t number = 0;
    for (size_t i = 0; i < 4; ++i)
        number = number << 8 | uint8_t(bytes[at + i]);
    return number;
}

// A chunk is the number of its data bytes, its type, the data and a checksum, which libpng verifies.
PngStart read_png_start(const TexelSource& source) {
    constexpr size_t SIGNATURE = 8, CHUNK_HEADER = 8, CHECKSUM = 4, IHDR = 13, GAMA = 4;
    std::string_view rest = source.bytes.substr(SIGNATURE);
    if (rest.size() < CHUNK_HEADER + IHDR + CHECKSUM) source.fail_damaged("it ends in its header");
    if (big_endian(rest, 0) != IHDR || rest.substr(4, 4) != "IHDR")
        source.fail_damaged("it begins with no header");
    const std::string_view header = rest.substr(CHUNK_HEADER, IHDR);
    PngStart start;
    start.size = {big_endian(header, 0), big_endian(header, 4)};
    start.bits = uint8_t(header[8]);
    start.color_type = uint8_t(header[9]);
    while (rest.size() >= CHUNK_HEADER) {
        const size_t size = big_endian(rest, 0);
        const std::string_view type = rest.substr(4, 4);
        if (type == "IDAT" || size + CHUNK_HEADER + CHECKSUM > rest.size()) break;
        if (type == "sRGB") start.srgb = true;
        if (type == "acTL") start.animated = true;
        if (type == "gAMA" && size == GAMA) start.gamma = big_endian(rest, CHUNK_HEADER);
        rest.remove_prefix(CHUNK_HEADER + size + CHECKSUM);
    }
    return start;
}

// Refuses impossible or unwanted sizes before memory is allocated for them.
void check_png_size(const TexelSource& source, const PngStart& start) {
    const uvec2 size = start.size;
    if (size.x < 1 || size.y < 1 || size.x > MAX_IMAGE_SIDE || size.y > MAX_IMAGE_SIDE) {
        source.fail_damaged("its header says " + std::to_string(size.x) + 'x' + std::to_string(size.y) +
                            " pixels");
    }
    check_pixel_count(source.name, size.x, size.y, source.limits.max_pixels);
    constexpr uint64_t MAX_DEFLATED = 1032;  // The most bytes that one byte of a deflate stream can expand
                                             // to.
    constexpr std::array<uint64_t, 7> SAMPLES = {1, 0, 3, 1, 2, 0, 4};  // Samples of a pixel, by its colour
                                                                        // type.
    const uint64_t samples = start.color_type < SAMPLES.size() ? SAMPLES[start.color_type] : 0;
    if (size.x * samples * start.bits / 8 * size.y > MAX_DEFLATED * source.bytes.size())
        source.fail_too_short(size);
}

// The exponent of a gAMA chunk, unless it is that of sRGB.
std::optional<double> png_gamma(const TexelSource& source, const PngStart& start) {
    constexpr double USUAL = 45455;        // 1/2.2.
    constexpr double ROUNDING = 50;        // Rounding of a gamma with three decimals.
    constexpr double MIN = 0.1, MAX = 10;  // Beyond, it is a mistake.
    if (start.srgb || !start.gamma || std::abs(*start.gamma - USUAL) <= ROUNDING) return std::nullopt;
    const double gamma = *start.gamma / double{PNG_FP_1};
    if (gamma >= MIN && gamma <= MAX) return gamma;
    source.warn("its gamma of " + number_text(gamma, 6) + " is implausible, and is ignored");
    return std::nullopt;
}

class PngDecoder {
  public:
    PngDecoder(const TexelSource& source, const PngStart& start)
        : source_(source), start_(start), rest_(source.bytes) {}
    PngDecoder(const PngDecoder&) = delete;
    PngDecoder& operator=(const PngDecoder&) = delete;
    ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

    TexelImage decode() {
        read_header();
        const bool palette = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE;
        TexelImage image = palette ? decode_palette() : decode_samples();
        image.gamma = png_gamma(source_, start_);
        if (start_.animated) source_.warn("it is animated; its default image is used");
        if (warning_[0] != '\0') source_.warn("libpng says: " + std::string(warning_.data()));
        return image;
    }

  private:
    using Message = std::array<char, 160>;

    // Runs `step`, which libpng may leave by longjmp: then throws libpng's message.
    template <class Step>
    void attempt(const Step& step) {
        static_assert(std::is_trivially_destructible_v<Step>);
        if (!completes(step)) source_.fail_damaged(error_.data());
    }
    template <class Step>
    bool completes(const Step& step) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        step();
        return true;
    }

    static PngDecoder& decoder_of(void* pointer) { return *static_cast<PngDecoder*>(pointer); }
    static void copy_message(const char* text, Message& message) {
        std::strncpy(message.data(), text, message.size() - 1);
    }
    [[noreturn]] static void on_error(png_structp png, const char* text) {
        copy_message(text, decoder_of(png_get_error_ptr(png)).error_);
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp png, const char* text) {
        Message& warning = decoder_of(png_get_error_ptr(png)).warning_;
        if (warning[0] == '\0') copy_message(text, warning);  // The first is enough.
    }
    static void on_read(png_structp png, png_bytep out, size_t count) {
        std::string_view& rest = decoder_of(png_get_io_ptr(png)).rest_;
        if (count > rest.size()) png_error(png, "it ends early");
        std::memcpy(out, rest.data(), count);
        rest.remove_prefix(count);
    }

    void read_header();
    void read_rows(uint8_t* rows, size_t row_bytes);
    TexelImage decode_palette();
    TexelImage decode_samples();

    const TexelSource& source_;
    const PngStart& start_;
    std::string_view rest_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    Message error_{};
    Message warning_{};
};

void PngDecoder::read_header() {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) throw std::bad_alloc();
    attempt([this] {
        png_set_read_fn(png_, this, on_read);
        png_set_user_limits(png_, MAX_IMAGE_SIDE, MAX_IMAGE_SIDE);
        png_set_chunk_malloc_max(png_, source_.bytes.size());  // No chunk is longer than the file.
        png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
        // tRNS is the only optional chunk that is used.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_read_info(png_, info_);
    });
}

// Reads all rows, one after the other, and what follows them.
void PngDecoder::read_rows(uint8_t* rows, size_t row_bytes) {
    attempt([&] {
        const int passes = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        assert(png_get_rowbytes(png_, info_) == row_bytes);
        for (int pass = 0; pass < passes; ++pass) {
            for (size_t y = 0; y < start_.size.y; ++y)
                png_read_row(png_, rows + y * row_bytes, nullptr);
        }
        png_read_end(png_, nullptr);
    });
}

// The colours are looked up here. Some versions of libpng warn of indices beyond the palette, but none counts
// them.
TexelImage PngDecoder::decode_palette() {
    png_colorp colors = nullptr;
    png_bytep alphas = nullptr;
    int color_count = 0, alpha_count = 0;
    png_get_PLTE(png_, info_, &colors, &color_count);
    png_get_tRNS(png_, info_, &alphas, &alpha_count, nullptr);
    std::array<std::array<uint8_t, 4>, 256> palette{};
    for (size_t i = 0; i < palette.size(); ++i) {
        palette[i][3] = i < size_t(alpha_count) ? alphas[i] : 255;
        if (i < size_t(color_count)) {
            const png_color& color = colors[i];
            palette[i] = {color.red, color.green, color.blue, palette[i][3]};
        }
    }
    std::vector<uint8_t> indices(size_t{start_.size.x} * start_.size.y);
    attempt([this] {
        png_set_packing(png_);
        png_set_check_for_invalid_index(png_, 0);
    });
    read_rows(indices.data(), start_.size.x);

    TexelImage image = make_texels(start_.size, alpha_count > 0 ? 4 : 3, TexelType::unorm8);
    std::byte* texel = image.texels.data();
    for (const uint8_t index : indices) {
        std::memcpy(texel, palette[index].data(), image.channels);
        texel += image.channels;
    }
    const auto lacking = std::ranges::count_if(indices, [&](uint8_t index) { return index >= color_count; });
    if (lacking > 0) {
        source_.warn(std::to_string(lacking) + " of " + std::to_string(indices.size()) +
                     " texels have colours that its palette lacks, and are black");
    }
    return image;
}

TexelImage PngDecoder::decode_samples() {
    const bool transparent = png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
    const uint32_t channels = png_get_channels(png_, info_) + (transparent ? 1 : 0);
    const TexelType type = start_.bits == 16 ? TexelType::unorm16 : TexelType::unorm8;
    TexelImage image = make_texels(start_.size, channels, type);
    attempt([&] {
        if (start_.bits < 8) png_set_expand_gray_1_2_4_to_8(png_);
        if (transparent) png_set_tRNS_to_alpha(png_);
        if (start_.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
    });
    read_rows(reinterpret_cast<uint8_t*>(image.texels.data()), image.texels.size() / start_.size.y);
    return image;
}

}  // namespace

TexelImage decode_png_texels(const TexelSource& source) {
    const PngStart start = read_png_start(source);
    check_png_size(source, start);
    return PngDecoder(source, start).decode();
}

}  // namespace candela
