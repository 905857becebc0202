# SPDX-License-Identifier: GPL-3.0-or-later
"""What a socket of a node tree is: a number, a colour, or an image on a surface. What nodes make of images is computed
here, pixel by pixel, so that candela gets an image again; so is what they make of places, at the points of a mesh."""
import math

import mathutils
import numpy

from . import spatial
from .images import looked_up, pixels_of
from .values import Mapping, Value, constant, gray

_MATH = {
    "ADD": lambda a, b, c: a + b,
    "SUBTRACT": lambda a, b, c: a - b,
    "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: numpy.divide(a, b, out=numpy.zeros_like(a * b), where=b != 0),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": lambda a, b, c: numpy.power(numpy.maximum(a, 0), b),
    "SQRT": lambda a, b, c: numpy.sqrt(numpy.maximum(a, 0)),
    "ABSOLUTE": lambda a, b, c: numpy.abs(a),
    "MINIMUM": lambda a, b, c: numpy.minimum(a, b),
    "MAXIMUM": lambda a, b, c: numpy.maximum(a, b),
    "LESS_THAN": lambda a, b, c: (a < b) * 1.0,
    "GREATER_THAN": lambda a, b, c: (a > b) * 1.0,
    "ROUND": lambda a, b, c: numpy.floor(a + 0.5),
    "FLOOR": lambda a, b, c: numpy.floor(a),
    "CEIL": lambda a, b, c: numpy.ceil(a),
    "FRACT": lambda a, b, c: a - numpy.floor(a),
    "MODULO": lambda a, b, c: numpy.fmod(a, numpy.where(b == 0, 1, b)) * (b != 0),
    "SINE": lambda a, b, c: numpy.sin(a),
    "COSINE": lambda a, b, c: numpy.cos(a),
}

# Of vectors (..., 3).
_VECTOR_MATH = {
    "ADD": lambda a, b, s: a + b,
    "SUBTRACT": lambda a, b, s: a - b,
    "MULTIPLY": lambda a, b, s: a * b,
    "DIVIDE": lambda a, b, s: numpy.divide(a, b, out=numpy.zeros_like(a * b), where=b != 0),
    "SCALE": lambda a, b, s: a * s,
    "MINIMUM": lambda a, b, s: numpy.minimum(a, b),
    "MAXIMUM": lambda a, b, s: numpy.maximum(a, b),
    "ABSOLUTE": lambda a, b, s: numpy.abs(a),
    "FLOOR": lambda a, b, s: numpy.floor(a),
    "FRACTION": lambda a, b, s: a - numpy.floor(a),
    "LENGTH": lambda a, b, s: numpy.linalg.norm(a, axis=-1, keepdims=True),
    "DISTANCE": lambda a, b, s: numpy.linalg.norm(a - b, axis=-1, keepdims=True),
    "DOT_PRODUCT": lambda a, b, s: (a * b).sum(-1, keepdims=True),
}

_BLENDS = {
    "MIX": lambda a, b: b,
    "MULTIPLY": lambda a, b: a * b,
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "DARKEN": numpy.minimum,
    "LIGHTEN": numpy.maximum,
    "SCREEN": lambda a, b: 1 - (1 - a) * (1 - b),
    "DIFFERENCE": lambda a, b: numpy.abs(a - b),
}


class NeedsPoints(Exception):
    """A socket has no value but at the points of a mesh."""


class Reader:
    """Reads the sockets of a material's nodes. `points`: the surface.Points at which it does so; None for images as they are
    and constants alone, False if there are none to be had."""

    def __init__(self, place, notices):
        self.points = None
        self._place = place
        self._notices = notices
        self._groups = []  # The nodes of the groups that are being read, the innermost last.

    def notice(self, node, text):
        self._notices.add(f'{self._place}, node "{node.name}"', text)

    def _want_points(self):
        """Before what can be said at points alone, and else only with a notice."""
        if self.points is None:
            raise NeedsPoints

    def source(self, socket):
        """The socket that feeds this one, behind reroutes and out of groups; None if nothing does. Ends with `leave` once it
        has been read."""
        while socket is not None and socket.links and not socket.links[0].is_muted:
            output = socket.links[0].from_socket
            node = output.node
            if node.type == "REROUTE":
                socket = node.inputs[0]
            elif node.mute:
                socket = next((link.from_socket for link in getattr(node, "internal_links", ())
                               if link.to_socket == output), None)
            elif node.type == "GROUP" and node.node_tree is not None:
                inside = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
                if inside is None:
                    return None
                self._groups.append(node)
                socket = inside.inputs[[s.identifier for s in node.outputs].index(output.identifier)]
                if not socket.links:
                    return socket
            elif node.type == "GROUP_INPUT" and self._groups:
                outer = self._groups.pop()
                socket = outer.inputs[[s.identifier for s in node.outputs].index(output.identifier)]
                if not socket.links:
                    return socket
            else:
                return output
        return None

    def read(self, socket):
        """The Value of an input."""
        groups = list(self._groups)
        source = self.source(socket)
        try:
            if source is None:
                return constant(socket.default_value)
            if not source.is_output:  # An input of a group, or of its end.
                return constant(source.default_value)
            return self._of_node(source.node, source)
        finally:
            self._groups = groups

    def _of_node(self, node, output):
        if node.type in spatial.READERS:
            return self._in_space(node, output)
        reader = getattr(self, "_read_" + node.type.lower(), None)
        if reader is None:
            self.notice(node, f"candela does not know nodes of the type {node.bl_label}; its value is 0.5")
            return constant(0.5)
        return reader(node, output)

    def _in_space(self, node, output):
        if not self.points:
            self._want_points()
            self.notice(node, "its mesh has too many triangles for textures in space; its value is 0.5")
            return constant(0.5)
        return spatial.READERS[node.type](self, node, output)

    # Each: the Value of an output of a node of this type.

    def _read_rgb(self, node, output):
        return constant(output.default_value)

    def _read_value(self, node, output):
        return constant(output.default_value)

    def _read_vertex_color(self, node, output):
        if self.points and self.points.colors is not None:
            return spatial.at_points(self.points.colors)
        return Value([1, 1, 1, 1], is_color_attribute=not self.points)

    def _read_attribute(self, node, output):
        if output.name == "Color":
            return self._read_vertex_color(node, output)
        self.notice(node, "candela knows the colours of vertices alone among attributes; its value is 0.5")
        return constant(0.5)

    def _read_tex_image(self, node, output):
        if node.image is None:
            return constant((1, 0, 1, 1))
        pixels = pixels_of(node.image, self._notices)
        if self.points:
            linked = node.inputs["Vector"].is_linked
            place = spatial.place_of(self, node) if linked else self.points.uv()
            value = spatial.at_points(looked_up(pixels, place, node.extension, node.interpolation == "Closest"))
            return Value(numpy.repeat(value.pixels[..., 3:], 4, -1), value.mapping) if output.name == "Alpha" else value
        mapping = self._mapping(node)
        if output.name == "Alpha":
            return Value(numpy.repeat(pixels[..., 3:], 4, -1), mapping)
        return Value(pixels, mapping, node.image)

    def _mapping(self, node):
        if node.projection != "FLAT":
            self.notice(node, f"candela has no projection {node.projection} of images; texture coordinates are used")
        wraps = {"REPEAT": "repeat", "MIRROR": "mirror"}
        if node.extension == "CLIP":
            self._want_points()
            self.notice(node, "candela does not clip images; their edges are continued")
        keys = {"wrap": wraps.get(node.extension, "clamp"),
                "filter": "nearest" if node.interpolation == "Closest" else "bilinear"}
        source = self.source(node.inputs["Vector"])
        if source is not None and source.is_output and source.node.type == "MAPPING":
            keys.update(self._transform(source.node))
            source = self.source(source.node.inputs["Vector"])
        if source is None or not source.is_output:
            return Mapping(**keys)
        if source.node.type == "UVMAP":
            return Mapping(uv=source.node.uv_map or None, **keys)
        if source.node.type != "TEX_COORD" or source.name != "UV":
            self._want_points()
            self.notice(source.node, f"candela knows texture coordinates by UV only here, not {source.name}")
        return Mapping(**keys)

    def _transform(self, node):
        vectors = [self.constant_vector(node.inputs[name]) for name in ("Location", "Rotation", "Scale")]
        if node.vector_type not in {"POINT", "VECTOR"} or any(vector is None for vector in vectors):
            self._want_points()
            self.notice(node, "candela knows mappings of the type Point, of constants; it is left out")
            return {}
        location, rotation, scale = vectors
        if rotation[:2].any():
            self._want_points()
            self.notice(node, "candela turns texture coordinates about Z only")
        return {"scale": scale[:2].tolist(), "rotation": math.degrees(rotation[2]),
                "offset": location[:2].tolist() if node.vector_type == "POINT" else (0, 0)}

    def constant_vector(self, socket):
        """(3,), if it is the same everywhere, else None."""
        if not socket.enabled:
            return numpy.zeros(3)
        value = self.read(socket)
        return value.color if value.is_constant else None

    def combine(self, node, values, function):
        """A function of several values, pixel by pixel."""
        images = [value for value in values if not value.is_constant]
        if any(value.is_color_attribute for value in values):
            self._want_points()
            self.notice(node, "candela multiplies the colours of vertices only; they are white here")
        if len({value.pixels.shape for value in images}) > 1 or any(v.mapping != images[0].mapping for v in images):
            self._want_points()
            self.notice(node, "candela does not combine images of several sizes or places; the first is used")
            values = [v if v.is_constant or v is images[0] else Value(v.pixels.mean((0, 1))) for v in values]
        return Value(function(*(value.pixels for value in values)), images[0].mapping if images else None)

    def _read_mapping(self, node, output):
        scale, location = (self.read(node.inputs[name]) if name in node.inputs and node.inputs[name].enabled
                           else constant((value,) * 3) for name, value in (("Scale", 1.0), ("Location", 0.0)))
        angles = self.constant_vector(node.inputs["Rotation"])
        if angles is None:
            self.notice(node, "candela turns by a constant; it is left out")
            angles = numpy.zeros(3)
        turn = numpy.array(mathutils.Euler(angles).to_matrix(), numpy.float32)

        def mapped(place, size, moved):
            place, size, moved = (x[..., :3] for x in (place, size, moved))
            if node.vector_type == "TEXTURE":
                result = numpy.divide((place - moved) @ turn, size, out=numpy.zeros_like(place - moved), where=size != 0)
            elif node.vector_type == "NORMAL":
                result = numpy.divide(place, size, out=numpy.zeros_like(place * size), where=size != 0) @ turn.T
                result = result / numpy.maximum(numpy.linalg.norm(result, axis=-1, keepdims=True), 1e-30)
            else:
                result = (place * size) @ turn.T + (moved if node.vector_type == "POINT" else 0)
            return numpy.concatenate([result, numpy.ones_like(result[..., :1])], -1)
        return self.combine(node, [self.read(node.inputs["Vector"]), scale, location], mapped)

    def _read_vect_math(self, node, output):
        function = _VECTOR_MATH.get(node.operation)
        if function is None:
            self.notice(node, f"candela does not know the operation {node.operation}; its first input is used")
            return self.read(node.inputs[0])
        scale = gray(self.read(node.inputs["Scale"])) if "Scale" in node.inputs else constant(1.0)

        def result(a, b, s):
            found = function(a[..., :3], b[..., :3], s[..., :3])
            found = numpy.broadcast_to(found, (*found.shape[:-1], 3))
            return numpy.concatenate([found, numpy.ones_like(found[..., :1])], -1)
        return self.combine(node, [self.read(node.inputs[0]), self.read(node.inputs[1]), scale], result)

    # Of images, of what is computed at points, and of constants alike.

    def _read_math(self, node, output):
        function = _MATH.get(node.operation)
        if function is None:
            self.notice(node, f"candela does not know the operation {node.operation}; its first input is used")
            return self.read(node.inputs[0])
        values = [gray(self.read(node.inputs[i])) for i in range(3)]
        end = (lambda x: numpy.clip(x, 0, 1)) if node.use_clamp else (lambda x: x)
        return self.combine(node, values, lambda a, b, c: end(function(a, b, c)))

    def _read_mix(self, node, output):
        if node.data_type not in {"RGBA", "FLOAT"}:
            self.notice(node, f"candela does not mix values of the type {node.data_type}; the first is used")
        inputs = [socket for socket in node.inputs if socket.enabled]
        blend = node.blend_type if node.data_type == "RGBA" else "MIX"
        return self._mix(node, inputs[0], inputs[1], inputs[2], blend, getattr(node, "clamp_result", False))

    def _read_mix_rgb(self, node, output):
        return self._mix(node, *node.inputs[:3], node.blend_type, node.use_clamp)

    def _mix(self, node, factor, first, second, blend, clamp):
        function = _BLENDS.get(blend)
        if function is None:
            self.notice(node, f"candela does not know the blend mode {blend}; it mixes")
            function = _BLENDS["MIX"]
        share, a, b = gray(self.read(factor)), self.read(first), self.read(second)
        if blend == "MULTIPLY" and share.is_constant and share.number == 1:
            for attribute, other in ((a, b), (b, a)):
                if attribute.is_color_attribute and not other.is_color_attribute:
                    return Value(attribute.pixels * other.pixels, other.mapping, other.source, True)

        def mixed(t, x, y):
            t = numpy.clip(t, 0, 1)
            result = x * (1 - t) + function(x, y) * t
            return numpy.clip(result, 0, 1) if clamp else result
        return self.combine(node, [share, a, b], mixed)

    def _read_invert(self, node, output):
        values = [gray(self.read(node.inputs[0])), self.read(node.inputs[1])]
        return self.combine(node, values, lambda t, x: x * (1 - t) + (1 - x) * t)

    def _read_gamma(self, node, output):
        values = [self.read(node.inputs[0]), gray(self.read(node.inputs[1]))]
        return self.combine(node, values, lambda x, g: numpy.power(numpy.maximum(x, 0), g))

    def _read_brightcontrast(self, node, output):
        values = [self.read(node.inputs[0]), gray(self.read(node.inputs[1])), gray(self.read(node.inputs[2]))]
        return self.combine(node, values, lambda x, b, c: numpy.maximum(x * (1 + c) + b - c / 2, 0))

    def _read_clamp(self, node, output):
        values = [gray(self.read(node.inputs[i])) for i in range(3)]
        return self.combine(node, values, numpy.clip)

    def _read_map_range(self, node, output):
        if node.data_type != "FLOAT" or node.interpolation_type != "LINEAR":
            self.notice(node, "candela knows linear ranges of numbers; the value is used as it is")
            return self.read(node.inputs["Value"])
        values = [gray(self.read(socket)) for socket in list(node.inputs)[:5]]

        def mapped(x, a, b, c, d):
            t = (x - a) / numpy.where(b == a, 1, b - a)
            return c + (numpy.clip(t, 0, 1) if node.clamp else t) * (d - c)
        return self.combine(node, values, mapped)

    def _read_valtorgb(self, node, output):
        value = gray(self.read(node.inputs[0]))
        steps = numpy.linspace(0, 1, 1025)
        table = numpy.array([node.color_ramp.evaluate(float(step)) for step in steps])
        if output.name == "Alpha":
            table = numpy.repeat(table[:, 3:], 4, 1)

        def ramp(x):
            at = numpy.clip(x[..., 0], 0, 1)
            return numpy.stack([numpy.interp(at, steps, table[:, i]) for i in range(4)], -1)
        return self.combine(node, [value], ramp)

    def _read_separate_color(self, node, output):
        if getattr(node, "mode", "RGB") != "RGB":
            self.notice(node, "candela separates red, green and blue only")
        channel = [socket.name for socket in node.outputs].index(output.name)
        return self.combine(node, [self.read(node.inputs[0])], lambda x: numpy.repeat(x[..., channel:channel + 1], 4, -1))

    _read_seprgb = _read_sepxyz = _read_separate_color

    def _read_combine_color(self, node, output):
        values = [gray(self.read(node.inputs[i])) for i in range(3)]
        return self.combine(node, values, lambda r, g, b: _broadcast(r, g, b))

    _read_combrgb = _read_combxyz = _read_combine_color

    def _read_rgbtobw(self, node, output):
        return gray(self.read(node.inputs[0]))

    def _read_hue_sat(self, node, output):
        hue, saturation, value, share = (gray(self.read(node.inputs[i])) for i in range(4))
        if not (hue.is_constant and abs(hue.number - 0.5) < 1e-6):
            self.notice(node, "candela does not turn hues")

        def changed(x, s, v, t):
            # Blender's HSV: saturation and value are factors.
            top, low = x[..., :3].max(-1, keepdims=True), x[..., :3].min(-1, keepdims=True)
            old = numpy.divide(top - low, top, out=numpy.zeros_like(top), where=top > 0)
            new = numpy.clip(old * s[..., :1], 0, 1)
            ratio = numpy.divide(new, old, out=numpy.ones_like(old), where=old > 0)
            rgb = (top - (top - x[..., :3]) * ratio) * v[..., :1]
            rgb = x[..., :3] * (1 - t[..., :1]) + numpy.maximum(rgb, 0) * t[..., :1]
            return numpy.concatenate([rgb, numpy.broadcast_to(x[..., 3:], rgb[..., :1].shape)], -1)
        return self.combine(node, [self.read(node.inputs[4]), saturation, value, share], changed)


def _broadcast(r, g, b):
    r, g, b = numpy.broadcast_arrays(r[..., 0], g[..., 0], b[..., 0])
    return numpy.stack([r, g, b, numpy.ones_like(r)], -1)
