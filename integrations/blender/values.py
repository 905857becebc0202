# SPDX-License-Identifier: GPL-3.0-or-later
"""What a socket of a node tree is worth: a number, a colour, or an image on a surface."""
import numpy

from .images import is_srgb, raw_pixels

_LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])

# Texture coordinates of the texels of a surface.Points.
IN_SPACE = "those of points in space"


class Mapping:
    """Where on a surface an image is: the name of its texture coordinates (None: those of the render), and how they are
    scaled, turned [degrees] and shifted."""

    def __init__(self, uv=None, scale=(1, 1), rotation=0.0, offset=(0, 0), wrap="repeat", filter="bilinear"):
        self.keys = {"uv_scale": list(scale), "uv_rotation": rotation, "uv_offset": list(offset), "wrap": wrap,
                     "filter": filter}
        self.uv = uv

    def __eq__(self, other):
        return self.keys == other.keys and self.uv == other.uv


class Value:
    """A constant of shape (4,), or an image of (H, W, 4) and its mapping; linear. `source` is the image of Blender that it
    is without change, `is_color_attribute` whether it is the colour of vertices times the constant."""

    def __init__(self, pixels, mapping=None, source=None, is_color_attribute=False):
        self.pixels = numpy.asarray(pixels, numpy.float32)
        self.mapping = mapping
        self.source = source
        self.is_color_attribute = is_color_attribute

    @property
    def is_constant(self):
        return self.pixels.ndim == 1

    @property
    def color(self):
        """(3,), of a constant."""
        return self.pixels[:3].astype(float)

    @property
    def number(self):
        """Of a constant."""
        return float(self.pixels[:3] @ _LUMINANCE) if numpy.ptp(self.pixels[:3]) > 0 else float(self.pixels[0])


def constant(value):
    """A Value of a number, or of a colour with its alpha or without."""
    if isinstance(value, (int, float)):
        return Value([value, value, value, 1.0])
    numbers = list(value)[:4]
    return Value(numbers + [1.0] * (4 - len(numbers)))


def gray(value):
    """The number that a colour is where a number is wanted: its luminance."""
    if value.is_constant:
        return constant(value.number)
    if numpy.ptp(value.pixels[..., :3], -1).max() == 0:
        return Value(value.pixels, value.mapping, value.source)
    return Value(numpy.repeat((value.pixels[..., :3] @ _LUMINANCE)[..., None], 4, -1), value.mapping)


def as_codes(value, notices):
    """(H, W, 4), and "srgb" or "linear": the image of a Value as it is best kept."""
    raw = raw_pixels(value.source) if value.source is not None else None
    if raw is not None and raw.dtype == numpy.uint8:
        return raw, "srgb" if is_srgb(value.source, notices) else "linear"
    return value.pixels, "linear"
