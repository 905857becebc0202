// See shared_arrays.h.
#include "serve/shared_arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/text.h"

namespace candela::serve {
namespace {

constexpr std::array<std::pair<std::string_view, NumberType>, 8> TYPE_NAMES{
    {{"uint8", NumberType::uint8},
     {"uint16", NumberType::uint16},
     {"uint32", NumberType::uint32},
     {"int32", NumberType::int32},
     {"int64", NumberType::int64},
     {"float16", NumberType::float16},
     {"float32", NumberType::float32},
     {"float64", NumberType::float64}}};
// An array with more bytes is no array; products of it with a row's numbers do not overflow.
constexpr uint64_t MOST_BYTES = uint64_t{1} << 46u;

uint64_t read_offset(const Node& node) {
    const double offset = node.number();
    if (!(offset >= 0.0 && offset <= double(MOST_BYTES) && std::trunc(offset) == offset))
        node.fail_expected("a whole number of bytes, at least 0");
    return uint64_t(offset);
}

std::vector<uint64_t> read_shape(const Node& node) {
    constexpr size_t MOST_AXES = 4;
    std::vector<uint64_t> shape;
    for (const Node& side : node.elements())
        shape.push_back(side.integer(0, UINT32_MAX));
    if (shape.empty() || shape.size() > MOST_AXES) node.fail_expected("one to four whole numbers");
    return shape;
}

// The numbers of an array, or more than MOST_BYTES.
uint64_t count_of(const std::vector<uint64_t>& shape) {
    uint64_t count = 1;
    for (const uint64_t side : shape) {
        if (side > 0 && count > MOST_BYTES / side) return std::numeric_limits<uint64_t>::max();
        count *= side;
    }
    return count;
}

}  // namespace

SharedArrays::SharedArrays(const Node& arrays) {
    std::map<std::string, std::shared_ptr<const SharedFile>> files;
    for (const Node& node : arrays.members()) {
        node.allow_only({"file", "offset", "type", "shape"});
        const Node name = node.require("file"), sides = node.require("shape");
        std::shared_ptr<const SharedFile>& file = files[name.file_name()];
        try {
            if (!file) file = std::make_shared<SharedFile>(name.file_name());
        } catch (const Error& error) {
            name.fail(error.what());
        }
        Placed placed{.array = {node.require("type").choice(TYPE_NAMES), read_shape(sides)}, .file = file};
        if (const auto offset = node.find("offset")) placed.offset = read_offset(*offset);
        const uint64_t count = count_of(placed.array.shape);
        const uint64_t room = file->size() - std::min(file->size(), placed.offset);
        if (count > room / byte_size(placed.array.type)) {
            sides.fail(concat("the array needs ", sides.text(), " numbers, and its file has ", room,
                              " bytes from the offset ", placed.offset,
                              " on; write all of it before it is named"));
        }
        arrays_.emplace(node.key(), std::move(placed));
    }
}

uint64_t SharedArrays::needed() const {
    uint64_t bytes = 0;
    for (const auto& [name, placed] : arrays_)
        bytes +=
            count_of(placed.array.shape) * std::min<uint64_t>(byte_size(placed.array.type), sizeof(float));
    return bytes;
}

std::vector<std::string> SharedArrays::names() const {
    std::vector<std::string> names;
    for (const auto& [name, placed] : arrays_)
        names.push_back(name);
    return names;
}

const NamedArray* SharedArrays::find(const std::string& name) const {
    const auto found = arrays_.find(name);
    return found == arrays_.end() ? nullptr : &found->second.array;
}

void SharedArrays::read(const std::string& name, uint64_t offset, std::span<std::byte> bytes) const {
    const Placed& placed = arrays_.at(name);
    placed.file->read(placed.offset + offset, bytes);
}

}  // namespace candela::serve
