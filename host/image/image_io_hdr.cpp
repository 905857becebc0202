// Reads Radiance pictures (.hdr, .pic), by their specification: stb_image knows neither the older run-length
// encoding nor the exposure, and reads zeros where a truncated file ends.
#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/memory_limit.h"
#include "base/parse_float.h"
#include "image/image_io.h"
#include "image/image_io_parts.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

using Rgbe = std::array<uint8_t, 4>;  // Three mantissas and the exponent that they share.

class HdrReader {
  public:
    HdrReader(std::string_view bytes, const fs::path& name) : bytes_(bytes), path_(name) {}

    Image read(const ImageLimits& limits) {
        read_header();
        const Order order = read_order();
        const uvec2 size = order.size();
        check_pixel_count(path_, size.x, size.y, limits.max_pixels);
        Image image;
        image.full = size;
        image.data = {0, 0, size.x, size.y};
        image.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
        check_bytes(size);
        for (Channel& channel : image.channels)
            channel.values.reserve(image.pixel_count());
        std::vector<Rgbe> row(order.length);
        for (row_ = 1; row_ <= order.rows; ++row_) {
            read_row(row);
            append(row, image);
        }
        if (!order.is_usual()) {
            for (Channel& channel : image.channels)
                channel.values = order.sorted(channel.values);
        }
        return image;
    }

  private:
    // The order of rows, and of pixels in them; a row may also be a column of the picture.
    struct Order {
        size_t rows, length;                // As the file has them.
        bool columns, rightwards, upwards;  // Along the rows or across them.

        uvec2 size() const { return columns ? uvec2(rows, length) : uvec2(length, rows); }
        bool is_usual() const { return !columns && rightwards && !upwards; }

        // The values from the top left, row by row of the picture.
        std::vector<float> sorted(const std::vector<float>& values) const {
            const uvec2 extent = size();
            std::vector<float> result(values.size());
            for (size_t y = 0, i = 0; y < extent.y; ++y) {
                for (size_t x = 0; x < extent.x; ++x, ++i) {
                    const size_t from_left = rightwards ? x : extent.x - 1 - x;
                    const size_t from_top = upwards ? extent.y - 1 - y : y;
                    result[i] =
                        values[columns ? from_left * length + from_top : from_top * length + from_left];
                }
            }
            return result;
        }
    };

    [[noreturn]] void fail(const std::string& reason) const {
        throw Error("cannot read " + quoted(path_) + ": " + reason);
    }
    [[noreturn]] void fail_damaged(const std::string& what) const {
        fail("the file is damaged or incomplete (" + what + "); write it again");
    }
    std::string row_name() const { return "row " + std::to_string(row_); }

    uint8_t byte() {
        if (at_ == bytes_.size()) fail_damaged("it ends in " + row_name());
        return uint8_t(bytes_[at_++]);
    }

    std::string_view line() {
        const size_t end = bytes_.find('\n', at_);
        if (end == std::string_view::npos) fail_damaged("it ends in its header");
        std::string_view text = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        if (text.ends_with('\r')) text.remove_suffix(1);  // From programs for Windows.
        return text;
    }

    static std::string_view without_blanks_at_end(std::string_view text) {
        return text.substr(0, text.find_last_not_of(" \t") + 1);
    }

    // Lines of the form NAME=VALUE and others, which are comments, up to an empty one. A line that begins
    // with a blank is about another file, from which this one was made.
    void read_header() {
        if (!bytes_.starts_with(HDR_MAGIC)) fail("it is not a Radiance picture; give an .hdr image");
        for (std::string_view text = line(); !text.empty(); text = line()) {
            const size_t equals = text.find('=');
            if (equals == std::string_view::npos) continue;
            const std::string_view name = without_blanks_at_end(text.substr(0, equals));
            std::string_view value = without_blanks_at_end(text.substr(equals + 1));
            value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
            if (name == "FORMAT" && value != "32-bit_rle_rgbe") {
                fail("its format is \"" + std::string(value) + R"("; convert it to "32-bit_rle_rgbe")");
            } else if (name == "EXPOSURE") {
                divisor_ *= read_factors<1>(text, value)[0];
            } else if (name == "COLORCORR") {
                const auto factors = read_factors<3>(text, value);
                divisor_ *= vec3(factors[0], factors[1], factors[2]);
            }
        }
        for (int c = 0; c < 3; ++c) {
            if (!std::isnormal(divisor_[c])) fail_damaged("its exposures multiply to no usable number");
        }
    }

    template <size_t COUNT>
    std::array<float, COUNT> read_factors(std::string_view text, std::string_view value) const {
        std::array<float, COUNT> factors{};
        const char* at = value.data();
        const char* const end = at + value.size();
        for (float& factor : factors) {
            while (at != end && *at == ' ')
                ++at;
            const auto [rest, error] = parse_float(at, end, factor);
            if (error != std::errc() || !std::isfinite(factor) || factor <= 0.0f) {
                fail_damaged("its header line \"" + std::string(text) + "\" needs numbers above 0");
            }
            at = rest;
        }
        return factors;
    }

    // Reads the line that says how many rows of how many pixels follow, such as "-Y 480 +X 640": rows along
    // x, against y, which points upwards.
    Order read_order() {
        const std::string text(line());
        std::istringstream stream(text);
        std::string across;
        std::string along;
        int64_t rows = 0;
        int64_t length = 0;
        stream >> across >> rows >> along >> length;
        const auto is_axis = [](const std::string& name, char axis) {
            return name == std::string{'-', axis} || name == std::string{'+', axis};
        };
        const bool columns = is_axis(across, 'X') && is_axis(along, 'Y');
        if (stream.fail() || !(columns || (is_axis(across, 'Y') && is_axis(along, 'X'))) || rows < 1 ||
            rows > MAX_IMAGE_SIDE || length < 1 || length > MAX_IMAGE_SIDE) {
            fail_damaged('"' + text + "\" is not a size");
        }
        return {size_t(rows), size_t(length), columns, (columns ? across : along) == "+X",
                (columns ? along : across) == "+Y"};
    }

    // In the older encoding, sixteen bytes can encode a row of any length. No real picture does so: throws
    // Error if the file claims far more pixels than the newer encoding, at 16 per byte at most, could hold.
    void check_bytes(uvec2 size) const {
        constexpr uint64_t PIXELS_PER_BYTE = 64, SLACK = uint64_t{1} << 20;
        if (uint64_t{size.x} * size.y > PIXELS_PER_BYTE * bytes_.size() + SLACK) {
            fail("its " + std::to_string(size.x) + 'x' + std::to_string(size.y) + " pixels are more than " +
                 std::to_string(bytes_.size()) + " bytes can plausibly hold; make the image smaller");
        }
    }

    // Each row has an encoding of its own. Two bytes of 2 and then the width announce the newer one, and
    // cannot be a pixel of the older one, whose greatest mantissa would be at least 128.
    void read_row(std::vector<Rgbe>& row) {
        constexpr size_t MIN_ENCODED = 8;  // Pixels; shorter and longer rows always have the older encoding.
        constexpr size_t MAX_ENCODED = 0x7fff;
        const bool may_be_encoded = row.size() >= MIN_ENCODED && row.size() <= MAX_ENCODED;
        const Rgbe start = {byte(), byte(), byte(), byte()};
        if (!may_be_encoded || start[0] != 2 || start[1] != 2 || start[2] > 127) {
            read_pixel_runs(start, row);
            return;
        }
        if (size_t(start[2]) * 256 + start[3] != row.size()) fail_damaged(row_name() + " has another width");
        for (size_t component = 0; component < 4; ++component)
            read_byte_runs(component, row);
    }

    // The newer encoding of one component: n > 128 and a byte that occurs n - 128 times, or n <= 128 and n
    // bytes as they are.
    void read_byte_runs(size_t component, std::vector<Rgbe>& row) {
        for (size_t x = 0; x < row.size();) {
            const size_t code = byte();
            const bool repeated = code > 128;
            const size_t count = repeated ? code - 128 : code;
            if (count == 0 || count > row.size() - x) fail_run();
            const uint8_t first = byte();
            row[x++][component] = first;
            for (size_t i = 1; i < count; ++i)
                row[x++][component] = repeated ? first : byte();
        }
    }

    // The older encoding: pixels as they are, among which (1, 1, 1, n) repeats the one before n times; if
    // several of these follow each other, their n are the digits of one number to the base 256, the lowest
    // first. A flat file is one without any.
    void read_pixel_runs(Rgbe pixel, std::vector<Rgbe>& row) {
        size_t digit = 1;
        for (size_t x = 0;;) {
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
                const size_t count = pixel[3] * digit;
                if (x == 0 || digit > MAX_IMAGE_SIDE || count > row.size() - x) fail_run();
                std::fill_n(row.begin() + std::ptrdiff_t(x), count, row[x - 1]);
                x += count;
                digit *= 256;
            } else {
                row[x++] = pixel;
                digit = 1;
            }
            if (x == row.size()) return;
            pixel = {byte(), byte(), byte(), byte()};
        }
    }

    [[noreturn]] void fail_run() const { fail_damaged("a run of pixels exceeds " + row_name()); }

    void append(const std::vector<Rgbe>& row, Image& image) const {
        for (size_t c = 0; c < 3; ++c) {
            std::vector<float>& values = image.channels[c].values;
            for (const Rgbe& pixel : row)
                values.push_back(float(pixel[c]) * SCALES[pixel[3]] / divisor_[int(c)]);
        }
    }

    // The unit of a mantissa, by the exponent; 0 is black, regardless of the mantissas.
    static inline const std::array<float, 256> SCALES = [] {
        constexpr int BIAS = 128 + 8;  // Of the exponent; mantissas are in units of 1/256.
        std::array<float, 256> scales{};
        for (int exponent = 1; exponent < 256; ++exponent)
            scales[size_t(exponent)] = std::ldexp(1.0f, exponent - BIAS);
        return scales;
    }();

    std::string_view bytes_;
    const fs::path& path_;
    size_t at_ = 0;   // In bytes_.
    size_t row_ = 0;  // Being read, from 1; 0: the header.
    vec3 divisor_{1};
};

}  // namespace

Image decode_hdr(std::string_view bytes, const fs::path& name, const ImageLimits& limits) {
    const uint64_t before = memory_in_use();
    try {
        return HdrReader(bytes, name).read(limits);
    } catch (const std::bad_alloc& error) {
        throw Error("cannot read " + quoted(name) + ": there is not enough memory for its pixels" +
                        shortage_text(error, before) + "; use a smaller image or a larger machine",
                    ErrorKind::out_of_memory);
    }
}

Image read_hdr(const fs::path& path, const ImageLimits& limits) {
    return decode_hdr(read_file(path), path, limits);
}

}  // namespace candela
