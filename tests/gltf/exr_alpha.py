"""The alpha channel of an EXR file as candela writes it: one part, scan lines, ZIP compression, 32-bit floats."""

import struct
import zlib

MAGIC = b"v/1\x01"
FLOAT, BYTES = 2, {1: 2, 2: 4}  # Types of channels; bytes of a half and of a float.
ZIP_LINES = {2: 1, 3: 16}  # Rows in a block, by the kind of compression.


def attributes(data):
    """The header's attributes by name, and where the blocks' offsets begin."""
    place, found = 8, {}
    while data[place]:
        name, kind, rest = data[place:place + 512].split(b"\0", 2)
        size_at = place + len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, size_at)[0]
        found[name.decode("ascii")] = data[size_at + 4:size_at + 4 + size]
        place = size_at + 4 + size
    return found, place + 1


def channels(packed):
    """Names and types of channels, in the order of the file."""
    place, found = 0, []
    while packed[place]:
        end = packed.index(0, place)
        found.append((packed[place:end].decode("ascii"), struct.unpack_from("<i", packed, end + 1)[0]))
        place = end + 1 + 16
    return found


def unpacked(block, size):
    """What was compressed: differences from byte to byte, of even bytes before odd ones."""
    if len(block) == size:
        return block
    data = bytearray(zlib.decompress(block))
    for i in range(1, size):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    result = bytearray(size)
    half = (size + 1) // 2
    result[0::2], result[1::2] = data[:half], data[half:]
    return result


def read_alpha(data):
    """Width, height and the values of A in rows from the top; ValueError if the file is of another kind."""
    if data[:4] != MAGIC:
        raise ValueError("not an EXR file")
    header, place = attributes(data)
    lines = ZIP_LINES.get(header["compression"][0])
    listed = channels(header["channels"])
    if lines is None or ("A", FLOAT) not in listed:
        raise ValueError("EXR: not compressed by ZIP, or without A as 32-bit floats")
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    row_bytes = width * sum(BYTES[kind] for _, kind in listed)
    before = width * sum(BYTES[kind] for name, kind in listed[:[name for name, _ in listed].index("A")])
    alpha = []
    for block in range(-(-height // lines)):
        offset = struct.unpack_from("<Q", data, place + 8 * block)[0]
        _, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, height - block * lines)
        content = unpacked(data[offset + 8:offset + 8 + size], rows * row_bytes)
        for row in range(rows):
            alpha += struct.unpack_from(f"<{width}f", content, row * row_bytes + before)
    return width, height, alpha
