"""KTX 2 files of Basis Universal with the standard library alone: UASTC, of blocks of one colour each.

Ref: Khronos, "KTX File Format Specification", version 2.0; Binomial, "UASTC LDR 4x4 Texture Specification"; IETF, RFC
8878 (Zstandard), section 3.1.1.
"""

import struct

SIGNATURE = b"\xabKTX 20\xbb\r\n\x1a\n"
NO_COMPRESSION, ZSTANDARD = 0, 2
LINEAR_TRANSFER, SRGB_TRANSFER = 1, 2
RGB, RGBA = 0, 3


def solid_block(codes):
    """Four by four pixels of one colour: the mode 8 in five bits, then red, green, blue and alpha in eight each."""
    red, green, blue, alpha = (*codes, 255)[:4]
    return struct.pack("<QQ", 0x17 | red << 5 | green << 13 | blue << 21 | alpha << 29, 0)


def raw_frame(data):
    """A frame of Zstandard with one block that is not compressed."""
    assert len(data) < 1 << 17
    return b"\x28\xb5\x2f\xfd\xa0" + struct.pack("<I", len(data)) + (1 | len(data) << 3).to_bytes(3, "little") + data


def write(width, height, function, channels=3, transfer=SRGB_TRANSFER, scheme=NO_COMPRESSION):
    """A file of function(column, row) of blocks, whose values are codes; width and height are in pixels."""
    blocks = b"".join(solid_block(function(column, row)) for row in range((height + 3) // 4)
                      for column in range((width + 3) // 4))
    data = raw_frame(blocks) if scheme == ZSTANDARD else blocks
    uastc, bt709, four_by_four = 166, 1, 3 | 3 << 8
    sample = 127 << 16 | (RGB if channels == 3 else RGBA) << 24
    description = struct.pack("<11I", 44, 0, 2 | 40 << 16, uastc | bt709 << 8 | transfer << 16, four_by_four, 16, 0, sample,
                              0, 0, 0xFFFFFFFF)
    place = len(SIGNATURE) + 13 * 4 + 2 * 8 + 3 * 8
    return (SIGNATURE + struct.pack("<13I", 0, 1, width, height, 0, 0, 1, 1, scheme, place, len(description), 0, 0)
            + struct.pack("<5Q", 0, 0, place + len(description), len(data), len(blocks)) + description + data)
