// Accessors: typed arrays in the buffers of a glTF file. All that they state is checked before any byte is
// read. Messages give places but not values: buffers may be in other files, whose contents the reader of the
// messages may not be allowed to see.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

enum class Component : uint32_t { int8 = 5120, uint8, int16, uint16, uint32 = 5125, float32 };

// The part of an accessor whose elements replace others.
struct Sparse {
    std::vector<uint32_t> indices;  // Below the count of the whole; if two are equal, the last is used.
    std::span<const std::byte> values;
    size_t stride = 0;  // From one element to the next [bytes].
};

// What an accessor states of its elements.
struct AccessorType {
    Component component = Component::float32;
    uint32_t width = 1;  // Numbers per element.
    bool is_normalized = false;
    uint32_t count = 0;

    size_t element_size() const;  // [bytes]
};

// Reads that of the accessor `node`. Throws Error unless it has one of these types ("SCALAR", "VEC3" ...).
AccessorType read_accessor_type(File& file, const Node& node, std::initializer_list<std::string_view> types);

class Accessor {
  public:
    // Reads the accessor that `reference` refers to. Throws Error unless it has one of these types, and its
    // bytes are there.
    Accessor(File& file, const Node& reference, std::initializer_list<std::string_view> types);
    // The same, but its elements are these bytes, one after the other, however many it states. They must
    // outlive it.
    Accessor(File& file, const Node& reference, std::initializer_list<std::string_view> types,
             std::span<const std::byte> elements);

    const Node& node() const { return node_; }
    uint32_t count() const { return type_.count; }
    // Numbers per element.
    uint32_t width() const { return type_.width; }
    Component component() const { return type_.component; }
    bool is_normalized() const { return type_.is_normalized; }

    // All elements, one after the other, as floats: integers as they are, or normalised to [0, 1] or [-1, 1].
    std::vector<float> floats() const;
    // The same for some elements alone; each of `rows` is below count().
    std::vector<float> floats(std::span<const uint32_t> rows) const;
    // floats() of all elements, kept with the file's contents so that later readings can share them.
    const std::vector<float>& kept_floats(File& file) const;
    // Elements as whole numbers. Throws Error unless they are unsigned integers that are not normalised.
    std::vector<uint32_t> integers() const;

  private:
    void read_sparse(File& file);

    Node node_;
    AccessorType type_;
    std::span<const std::byte> bytes_;  // Begins at the first element; empty: all elements are zero.
    size_t stride_ = 0;
    std::optional<Sparse> sparse_;
};

}  // namespace candela::gltf
