// Hashes: FNV-1a, which names an image in a report, and a faster one for large arrays. Both are portable;
// neither resists an adversary.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace candela {

inline constexpr uint64_t FNV1A64_BASIS = 0xcbf29ce484222325u;

// The 64-bit FNV-1a hash of `bytes`. To hash in parts, pass the hash of the previous part as `hash`.
// Ref: Fowler, Noll, Vo, "FNV Hash", http://www.isthe.com/chongo/tech/comp/fnv/
inline uint64_t fnv1a64(std::span<const std::byte> bytes, uint64_t hash = FNV1A64_BASIS) {
    constexpr uint64_t PRIME = 0x100000001b3u;
    for (const std::byte byte : bytes) {
        hash = (hash ^ std::to_integer<uint64_t>(byte)) * PRIME;
    }
    return hash;
}

// A 64-bit hash of `bytes` and of their number. To hash in parts, pass the hash of the previous part as
// `hash`. A step is one multiplication per eight bytes: about 0.2 s for half a gigabyte. A multiplication
// spreads bits upwards only; the rotation brings the upper bits of a word down for the next step.
inline uint64_t hash_words(std::span<const std::byte> bytes, uint64_t hash = FNV1A64_BASIS) {
    constexpr uint64_t ODD = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio: bits without a pattern.
    const auto step = [&hash](uint64_t word) { hash = std::rotl((hash ^ word) * ODD, 29); };
    step(bytes.size());
    for (size_t i = 0; i < bytes.size(); i += sizeof(uint64_t)) {
        uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
        step(word);
    }
    step(0);
    return hash;
}

}  // namespace candela
