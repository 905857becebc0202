// Ref: Khronos, "glTF 2.0 Specification", section 3.6.2.
#include "load/gltf/accessor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "base/text.h"
#include "load/quote.h"

namespace candela::gltf {
namespace {

constexpr std::array<std::pair<std::string_view, uint32_t>, 5> WIDTHS{
    {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}}};

// Calls visit(T()) with the C++ type of a component.
template <class Visit>
auto with_type(Component component, const Visit& visit) {
    if (component == Component::int8) return visit(int8_t());
    if (component == Component::uint8) return visit(uint8_t());
    if (component == Component::int16) return visit(int16_t());
    if (component == Component::uint16) return visit(uint16_t());
    if (component == Component::uint32) return visit(uint32_t());
    return visit(float());
}

size_t size_of_component(Component component) {
    return with_type(component, [](auto zero) { return sizeof zero; });
}

bool is_unsigned(Component component) {
    return component == Component::uint8 || component == Component::uint16 || component == Component::uint32;
}

Component read_component(const Node& node) {
    const uint32_t type = node.integer(0, UINT32_MAX);
    constexpr uint32_t NO_INT32 = 5124;
    if (type < uint32_t(Component::int8) || type > uint32_t(Component::float32) || type == NO_INT32)
        node.fail_expected("5120, 5121, 5122, 5123, 5125 or 5126");
    return Component(type);
}

uint32_t read_width(const Node& node, std::initializer_list<std::string_view> types) {
    const std::string& type = node.string();
    const auto width =
        std::ranges::find(WIDTHS, std::string_view(type), [](const auto& w) { return w.first; });
    if (width == WIDTHS.end() || std::ranges::find(types, type) == types.end()) {
        std::string expected;
        for (const std::string_view known : types)
            expected += (expected.empty() ? "" : " or ") + quote(known);
        node.fail_expected(expected + " for what it is used");
    }
    return width->second;
}

// The bytes of `count` elements of that size from byteOffset on, checked. `stride` gets the distance between
// two of them.
std::span<const std::byte> element_bytes(File& file, const Node& node, uint64_t count, size_t size,
                                         size_t& stride) {
    const Node view = file.resolve("bufferViews", node.require("bufferView"));
    const std::span<const std::byte> bytes = file.view_bytes(view);
    stride = size;
    if (const auto value = view.find("byteStride")) {
        stride = value->integer(0, UINT32_MAX);
        if (stride == 0) {
            file.warn(*value, "a stride of 0 is read as none: elements follow each other");
            stride = size;
        }
        if (stride < size) value->fail_expected(concat("at least ", size, ", the size of an element"));
    }
    const auto value = node.find("byteOffset");
    const uint64_t offset = value ? value->integer(0, UINT32_MAX) : 0;
    const uint64_t end =
        offset + (count - 1) * stride + size;  // Below 2^64, as count and stride are below 2^32.
    if (end > bytes.size()) {
        node.fail(concat(count, " elements end at byte ", end, " of their view, which has ", bytes.size(),
                         "; is the file damaged?"));
    }
    return bytes.subspan(offset);
}

template <class T>
float as_float(T value, bool normalized) {
    if constexpr (std::is_floating_point_v<T>) {
        return value;
    } else {
        if (!normalized) return float(value);
        // Ref: section 3.6.2.2; the most negative value, which has no positive counterpart, is -1.
        return std::max(float(double(value) / double(std::numeric_limits<T>::max())), -1.0f);
    }
}

template <class T>
void copy_element(const std::byte* bytes, uint32_t width, bool normalized, float* target) {
    for (uint32_t c = 0; c < width; ++c) {
        T value;
        std::memcpy(&value, bytes + c * sizeof(T), sizeof(T));
        target[c] = as_float(value, normalized);
    }
}

}  // namespace

size_t AccessorType::element_size() const {
    return width * size_of_component(component);
}

AccessorType read_accessor_type(File& file, const Node& node, std::initializer_list<std::string_view> types) {
    AccessorType type;
    type.component = read_component(node.require("componentType"));
    type.width = read_width(node.require("type"), types);
    type.count = node.require("count").integer(1, UINT32_MAX);
    if (const auto normalized = node.find("normalized")) type.is_normalized = normalized->boolean();
    if (type.is_normalized && (type.component == Component::float32 || type.component == Component::uint32)) {
        file.warn(node, "\"normalized\" does not apply to floats or 32-bit integers, and is ignored");
        type.is_normalized = false;
    }
    return type;
}

Accessor::Accessor(File& file, const Node& reference, std::initializer_list<std::string_view> types)
    : node_(file.resolve("accessors", reference)), type_(read_accessor_type(file, node_, types)) {
    if (node_.find("bufferView")) {
        bytes_ = element_bytes(file, node_, type_.count, type_.element_size(), stride_);
    } else if (type_.count > file.bytes_read()) {
        // Zeros take no bytes in the file, but they do take memory. An attribute cannot have more elements
        // than the data it accompanies.
        node_.require("count").fail(
            concat("an accessor without a bufferView is all zeros, and may not have more elements than the ",
                   file.bytes_read(), " bytes that were read; name the view of its bytes"));
    }
    read_sparse(file);
}

Accessor::Accessor(File& file, const Node& reference, std::initializer_list<std::string_view> types,
                   std::span<const std::byte> elements)
    : node_(file.resolve("accessors", reference)),
      type_(read_accessor_type(file, node_, types)),
      bytes_(elements),
      stride_(type_.element_size()) {
    type_.count = uint32_t(elements.size() / stride_);
    read_sparse(file);
}

void Accessor::read_sparse(File& file) {
    const auto found = node_.find("sparse");
    if (!found) return;
    const Node& sparse = *found;
    const uint32_t replaced = sparse.require("count").integer(1, count());
    const Node indices = sparse.require("indices");
    const Node type_node = indices.require("componentType");
    const Component type = read_component(type_node);
    if (!is_unsigned(type)) type_node.fail_expected("5121, 5123 or 5125");
    size_t stride = 0;
    const auto index_bytes = element_bytes(file, indices, replaced, size_of_component(type), stride);
    sparse_.emplace();
    sparse_->indices.reserve(replaced);
    for (uint32_t i = 0; i < replaced; ++i) {
        const double index = with_type(type, [&](auto zero) {
            auto value = zero;
            std::memcpy(&value, index_bytes.data() + i * stride, sizeof value);
            return double(value);
        });
        if (!(index >= 0.0 && index < double(count()))) {
            indices.fail(concat("number ", i, " replaces an element beyond the accessor's ", count(),
                                "; is the file damaged?"));
        }
        sparse_->indices.push_back(uint32_t(index));
    }
    sparse_->values =
        element_bytes(file, sparse.require("values"), replaced, type_.element_size(), sparse_->stride);
}

std::vector<float> Accessor::floats() const {
    std::vector<float> result(size_t(count()) * width(), 0.0f);
    with_type(component(), [&](auto zero) {
        using T = decltype(zero);
        for (size_t i = 0; !bytes_.empty() && i < count(); ++i)
            copy_element<T>(bytes_.data() + i * stride_, width(), is_normalized(), &result[i * width()]);
        if (!sparse_) return;
        for (size_t i = 0; i < sparse_->indices.size(); ++i) {
            copy_element<T>(sparse_->values.data() + i * sparse_->stride, width(), is_normalized(),
                            &result[size_t(sparse_->indices[i]) * width()]);
        }
    });
    return result;
}

std::vector<float> Accessor::floats(std::span<const uint32_t> rows) const {
    std::vector<float> result(rows.size() * width(), 0.0f);
    if (sparse_) {
        const std::vector<float> all = floats();
        for (size_t i = 0; i < rows.size(); ++i)
            std::copy_n(&all[size_t(rows[i]) * width()], width(), &result[i * width()]);
        return result;
    }
    if (bytes_.empty()) return result;
    with_type(component(), [&](auto zero) {
        for (size_t i = 0; i < rows.size(); ++i) {
            copy_element<decltype(zero)>(bytes_.data() + rows[i] * stride_, width(), is_normalized(),
                                         &result[i * width()]);
        }
    });
    return result;
}

const std::vector<float>& Accessor::kept_floats(File& file) const {
    return file.contents().keep("floats of " + node_.place(), [&] { return floats(); });
}

std::vector<uint32_t> Accessor::integers() const {
    if (!is_unsigned(component()) || is_normalized()) {
        node_.require("componentType").fail("unsigned integers are expected here; export the file again");
    }
    std::vector<uint32_t> result(size_t(count()) * width(), 0);
    with_type(component(), [&](auto zero) {
        using T = decltype(zero);
        const auto copy = [&](const std::byte* bytes, size_t element) {
            for (uint32_t c = 0; c < width(); ++c) {
                T value;
                std::memcpy(&value, bytes + c * sizeof(T), sizeof(T));
                result[element * width() + c] = uint32_t(double(value));
            }
        };
        for (size_t i = 0; !bytes_.empty() && i < count(); ++i)
            copy(bytes_.data() + i * stride_, i);
        if (!sparse_) return;
        for (size_t i = 0; i < sparse_->indices.size(); ++i)
            copy(sparse_->values.data() + i * sparse_->stride, sparse_->indices[i]);
    });
    return result;
}

}  // namespace candela::gltf
