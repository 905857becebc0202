// The rows of a PLY file: text and bytes look alike through these classes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "load/ply/ply_header.h"

namespace candela {

// The position of a reader of rows, for messages. Rows are numbered from 0, as the indices in the file are.
struct PlyPosition {
    std::string file;
    uint64_t line = 0;  // 0 in binary files, which have none.
    std::string element;
    uint64_t row = 0;

    // Throws Error `file: element row cause` or `file:line: element row cause`.
    [[noreturn]] void fail(const std::string& cause) const;
    [[noreturn]] void fail_at_end() const;
};

// Rows of text: each is a line of numbers. Empty lines are skipped.
class PlyAsciiRows {
  public:
    // `text` is the rest after the header, `position` has the line of the header's end; both must outlive
    // this.
    PlyAsciiRows(std::string_view text, PlyPosition& position) : text_(text), position_(position) {}

    // Throws Error if no row is left.
    void begin_row();
    // The next number of the row. Throws Error if there is none, or none of this type.
    double next(PlyType type);
    // Throws Error if there are numbers left.
    void end_row();

    size_t bytes_left() const { return text_.size(); }
    // How many bytes follow, apart from empty lines in front of them.
    size_t trailing_bytes();

  private:
    void skip_empty_lines();

    std::string_view text_;
    std::string_view row_;  // What is left of the current row.
    PlyPosition& position_;
};

// As PlyAsciiRows, for rows of binary numbers. A row has no end of its own.
class PlyBinaryRows {
  public:
    PlyBinaryRows(std::string_view bytes, PlyFormat format, PlyPosition& position)
        : bytes_(bytes), position_(position) {
        swap_ = (format == PlyFormat::big_endian) != (std::endian::native == std::endian::big);
    }

    void begin_row() {}
    double next(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return read<int8_t>();
            case PlyType::uint8:
                return read<uint8_t>();
            case PlyType::int16:
                return read<int16_t>();
            case PlyType::uint16:
                return read<uint16_t>();
            case PlyType::int32:
                return read<int32_t>();
            case PlyType::uint32:
                return read<uint32_t>();
            case PlyType::float32:
                return double(read<float>());
            case PlyType::float64:
                break;
        }
        return read<double>();
    }
    void end_row() {}

    size_t bytes_left() const { return bytes_.size(); }
    size_t trailing_bytes() const { return bytes_.size(); }

  private:
    template <class T>
    T read() {
        std::array<char, sizeof(T)> raw;
        if (bytes_.size() < raw.size()) position_.fail_at_end();
        std::copy_n(bytes_.begin(), raw.size(), raw.begin());
        if (swap_) std::reverse(raw.begin(), raw.end());
        bytes_.remove_prefix(raw.size());
        return std::bit_cast<T>(raw);
    }

    std::string_view bytes_;
    PlyPosition& position_;
    bool swap_;
};

}  // namespace candela
