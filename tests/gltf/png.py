"""PNG files in and out with the standard library alone: 8 bits a channel; grey, RGB or RGBA; not interlaced."""

import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"
COLOUR_TYPES = {1: 0, 2: 4, 3: 2, 4: 6}  # By the number of channels.
CHANNELS = {kind: channels for channels, kind in COLOUR_TYPES.items()}


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def write(width, height, channels, pixels):
    """A PNG file as bytes, from pixels in rows from the top, channels interleaved."""
    assert len(pixels) == width * height * channels
    stride = width * channels
    rows = b"".join(b"\0" + bytes(pixels[row * stride:(row + 1) * stride]) for row in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, COLOUR_TYPES[channels], 0, 0, 0)
    return SIGNATURE + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def paeth(left, up, corner):
    """The neighbour that is nearest to left + up - corner: the fourth filter of PNG."""
    to_left, to_up, to_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    if to_left <= to_up and to_left <= to_corner:
        return left
    return up if to_up <= to_corner else corner


def unfiltered(kind, row, above, channels):
    """A row of bytes, from what its filter left of it and the row above; changes row."""
    if kind == 1:
        for i in range(channels, len(row)):
            row[i] = (row[i] + row[i - channels]) & 255
    elif kind == 2:
        for i, up in enumerate(above):
            row[i] = (row[i] + up) & 255
    elif kind == 3:
        for i, up in enumerate(above):
            left = row[i - channels] if i >= channels else 0
            row[i] = (row[i] + (left + up) // 2) & 255
    elif kind == 4:
        for i, up in enumerate(above):
            left, corner = (row[i - channels], above[i - channels]) if i >= channels else (0, 0)
            row[i] = (row[i] + paeth(left, up, corner)) & 255
    elif kind:
        raise ValueError(f"PNG: unknown filter {kind}")
    return row


def read(data):
    """Width, height, channels and pixels of a PNG file; ValueError if it is another kind of file or of PNG."""
    if data[:8] != SIGNATURE:
        raise ValueError("not a PNG file")
    place, packed = 8, b""
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        content = data[place + 8:place + 8 + length]
        if kind == b"IHDR":
            width, height, bits, colour_type, _, _, interlaced = struct.unpack(">IIBBBBB", content)
            if bits != 8 or colour_type not in CHANNELS or interlaced:
                raise ValueError("PNG: not 8 bits of grey, RGB or RGBA without interlacing")
        elif kind == b"IDAT":
            packed += content
        place += length + 12
    channels = CHANNELS[colour_type]
    stride = width * channels
    filtered = zlib.decompress(packed)
    above, pixels = bytes(stride), bytearray()
    for start in range(0, height * (stride + 1), stride + 1):
        above = unfiltered(filtered[start], bytearray(filtered[start + 1:start + 1 + stride]), above, channels)
        pixels += above
    return width, height, channels, pixels
