// Identity: everything that an image depends on but the samples that it holds, as attributes of the image.
// What has one identity can be continued and joined.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "base/image.h"

namespace candela {

struct Identity {
    // The settings as people read them: size, crop, seed, sampler, estimator, max depth, rr depth and camera.
    static constexpr size_t SETTING_COUNT = 8;
    std::array<std::string, SETTING_COUNT> settings;
    // Of the scene's arrays, the record of camera and settings, and the specialization constants.
    uint64_t hash = 0;
};

// What made an image or a state: on another, the same samples may have other bits.
struct Maker {
    std::string device;
    std::string driver;
    std::string version;  // Of candela.

    bool operator==(const Maker&) const = default;
};

// An attribute of the images of adaptive renderings.
inline constexpr const char* ADAPTIVE_ATTRIBUTE = "candela.adaptive";

// Size and crop as they stand among the settings.
std::string size_text(uvec2 size);
std::string crop_text(const PixelRect& crop);

// Writes the identity as attributes candela.*; size and crop are the image's own.
void set_identity(Image& image, const Identity& identity);

// Reads it back. Throws Error, which says what is missing of `name`, if the image has none.
Identity identity_of(const Image& image, const std::string& name);

// The same for the maker; "GPU, driver 1.2, candela 0.1.0" in messages.
void set_maker(Image& image, const Maker& maker);
Maker maker_of(const Image& image, const std::string& name);
std::string to_text(const Maker& maker);

// In what `theirs` differs from `ours`, e.g. "its seed is 8, not 7"; empty if they are the same.
std::string difference(const Identity& theirs, const Identity& ours);

// The text of an attribute; throws Error, which names the attribute and says that `name` is none of candela's
// renderings, if the image has none.
const std::string& text_attribute(const Image& image, const std::string& attribute, const std::string& name);

// 16 hexadecimal digits.
std::string hexadecimal(uint64_t value);

}  // namespace candela
