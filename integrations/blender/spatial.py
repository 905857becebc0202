# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes whose value differs from place to place on a mesh and that are no image on it: computed at a surface.Points.

Each function of READERS, by the type of a node, takes the nodes.Reader that reads it, the node and its output, and returns
a Value."""
import bpy
import numpy

from . import procedural
from .values import IN_SPACE, Mapping, Value, constant, gray


def at_points(values):
    """The Value of numbers (side, side), or of vectors or colours (side, side, 3 or 4), at the points."""
    values = numpy.asarray(values, numpy.float32)
    if values.ndim == 2:
        values = numpy.repeat(values[..., None], 3, -1)
    if values.shape[-1] == 3:
        values = numpy.concatenate([values, numpy.ones_like(values[..., :1])], -1)
    return Value(values, Mapping(uv=IN_SPACE, wrap="clamp"))


def _amount(reader, node, name, default=0.0):
    """A number that is the same at all points."""
    if name not in node.inputs:
        return default
    value = reader.read(node.inputs[name])
    if not value.is_constant:
        reader.notice(node, f"candela wants a constant {name}; the mean is used")
        value = Value(value.pixels.mean((0, 1)))
    return gray(value).number


def place_of(reader, node, scale=1.0):
    """(side, side, 3): where a texture is looked up."""
    linked = node.inputs["Vector"].is_linked
    place = reader.read(node.inputs["Vector"]).pixels[..., :3] if linked else reader.points.generated
    return numpy.broadcast_to(place * numpy.float32(scale), (reader.points.side, reader.points.side, 3)).astype(numpy.float32)


def _coordinates(reader, node, dimensions, scale=1.0):
    """What a noise of these dimensions is a function of."""
    if dimensions == "4D":
        reader.notice(node, "candela knows noises of up to three dimensions; its W is left out")
    if dimensions == "1D":
        w = gray(reader.read(node.inputs["W"])).pixels[..., 0] * numpy.float32(scale)
        return [numpy.broadcast_to(w, (reader.points.side, reader.points.side)).astype(numpy.float32)]
    place = place_of(reader, node, scale)
    return [place[..., i] for i in range(2 if dimensions == "2D" else 3)]


def _tex_coord(reader, node, output):
    if output.name == "Object" and node.object is not None:
        reader.notice(node, "candela knows coordinates of the object itself, not those of another")
    found = {"Generated": "generated", "Object": "object", "Normal": "normal"}.get(output.name)
    if found is None and output.name != "UV":
        reader.notice(node, f"candela has no texture coordinates {output.name}; they are Generated")
        found = "generated"
    return at_points(getattr(reader.points, found) if found is not None else reader.points.uv())


def _uvmap(reader, node, output):
    return at_points(reader.points.uv(node.uv_map))


def _new_geometry(reader, node, output):
    if output.name in {"Position", "Normal", "True Normal"}:
        reader.notice(node, f"candela has {output.name} in the object's own space here")
        return at_points(reader.points.object if output.name == "Position" else reader.points.normal)
    reader.notice(node, f"candela does not know {output.name}; its value is 0.5")
    return constant(0.5)


def _tex_noise(reader, node, output):
    if getattr(node, "noise_type", "FBM") != "FBM":
        reader.notice(node, f"candela knows noises of the type fBM, not {node.noise_type}")
    place = _coordinates(reader, node, node.noise_dimensions, _amount(reader, node, "Scale"))
    return at_points(procedural.noise(
        place, min(max(_amount(reader, node, "Detail"), 0.0), 15.0), min(max(_amount(reader, node, "Roughness"), 0.0), 1.0),
        _amount(reader, node, "Lacunarity", 2.0), _amount(reader, node, "Distortion"), getattr(node, "normalize", True),
        output.name == "Color"))


def _tex_white_noise(reader, node, output):
    place = _coordinates(reader, node, node.noise_dimensions)
    if output.name != "Color":
        return at_points(procedural.white_noise(*place))
    turned = [place[i:] + place[:i] for i in range(len(place))]
    return at_points(numpy.stack([procedural.white_noise(*(turned * 3)[i]) for i in range(3)], -1))


def _tex_voronoi(reader, node, output):
    dimensions = node.voronoi_dimensions
    if dimensions == "1D":
        reader.notice(node, "candela knows Voronoi textures of two and three dimensions")
        dimensions = "2D"
    if node.feature not in {"F1", "F2", "DISTANCE_TO_EDGE"}:
        reader.notice(node, f"candela does not know the feature {node.feature}; it is F1")
    if _amount(reader, node, "Detail") != 0:
        reader.notice(node, "candela has no octaves of Voronoi textures; the first is used")
    place = _coordinates(reader, node, dimensions, _amount(reader, node, "Scale"))
    randomness = min(max(_amount(reader, node, "Randomness", 1.0), 0.0), 1.0)
    by_pcg = bpy.app.version >= (5, 0, 0)
    if node.feature == "DISTANCE_TO_EDGE":
        return at_points(procedural.voronoi_edge(place, randomness, node.normalize, by_pcg))
    if output.name not in {"Distance", "Color"}:
        reader.notice(node, f"candela does not know its {output.name}; it is Distance")
    value, color = procedural.voronoi(place, node.feature == "F2", node.distance, _amount(reader, node, "Exponent", 0.5),
                                      randomness, node.normalize, by_pcg)
    return at_points(color if output.name == "Color" else value)


def _tex_checker(reader, node, output):
    value = at_points(procedural.checker(place_of(reader, node, _amount(reader, node, "Scale"))))
    if output.name != "Color":
        return value
    colors = [value, reader.read(node.inputs["Color1"]), reader.read(node.inputs["Color2"])]
    return reader.combine(node, colors, lambda t, a, b: t * a + (1 - t) * b)


def _tex_gradient(reader, node, output):
    return at_points(procedural.gradient(place_of(reader, node), node.gradient_type))


def _tex_magic(reader, node, output):
    color = procedural.magic(place_of(reader, node, _amount(reader, node, "Scale")), node.turbulence_depth,
                             _amount(reader, node, "Distortion"))
    return at_points(color if output.name == "Color" else color.mean(-1))


def _tex_wave(reader, node, output):
    direction = node.bands_direction if node.wave_type == "BANDS" else node.rings_direction
    return at_points(procedural.wave(
        place_of(reader, node, _amount(reader, node, "Scale")), node.wave_type, direction, node.wave_profile,
        *(_amount(reader, node, name) for name in ("Phase Offset", "Distortion", "Detail", "Detail Scale",
                                                    "Detail Roughness"))))


def _tex_brick(reader, node, output):
    mortar, tint = (at_points(value) for value in procedural.brick(
        place_of(reader, node, _amount(reader, node, "Scale")),
        *(_amount(reader, node, name) for name in ("Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")),
        node.offset, node.offset_frequency, node.squash, node.squash_frequency))
    if output.name != "Color":
        return mortar
    colors = [mortar, tint, *(reader.read(node.inputs[name]) for name in ("Color1", "Color2", "Mortar"))]
    return reader.combine(node, colors, lambda m, t, a, b, c: ((1 - t) * a + t * b) * (1 - m) + m * c)


READERS = {"TEX_COORD": _tex_coord, "UVMAP": _uvmap, "NEW_GEOMETRY": _new_geometry, "TEX_NOISE": _tex_noise,
           "TEX_WHITE_NOISE": _tex_white_noise, "TEX_VORONOI": _tex_voronoi, "TEX_CHECKER": _tex_checker,
           "TEX_GRADIENT": _tex_gradient, "TEX_MAGIC": _tex_magic, "TEX_WAVE": _tex_wave, "TEX_BRICK": _tex_brick}
