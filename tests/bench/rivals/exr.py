"""Reads OpenEXR pictures as candela, Blender and the tracer write them: scan lines, 32-bit floats, ZIP compression."""

import array
import struct
import sys
import zlib
from itertools import accumulate
from pathlib import Path

MAGIC = 20000630
ZIP = 3  # Blocks of 16 rows.
ZIP_ROWS = 16


def take_string(data, at):
    """A text that ends with 0, and where the next thing begins."""
    end = data.index(0, at)
    return data[at:end].decode("latin-1"), end + 1


def header(data):
    """Attributes as bytes, and where they end."""
    attributes, at = {}, 8
    while data[at]:
        name, at = take_string(data, at)
        _, at = take_string(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channel_names(attribute):
    """Names of the channels in the order of the file; all must be 32-bit floats."""
    names, at = [], 0
    while attribute[at]:
        name, at = take_string(attribute, at)
        kind, _, x, y = struct.unpack_from("<4i", attribute, at)
        if (kind, x, y) != (2, 1, 1):
            sys.exit(f"exr.py reads 32-bit floats at full resolution alone; channel {name} is something else")
        names.append(name)
        at += 16
    return names


def unpacked(block, size):
    """The bytes of a block. Ref: OpenEXR's documentation, "ZIP": halves of the floats apart, then differences."""
    if len(block) == size:
        return block
    differences = zlib.decompress(block)
    halves = bytes(accumulate(differences, lambda a, b: a + b - 128 & 255))
    result = bytearray(size)
    result[0::2], result[1::2] = halves[: (size + 1) // 2], halves[(size + 1) // 2 :]
    return result


def read_all(path):
    """Width, height, the attributes as bytes, and all channels by name: arrays of floats, row-major from the top."""
    data = Path(path).read_bytes()
    if struct.unpack_from("<i", data)[0] != MAGIC:
        sys.exit(f"{path} is not an OpenEXR file")
    attributes, at = header(data)
    if attributes["compression"][0] != ZIP:
        sys.exit(f"{path}: exr.py reads ZIP compression alone")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    names = channel_names(attributes["channels"])
    planes = {name: array.array("f") for name in names}
    blocks = -(-height // ZIP_ROWS)
    for i, offset in enumerate(struct.unpack_from(f"<{blocks}Q", data, at)):
        _, size = struct.unpack_from("<2i", data, offset)
        rows = min(ZIP_ROWS, height - ZIP_ROWS * i)
        row = 4 * width * len(names)
        block = unpacked(data[offset + 8 : offset + 8 + size], row * rows)
        for start in range(0, rows * row, 4 * width):
            planes[names[start // (4 * width) % len(names)]].frombytes(block[start : start + 4 * width])
    return width, height, attributes, planes


def read(path):
    """Width, height, and the channels R, G and B, as read_all() does."""
    width, height, _, planes = read_all(path)
    return width, height, [planes[name] for name in "RGB"]
