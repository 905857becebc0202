// Arrays that stand for lists of a scene's text: {"array": "name"}. See scene/named_arrays.h.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "load/node.h"
#include "scene/named_arrays.h"
#include "scene/scene.h"

namespace candela {

// Whether a value names an array.
bool is_array_name(const Node& node);

// The rows of the array that a value names, as doubles. All functions throw Error at its place.
class ArrayRows {
  public:
    // `columns`: how many numbers a row may have; `rows`: how many rows there must be, if that is known.
    ArrayRows(const Node& node, const Scene& scene, std::initializer_list<uint64_t> columns,
              std::optional<uint64_t> rows = std::nullopt);

    uint64_t rows() const { return array_->shape.front(); }
    uint64_t columns() const { return columns_; }

    // Calls visit(row, numbers) for each row, in their order; each number is finite, and a float can hold it.
    template <class Visit>
    void for_each(const Visit& visit) const {
        std::vector<double> numbers;
        const uint64_t at_once = std::max<uint64_t>(1, AT_ONCE / columns_);
        for (uint64_t first = 0; first < rows(); first += at_once) {
            const uint64_t count = std::min(at_once, rows() - first);
            read(first, count, numbers);
            for (uint64_t i = 0; i < count; ++i)
                visit(first + i, &numbers[i * columns_]);
        }
    }

    // Throws Error about a row.
    [[noreturn]] void fail(uint64_t row, const std::string& expected, double found) const;

  private:
    static constexpr uint64_t AT_ONCE = uint64_t{1} << 14u;  // Numbers.

    void read(uint64_t first, uint64_t count, std::vector<double>& numbers) const;

    Node node_;
    std::string name_;
    const NamedArrays* arrays_;
    const NamedArray* array_;
    uint64_t columns_ = 1;
};

// The height and width of the map that an array is, of 3 numbers a texel.
std::array<uint64_t, 3> map_shape(const Node& node, const Scene& scene);

// Adds the image that an array is, of height x width texels with one number or up to four each: uint8,
// uint16 or float16. Returns its index in scene.images.
uint32_t add_image_array(const Node& node, Scene& scene);

}  // namespace candela
