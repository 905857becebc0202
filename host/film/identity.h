// Identity: everything that determines an image except its range of samples, as attributes of the image.
// Renderings with the same identity can be continued and merged.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "image/image.h"

namespace candela {

struct Identity {
    // The settings as text: size, crop, seed, sampler, estimator, light sampler, terminator, max depth, rr
    // depth, filter, clamp, camera and frame.
    static constexpr size_t SETTING_COUNT = 13;
    std::array<std::string, SETTING_COUNT> settings;
    // Hash of the scene's arrays, the record of camera and settings, and the specialization constants.
    uint64_t hash = 0;
};

inline constexpr const char* NO_CLAMP_TEXT = "none";

// The maker of an image or a state. With another maker, the same samples may have other bits.
struct Maker {
    std::string device;
    std::string driver;
    std::string version;  // Version of candela.

    bool operator==(const Maker&) const = default;
};

// An attribute of the images of adaptive renderings.
inline constexpr const char* ADAPTIVE_ATTRIBUTE = "candela.adaptive";

// Size and crop as text for Identity::settings.
std::string size_text(uvec2 size);
std::string crop_text(const PixelRect& crop);

// Writes the identity as attributes candela.*; size and crop are the image's own.
void set_identity(Image& image, const Identity& identity);

// Reads it back. Throws Error that says what `name` lacks if the image has none.
Identity identity_of(const Image& image, const std::string& name);

// The same for the maker. to_text() is for messages: "GPU, driver 1.2, candela 0.1.0".
void set_maker(Image& image, const Maker& maker);
Maker maker_of(const Image& image, const std::string& name);
std::string to_text(const Maker& maker);

// The differences of `theirs` from `ours`, e.g. "its seed is 8, not 7"; empty if they are the same.
std::string difference(const Identity& theirs, const Identity& ours);

// The text of an attribute. If it is missing, throws Error that names the attribute and `name`, and asks for
// a file by candela render.
std::string text_attribute(const Image& image, const std::string& attribute, const std::string& name);

// 16 hexadecimal digits.
std::string hexadecimal(uint64_t value);

}  // namespace candela
