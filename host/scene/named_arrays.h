// Arrays of numbers that a scene's text refers to by name, in place of lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace candela {

enum class NumberType { uint8, uint16, uint32, int32, int64, float16, float32, float64 };

// The bytes of a number.
constexpr size_t byte_size(NumberType type) {
    switch (type) {
        case NumberType::uint8:
            return 1;
        case NumberType::uint16:
        case NumberType::float16:
            return 2;
        case NumberType::uint32:
        case NumberType::int32:
        case NumberType::float32:
            return 4;
        case NumberType::int64:
        case NumberType::float64:
            break;
    }
    return 8;
}

// Row-major, in the machine's byte order.
struct NamedArray {
    NumberType type = NumberType::float32;
    std::vector<uint64_t> shape{};  // The numbers of rows, columns and so on.
};

// What somebody holds for a scene while it is loaded. Any number of threads may read.
class NamedArrays {
  public:
    NamedArrays() = default;
    NamedArrays(const NamedArrays&) = delete;
    NamedArrays& operator=(const NamedArrays&) = delete;
    virtual ~NamedArrays() = default;

    virtual std::vector<std::string> names() const = 0;
    // The array of that name, or null.
    virtual const NamedArray* find(const std::string& name) const = 0;
    // Copies bytes of an array of that name, from `offset` on. Throws Error if they are not there any more.
    virtual void read(const std::string& name, uint64_t offset, std::span<std::byte> bytes) const = 0;
};

}  // namespace candela
