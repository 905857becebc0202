// Writes PNG files with libpng. An error of libpng's is a longjmp: it leaves only functions that have nothing
// to destroy.
#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <string>
#include <type_traits>
#include <vector>

#include <png.h>

#include "base/error.h"
#include "base/file.h"
#include "image/image_io_parts.h"

namespace candela {
namespace {

class PngEncoder {
  public:
    PngEncoder(const std::filesystem::path& path, const TexelImage& picture)
        : path_(path), picture_(picture) {}
    PngEncoder(const PngEncoder&) = delete;
    PngEncoder& operator=(const PngEncoder&) = delete;
    ~PngEncoder() { png_destroy_write_struct(&png_, &info_); }

    std::string encode(const PictureNotes& notes) {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr) throw std::bad_alloc();
        std::vector<png_text> texts = texts_of(notes);
        const int count = int(texts.size());
        png_text* const first = texts.data();
        attempt([&] { write(first, count); });
        return std::move(bytes_);
    }

  private:
    // Runs `step`, which libpng may leave by longjmp: then throws libpng's message.
    template <class Step>
    void attempt(const Step& step) {
        static_assert(std::is_trivially_destructible_v<Step>);
        if (completes(step)) return;
        throw Error("cannot write " + quoted(path_) + ": libpng says: " + message_.data() +
                    "; write an EXR file");
    }
    template <class Step>
    bool completes(const Step& step) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        step();
        return true;
    }

    [[noreturn]] static void on_error(png_structp png, const char* text) {
        PngEncoder& encoder = *static_cast<PngEncoder*>(png_get_error_ptr(png));
        std::strncpy(encoder.message_.data(), text, encoder.message_.size() - 1);
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp /*png*/, const char* /*text*/) {}
    static void on_write(png_structp png, png_bytep bytes, size_t count) {
        if (!static_cast<PngEncoder*>(png_get_io_ptr(png))->append(bytes, count))
            png_error(png, "there is not enough memory");
    }
    bool append(png_const_bytep bytes, size_t count) {
        try {
            bytes_.append(reinterpret_cast<const char*>(bytes), count);
            return true;
        } catch (const std::bad_alloc&) {
            return false;
        }
    }

    // ASCII in chunks of tEXt, other texts in chunks of iTXt. They point into `notes`.
    static std::vector<png_text> texts_of(const PictureNotes& notes) {
        std::vector<png_text> texts;
        for (const auto& [name, text] : notes.texts) {
            const bool ascii = std::ranges::all_of(text, [](char c) { return uint8_t(c) < 0x80; });
            png_text chunk{};
            chunk.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
            chunk.key = const_cast<char*>(name.c_str());
            chunk.text = const_cast<char*>(text.c_str());
            chunk.text_length = ascii ? text.size() : 0;
            chunk.itxt_length = ascii ? 0 : text.size();
            texts.push_back(chunk);
        }
        return texts;
    }

    void write(png_text* texts, int text_count) {
        const uvec2 size = picture_.size;
        const bool wide = picture_.type == TexelType::unorm16;
        png_set_write_fn(png_, this, on_write, nullptr);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        const bool grey = picture_.channels == 1;
        const int type = grey                     ? PNG_COLOR_TYPE_GRAY
                         : picture_.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA
                                                  : PNG_COLOR_TYPE_RGB;
        png_set_IHDR(png_, info_, size.x, size.y, wide ? 16 : 8, type, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        if (!grey) png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
        if (text_count > 0) png_set_text(png_, info_, texts, text_count);
        png_write_info(png_, info_);
        if (wide && std::endian::native == std::endian::little) png_set_swap(png_);
        const auto* row = reinterpret_cast<png_const_bytep>(picture_.texels.data());
        const size_t row_bytes = size_t{size.x} * picture_.channels * byte_size(picture_.type);
        for (uint32_t y = 0; y < size.y; ++y, row += row_bytes)
            png_write_row(png_, row);
        png_write_end(png_, info_);
    }

    const std::filesystem::path& path_;
    const TexelImage& picture_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::string bytes_;
    std::array<char, 160> message_{};
};

}  // namespace

std::string encode_png(const std::filesystem::path& path, const TexelImage& picture,
                       const PictureNotes& notes) {
    return PngEncoder(path, picture).encode(notes);
}

}  // namespace candela
