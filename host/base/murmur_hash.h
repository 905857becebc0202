// MurmurHash3 for 32 bits, by which Cryptomatte names things. Portable; it does not resist an adversary.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace candela {

// The hash of `text` with the seed 0.
// Ref: Appleby, "MurmurHash3" (2011), MurmurHash3_x86_32.
inline uint32_t murmur3_32(std::string_view text) {
    const auto byte = [&](size_t i) { return uint32_t{uint8_t(text[i])}; };
    const auto scrambled = [](uint32_t k) { return std::rotl(k * 0xCC9E2D51u, 15) * 0x1B873593u; };
    uint32_t hash = 0;
    const size_t blocks = text.size() / 4 * 4;
    for (size_t i = 0; i < blocks; i += 4) {
        const uint32_t k = byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24;
        hash = std::rotl(hash ^ scrambled(k), 13) * 5 + 0xE6546B64u;
    }
    uint32_t rest = 0;
    for (size_t i = text.size(); i > blocks; --i)
        rest = rest << 8 | byte(i - 1);
    hash ^= scrambled(rest);
    hash ^= uint32_t(text.size());
    hash = (hash ^ hash >> 16) * 0x85EBCA6Bu;
    hash = (hash ^ hash >> 13) * 0xC2B2AE35u;
    return hash ^ hash >> 16;
}

}  // namespace candela
