"""Radiance pictures (.hdr), as the scripts that make skies write them: rows in the newer run-length encoding."""

import math


def rgbe(rgb):
    """Three mantissas and the exponent that they share."""
    largest = max(rgb)
    if largest < 1e-32:
        return (0, 0, 0, 0)
    exponent = math.frexp(largest)[1]
    mantissas = [math.floor(math.ldexp(c, 8 - exponent) + 0.5) for c in rgb]
    if max(mantissas) == 256:  # Rounded up to the next power of two.
        exponent += 1
        mantissas = [math.floor(math.ldexp(c, 8 - exponent) + 0.5) for c in rgb]
    return (*mantissas, exponent + 128)


def encode_component(values):
    """Runs of at least 3 equal bytes, and the bytes between them as they are."""
    encoded, pending = bytearray(), bytearray()

    def flush():
        for begin in range(0, len(pending), 128):
            part = pending[begin : begin + 128]
            encoded.append(len(part))
            encoded.extend(part)
        pending.clear()

    at = 0
    while at < len(values):
        end = at
        while end < len(values) and values[end] == values[at] and end - at < 127:
            end += 1
        if end - at >= 3:
            flush()
            encoded.extend((128 + end - at, values[at]))
        else:
            pending.extend(values[at:end])
        at = end
    flush()
    return bytes(encoded)


def encoded_row(colours):
    """The bytes of a row of (r, g, b)."""
    pixels = [rgbe(colour) for colour in colours]
    components = (encode_component([pixel[c] for pixel in pixels]) for c in range(4))
    return bytes((2, 2, len(pixels) >> 8, len(pixels) & 255)) + b"".join(components)


def header(maker, width, height):
    return f"#?RADIANCE\n# Made by {maker}.\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
