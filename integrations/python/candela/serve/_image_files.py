"""Files of pixels that the program does not write."""
from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any

import numpy
from numpy.typing import NDArray

_TIFF_SHORT, _TIFF_LONG = 3, 4


def write_depth_tiff(path: Path, depth: NDArray[numpy.float32]) -> None:
    """A TIFF of 32-bit floats with one channel, from (H, W)."""
    height, width = depth.shape
    pixels = depth.astype("<f4").tobytes()
    tags = [(256, _TIFF_LONG, width), (257, _TIFF_LONG, height), (258, _TIFF_SHORT, 32),
            (259, _TIFF_SHORT, 1),  # Not compressed.
            (262, _TIFF_SHORT, 1),  # 0 is black.
            (273, _TIFF_LONG, 0),  # Where the only strip begins: below.
            (277, _TIFF_SHORT, 1), (278, _TIFF_LONG, height), (279, _TIFF_LONG, len(pixels)),
            (339, _TIFF_SHORT, 3)]  # Floats.
    begin = 8 + 2 + 12 * len(tags) + 4
    data = struct.pack("<2sHLH", b"II", 42, 8, len(tags))
    for tag, kind, value in tags:
        data += struct.pack("<HHLL", tag, kind, 1, begin if tag == 273 else value)
    path.write_bytes(data + struct.pack("<L", 0) + pixels)


def write_rgb_png(path: Path, pixels: NDArray[Any]) -> None:
    """A PNG of 8 bits a channel, from (H, W, 3)."""
    height, width, _ = pixels.shape
    rows = numpy.zeros((height, 1 + 3 * width), numpy.uint8)  # Each begins with its filter: none.
    rows[:, 1:] = pixels.reshape(height, 3 * width)
    head = struct.pack(">LLBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", head) + _chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) +
                     _chunk(b"IEND", b""))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">L", len(data)) + kind + data + struct.pack(">L", zlib.crc32(kind + data))
