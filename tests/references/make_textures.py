#!/usr/bin/env python3
"""Makes the images of this folder's scenes: `python3 make_textures.py`. They are small and have hard edges, so that every
texel shows where it is looked up."""

import math
import struct
import sys
import zlib
from pathlib import Path

HERE = Path(__file__).parent
sys.path.append(str(HERE.parent.parent / "scenes"))

import radiance_picture  # noqa: E402


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def write_png(name, rows):
    """Rows of texels from the top, each of 1, 3 or 4 numbers from 0 to 255."""
    channels = len(rows[0][0])
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    data = b"".join(b"\0" + bytes(value for texel in row for value in texel) for row in rows)
    (HERE / name).write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


def texels(width, height, colour):
    return [[colour(x, y) for x in range(width)] for y in range(height)]


def hills(x, y):
    """The normal of hills, at most 25 degrees steep."""
    slope = math.tan(math.radians(25)) / math.sqrt(2)
    n = [-slope * math.sin(math.pi * x / 4), slope * math.cos(math.pi * y / 4), 1.0]
    length = math.sqrt(sum(c * c for c in n))
    return [round(127.5 + 127.5 * c / length) for c in n]


def leaf(x, y):
    """Green, and opaque where two disks overlap, but half transparent at the rim."""
    within = min(7.0 - math.hypot(x, y - 7), 7.5 - math.hypot(x - 7, y))
    return [20 * x, 120 + 15 * y, 40, round(255 * min(max(within, 0.0), 1.0))]


def write_hdr(name, rows):
    """Rows of (r, g, b) from the top, each of at least 8."""
    data = radiance_picture.header("make_textures.py", len(rows[0]), len(rows))
    (HERE / name).write_bytes(data + b"".join(radiance_picture.encoded_row(row) for row in rows))


def mist(x, y):
    """A sky of low contrast: brighter above, and red on one side."""
    light, red = 1 - 0.05 * y, 0.2 * math.cos(math.pi * (x + 0.5) / 8)
    return (light * (1 + red), light, light * (1.1 - red))


def main():
    # Red grows to the right, green downwards; blue tells even texels from odd ones.
    write_png("patches.png", texels(8, 6, lambda x, y: [36 * x, 50 * y, 220 if (x + y) % 2 else 30]))
    write_png("hills.png", texels(16, 16, hills))
    write_png("grain.png", texels(8, 8, lambda x, y: [64 + 27 * ((3 * x + 5 * y) % 8)]))
    write_png("leaf.png", texels(8, 8, leaf))
    write_hdr("mist.hdr", texels(16, 8, mist))


if __name__ == "__main__":
    main()
