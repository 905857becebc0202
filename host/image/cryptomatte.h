// The hashes of Cryptomatte 1.2. Ref: Friedman, Jones, "Cryptomatte Specification" 1.2.0 (2018).
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/murmur_hash.h"

namespace candela {

// The layers of a picture, each with ranks of what its pixels show.
inline constexpr const char* CRYPTO_OBJECT = "CryptoObject";
inline constexpr const char* CRYPTO_MATERIAL = "CryptoMaterial";
inline constexpr uint32_t CRYPTO_RANKS = 6;  // Two to a layer of four channels.

// The id of a name: its hash, except that a bit of the exponent changes where the float with these bits would
// be 0, denormal, infinite or NaN. Never 0.
inline uint32_t crypto_id(std::string_view name) {
    const uint32_t hash = murmur3_32(name);
    const uint32_t exponent = hash >> 23 & 0xFFu;
    return exponent == 0 || exponent == 0xFF ? hash ^ 1u << 23 : hash;
}

// The id as a channel holds it.
inline float crypto_value(uint32_t id) {
    return std::bit_cast<float>(id);
}

// The channel of an id (`coverage`: of its coverage) of that rank, such as `CryptoObject00.R`.
std::string crypto_channel(std::string_view layer, uint32_t rank, bool coverage);

// Attributes about the layers begin with this; such an attribute: `cryptomatte/1234abc/manifest`.
inline constexpr std::string_view CRYPTO_PREFIX = "cryptomatte/";
std::string crypto_attribute(std::string_view layer, std::string_view name);

// An id in eight hexadecimal digits.
std::string crypto_text(uint32_t id);

// Whether a channel is one of those.
bool is_crypto_channel(std::string_view name);

}  // namespace candela
