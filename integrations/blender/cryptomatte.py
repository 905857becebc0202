# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender and others are told about passes of Cryptomatte. Ref: Friedman, Jones, "Cryptomatte Specification" 1.2.0
(2018)."""
import json

_MASK = 0xFFFFFFFF


def _turned(value, bits):
    return (value << bits | value >> (32 - bits)) & _MASK


def murmur_hash(data):
    """MurmurHash3 for 32 bits, of bytes."""
    state = 0
    blocks = len(data) // 4 * 4
    for i in range(0, blocks, 4):
        state ^= _mixed(int.from_bytes(data[i:i + 4], "little"))
        state = (_turned(state, 13) * 5 + 0xE6546B64) & _MASK
    if len(data) > blocks:
        state ^= _mixed(int.from_bytes(data[blocks:], "little"))
    state ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        state = (state ^ state >> shift) * factor & _MASK
    return state ^ state >> 16


def _mixed(block):
    return _turned(block * 0xCC9E2D51 & _MASK, 15) * 0x1B873593 & _MASK


def id_of(name):
    """The id of a name: its hash, made the bits of a float that is an ordinary number."""
    bits = murmur_hash(name.encode())
    return bits ^ (1 << 23) if (bits >> 23 & 255) in (0, 255) else bits


def metadata(layer, names):
    """(key, value) of all that is said about a layer, such as "ViewLayer.CryptoObject", with these names in it."""
    begin = f"cryptomatte/{murmur_hash(layer.encode()):08x}"[:-1]
    manifest = json.dumps({name: f"{id_of(name):08x}" for name in names}, separators=(",", ":"))
    return [(f"{begin}/name", layer), (f"{begin}/hash", "MurmurHash3_32"), (f"{begin}/conversion", "uint32_to_float32"),
            (f"{begin}/manifest", manifest)]
