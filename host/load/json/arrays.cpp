// See arrays.h.
#include "load/json/arrays.h"

#include <cmath>
#include <cstring>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/limits.h"
#include "base/text.h"
#include "load/quote.h"
#include "scene/images.h"

namespace candela {
namespace {

std::string text_of(const std::vector<uint64_t>& shape) {
    std::string text;
    for (const uint64_t side : shape)
        text += (text.empty() ? "" : ", ") + std::to_string(side);
    return '[' + text + ']';
}

// The array that a value names. Throws Error if there is none.
std::pair<std::string, const NamedArray*> find_array(const Node& node, const Scene& scene) {
    node.allow_only({"array"});
    const Node name = node.require("array");
    if (scene.arrays == nullptr) {
        name.fail(
            "arrays come with a request to candela serve, and there is none here; write a list, or name "
            "a file");
    }
    const NamedArray* const array = scene.arrays->find(name.string());
    if (array == nullptr) name.fail_unknown("array", name.string(), scene.arrays->names());
    return {name.string(), array};
}

template <class Number>
void convert(const std::vector<std::byte>& bytes, std::vector<double>& numbers) {
    for (size_t i = 0; i < numbers.size(); ++i) {
        Number number;
        std::memcpy(&number, &bytes[i * sizeof number], sizeof number);
        numbers[i] = double(number);
    }
}

void convert(NumberType type, const std::vector<std::byte>& bytes, std::vector<double>& numbers) {
    switch (type) {
        case NumberType::uint8:
            return convert<uint8_t>(bytes, numbers);
        case NumberType::uint16:
            return convert<uint16_t>(bytes, numbers);
        case NumberType::uint32:
            return convert<uint32_t>(bytes, numbers);
        case NumberType::int32:
            return convert<int32_t>(bytes, numbers);
        case NumberType::int64:
            return convert<int64_t>(bytes, numbers);
        case NumberType::float32:
            return convert<float>(bytes, numbers);
        case NumberType::float64:
            return convert<double>(bytes, numbers);
        case NumberType::float16:
            break;  // Only of images.
    }
}

std::optional<TexelType> texel_type(NumberType type) {
    switch (type) {
        case NumberType::uint8:
            return TexelType::unorm8;
        case NumberType::uint16:
            return TexelType::unorm16;
        case NumberType::float16:
            return TexelType::half;
        default:
            return std::nullopt;
    }
}

// Throws Error if one of these halves is negative or not finite.
void check_halves(const std::string& name, const std::vector<std::byte>& texels) {
    constexpr uint16_t SIGN = 0x8000, INFINITE = 0x7C00;
    for (size_t i = 0; i < texels.size(); i += sizeof(uint16_t)) {
        uint16_t half = 0;
        std::memcpy(&half, &texels[i], sizeof half);
        if (half < INFINITE || half == SIGN) continue;
        throw Error(concat("the array ", quote(name), " has a number that is negative or not finite, at ",
                           i / sizeof half, "; clip it to 0 .. 65504"));
    }
}

}  // namespace

bool is_array_name(const Node& node) {
    return node.is_object() && node.find("array");
}

ArrayRows::ArrayRows(const Node& node, const Scene& scene, std::initializer_list<uint64_t> columns,
                     std::optional<uint64_t> rows)
    : node_(node), arrays_(scene.arrays) {
    std::tie(name_, array_) = find_array(node, scene);
    std::string wanted;
    for (const uint64_t count : columns)
        wanted += (wanted.empty() ? "" : " or ") + std::to_string(count);
    const std::vector<uint64_t>& shape = array_->shape;
    const auto refuse = [&](const std::string& what) {
        node.fail(concat("the array ", quote(name_), ": expected ", what, ", found ", text_of(shape)));
    };
    if (shape.size() < 2) refuse(concat("rows of ", wanted, " numbers"));
    for (size_t i = 1; i < shape.size(); ++i)
        columns_ *= shape[i];
    if (std::ranges::find(columns, columns_) == columns.end()) refuse(concat("rows of ", wanted, " numbers"));
    if (rows && shape.front() != *rows) refuse(concat(*rows, " rows, one for each position"));
    if (array_->type == NumberType::float16)
        node.fail(concat("the array ", quote(name_),
                         " is of the type float16, which only images may be; use float32"));
}

void ArrayRows::read(uint64_t first, uint64_t count, std::vector<double>& numbers) const {
    const uint64_t row = columns_ * byte_size(array_->type);
    std::vector<std::byte> bytes(count * row);
    try {
        arrays_->read(name_, first * row, bytes);
    } catch (const Error& error) {
        throw Error(node_.place() + ": " + error.what(), error.kind());
    }
    numbers.resize(count * columns_);
    convert(array_->type, bytes, numbers);
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (!(std::abs(numbers[i]) <= double(FLOAT_MAX)))
            fail(first + i / columns_, "finite numbers that 32-bit floats can hold", numbers[i]);
    }
}

void ArrayRows::fail(uint64_t row, const std::string& expected, double found) const {
    node_.fail(concat("the array ", quote(name_), ": expected ", expected, ", found ", found, " in row ", row,
                      ", counted from 0"));
}

std::array<uint64_t, 3> map_shape(const Node& node, const Scene& scene) {
    constexpr uint64_t MOST_TEXELS = uint64_t{1} << 26u;
    const auto [name, array] = find_array(node, scene);
    const std::vector<uint64_t>& shape = array->shape;
    if (shape.size() != 3 || shape[0] == 0 || shape[1] == 0 || shape[2] != 3 ||
        shape[0] > MOST_TEXELS / shape[1]) {
        node.fail(concat("the array ", quote(name),
                         ": expected a map of height x width x 3 numbers, with at most ", MOST_TEXELS,
                         " texels, found ", text_of(shape)));
    }
    return {shape[0], shape[1], shape[2]};
}

uint32_t add_image_array(const Node& node, Scene& scene) {
    const auto [name, array] = find_array(node, scene);
    const std::vector<uint64_t>& shape = array->shape;
    const std::optional<TexelType> type = texel_type(array->type);
    if (!type)
        node.fail(concat("the array ", quote(name), ": an image is of the type uint8, uint16 or float16"));
    const uint64_t channels = shape.size() == 3 ? shape[2] : 1;
    if ((shape.size() != 2 && shape.size() != 3) || channels == 0 || channels > 4 || shape[0] == 0 ||
        shape[1] == 0 || shape[0] > MAX_PICTURE_SIZE || shape[1] > MAX_PICTURE_SIZE) {
        node.fail(concat("the array ", quote(name),
                         ": expected an image of height x width pixels, from 1 to ", MAX_PICTURE_SIZE,
                         " each, or height x width x 1 .. 4, found ", text_of(shape)));
    }
    const TexelImage empty{.size = uvec2(uint32_t(shape[1]), uint32_t(shape[0])),
                           .channels = uint32_t(channels),
                           .type = *type,
                           .texels = {},
                           .gamma = {}};
    const auto make = [id = name, empty, arrays = scene.arrays] {
        TexelImage image = empty;
        image.texels.resize(size_t{image.size.x} * image.size.y * image.channels * byte_size(image.type));
        arrays->read(id, 0, image.texels);
        if (image.type == TexelType::half) check_halves(id, image.texels);
        return image;
    };
    return add_image_file(
        scene,
        {.path = name, .real_path = "array " + name, .make = make, .place = node.place(), .image = {}});
}

}  // namespace candela
