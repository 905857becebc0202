# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as arrays."""
import numpy

_SRGB = {"sRGB"}
_LINEAR = {"Non-Color", "Linear", "Linear Rec.709", "Raw"}


def srgb_to_linear(values):
    """The linear values of sRGB codes from 0 to 1 (IEC 61966-2-1)."""
    return numpy.where(values <= 0.04045, values / 12.92, ((numpy.maximum(values, 0.04045) + 0.055) / 1.055) ** 2.4)


def is_srgb(image, notices):
    """Whether the colours of the image's pixels are sRGB codes."""
    if image.is_float:
        return False  # Blender keeps them linear.
    space = image.colorspace_settings.name
    if space not in _SRGB | _LINEAR:
        notices.add(f'Image "{image.name}"', f"candela does not know the colour space {space}; it is taken for sRGB")
    return space not in _LINEAR


def raw_pixels(image):
    """(H, W, 4): its pixels as Blender has them, rows from the top: uint8, or float32 of an image of floats. None if the
    image has none, such as a file that is missing."""
    width, height = image.size
    if width == 0 or height == 0:
        return None
    pixels = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, 4)[::-1]
    if image.is_float:
        return numpy.ascontiguousarray(pixels)
    return (numpy.clip(pixels, 0, 1) * 255 + 0.5).astype(numpy.uint8)


def pixels_of(image, notices):
    """(H, W, 4), float32: its linear pixels; pink if it has none."""
    raw = raw_pixels(image)
    if raw is None:
        notices.add(f'Image "{image.name}"', "it has no pixels; is its file missing?")
        return numpy.array([[[1, 0, 1, 1]]], numpy.float32)
    if raw.dtype != numpy.uint8:
        return raw
    values = raw.astype(numpy.float32) / 255
    if is_srgb(image, notices):
        values[..., :3] = srgb_to_linear(values[..., :3])
    return values


def looked_up(pixels, place, extension, is_nearest):
    """(..., 4): the values of an image (H, W, 4), rows from the top, at texture coordinates (..., 2 or more). extension: what
    Blender calls the way in which it goes on beyond its edges."""
    height, width = pixels.shape[:2]
    x, y = place[..., 0] * width - 0.5, (1 - place[..., 1]) * height - 0.5

    def at(column, row):
        found = []
        for index, size in ((column, width), (row, height)):
            if extension == "REPEAT":
                index = index % size
            elif extension == "MIRROR":
                index = index % (2 * size)
                index = numpy.minimum(index, 2 * size - 1 - index)
            found.append(numpy.clip(index, 0, size - 1))
        values = pixels[found[1], found[0]]
        if extension == "CLIP":
            values = numpy.where(((found[0] == column) & (found[1] == row))[..., None], values, 0)
        return values
    if is_nearest:
        values = at(numpy.floor(x + 0.5).astype(int), numpy.floor(y + 0.5).astype(int))
    else:
        left, top = numpy.floor(x).astype(int), numpy.floor(y).astype(int)
        u, v = (x - left)[..., None], (y - top)[..., None]
        values = (at(left, top) * (1 - u) + at(left + 1, top) * u) * (1 - v) + \
            (at(left, top + 1) * (1 - u) + at(left + 1, top + 1) * u) * v
    return values.astype(numpy.float32)
