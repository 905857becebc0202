// Images in memory: planes of 32-bit floats, one per channel, and the EXR attributes that travel with them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/math.h"

namespace candela {

// A rectangle of pixels, x1 and y1 exclusive; origin top left, y downwards.
struct PixelRect {
    uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    uint32_t width() const { return x1 - x0; }
    uint32_t height() const { return y1 - y0; }
    bool operator==(const PixelRect&) const = default;
};

// One plane; row-major, top row first, width * height values. Names follow EXR: "R", "Albedo.G", "Z".
struct Channel {
    std::string name;
    std::vector<float> values;
    bool half = false;  // Stored as 16-bit float in a file (65 504 at most).
};

// The fraction of camera rays that hit something, beside another A.
inline constexpr const char* FIRST_HIT_ALPHA = "FirstHit.A";

// The values of three channels, in the order red, green, blue; valid as long as the channels are.
using RgbPlanes = std::array<std::span<const float>, 3>;

using Attribute = std::variant<std::string, float, mat4>;

// A set of channels over `data`, a part of the whole picture of size `full` (equal unless the image is a
// crop).
struct Image {
    uvec2 full{0, 0};
    PixelRect data;
    std::vector<Channel> channels;
    std::map<std::string, Attribute> attributes;

    size_t pixel_count() const { return size_t(data.width()) * data.height(); }
    // The channel of that exact name, or null.
    const Channel* find(std::string_view name) const;
    // The channels R, G and B of a layer ("" or, say, "Variance"), or nothing if one of the three is missing.
    std::optional<RgbPlanes> find_rgb(std::string_view layer = "") const;
    // Appends a channel of pixel_count() values, all `value`, and returns it (valid until the next add).
    // The name must be new.
    Channel& add(std::string name, float value = 0.0f);
};

}  // namespace candela
