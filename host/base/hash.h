// FNV-1a, the hash that names an image in a report: short, portable, not meant against an adversary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace candela {

inline constexpr uint64_t FNV1A64_BASIS = 0xcbf29ce484222325u;

// The 64-bit FNV-1a hash of `bytes`. To hash in parts, hand in the hash of the part before as `hash`.
// Ref: Fowler, Noll, Vo, "FNV Hash", http://www.isthe.com/chongo/tech/comp/fnv/
inline uint64_t fnv1a64(std::span<const std::byte> bytes, uint64_t hash = FNV1A64_BASIS) {
    constexpr uint64_t PRIME = 0x100000001b3u;
    for (const std::byte byte : bytes) {
        hash = (hash ^ std::to_integer<uint64_t>(byte)) * PRIME;
    }
    return hash;
}

}  // namespace candela
