// Copies between the host and a device. Each waits until it is done.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/image.h"

namespace candela::vk {

// Copies `bytes` to the buffer from `offset` [bytes] on. They must fit.
void upload(const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset = 0);
// Copies from the buffer, from `offset` [bytes] on, into all of `bytes`. They must fit.
void download(const Buffer& buffer, std::span<std::byte> bytes, uint64_t offset = 0);

// Makes an image of width * height pixels and `layers` layers, each at least 1, filled with zeros. `name` is
// for messages. If the device allows too little, throws an Error with the image's name, its needs and the
// limit.
StorageImage make_storage_image(const Device& device, uint32_t width, uint32_t height, uint32_t layers,
                                const std::string& name);

// Sets all layers to zero.
void clear(const StorageImage& image);

// Host arrays hold whole layers in the order layer, row (top first), column, channel; so layers * height *
// width * 4 floats.
//
// Replaces layers from `first_layer` on by `values`, which must be a whole number of layers that exist.
void upload(const StorageImage& image, uint32_t first_layer, std::span<const float> values);
// Returns `layer_count` layers from `first_layer` on; they must exist.
std::vector<float> download(const StorageImage& image, uint32_t first_layer, uint32_t layer_count);

// The most bytes that are copied between host and device at a time, so that large data needs little extra
// memory.
inline constexpr uint64_t STAGING_BYTES = uint64_t{64} << 20;

}  // namespace candela::vk
