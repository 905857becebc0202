"""The header of an EXR file as candela writes it: one part, scan lines, ZIP compression."""

import struct

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
