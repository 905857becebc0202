# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: what candela makes of node trees."""
import math

import numpy

from .candela import Texture
from .nodes import NeedsPoints, Reader
from .notices import Notices
from .trees import tree_of
from .values import IN_SPACE, Value, as_codes, gray

_BLACK = {"base_color": 0.0, "specular": 0.0}


class Material:
    """Values of a candela material. `uv` is the name of the second texture coordinates that its images need; `in_space`
    whether it has textures in space, and so no values without the points of a mesh."""

    def __init__(self, in_space=False):
        self.type = "principled"
        self.values = {}
        self.uv = None
        self.in_space = in_space


class _Writer:
    """Makes a Material of a node tree."""

    def __init__(self, material, notices, points):
        self.place = f'Material "{material.name}"'
        self.notices = notices
        self.points = points
        self.reader = Reader(self.place, notices)
        self.made = Material()
        self.single_sided = material.use_backface_culling

    def notice(self, node, text):
        self.reader.notice(node, text)

    def read(self, node, *names):
        """The Value of the first of these inputs that the node has; None without any."""
        for name in names:
            if name in node.inputs:
                return self.read_socket(node.inputs[name])
        return None

    def read_socket(self, socket):
        """The Value of an input: images as they are, and only what needs it at the points of the mesh."""
        try:
            return self.reader.read(socket)
        except NeedsPoints:
            if self.points is None:
                raise
        self.reader.points = self.points
        try:
            return self.reader.read(socket)
        finally:
            self.reader.points = None

    def number(self, node, name, default=0.0):
        """A number that candela wants constant."""
        value = self.read(node, name)
        if value is None:
            return default
        if not value.is_constant:
            self.notice(node, f"candela wants a constant {name}; the mean of its image is used")
            value = Value(value.pixels.mean((0, 1)))
        return gray(value).number

    def set(self, key, value, is_color=False, low=0.0, high=1.0):
        """Gives the material a value that may be an image."""
        if value.is_constant:
            numbers = numpy.clip(value.color, low, high)
            self.made.values[key] = numbers.tolist() if is_color else float(numpy.clip(value.number, low, high))
        else:
            self.made.values[key] = self.texture(value, is_color)

    def texture(self, value, is_color, **keys):
        pixels, encoding = as_codes(value, self.notices) if is_color else (value.pixels, "linear")
        if not is_color:
            pixels = gray(Value(value.pixels, value.mapping)).pixels[..., 0]
            if value.source is not None and not value.source.is_float:
                pixels = (numpy.clip(pixels, 0, 1) * 65535 + 0.5).astype(numpy.uint16)
        elif pixels.dtype != numpy.uint8:
            pixels = numpy.maximum(pixels, 0)[..., :3]
        else:
            pixels = numpy.ascontiguousarray(pixels[..., :3])
        mapping = value.mapping
        keys.update(mapping.keys)
        if mapping.uv is not None:
            if self.made.uv not in (None, mapping.uv):
                self.notices.add(self.place, f"candela has two sets of texture coordinates for a mesh; not {mapping.uv}")
            else:
                self.made.uv = mapping.uv
                keys["uv_set"] = 1
        return Texture(numpy.ascontiguousarray(pixels), encoding=encoding, **keys)

    def set_base_color(self, value):
        if value.is_color_attribute:
            self.made.values["vertex_colors"] = True
        self.set("base_color", value, True)

    def shade(self, socket):
        """Takes over the shader that feeds a socket."""
        groups = list(self.reader._groups)
        source = self.reader.source(socket)
        if source is None or not source.is_output:
            self.made.values.update(_BLACK)
        else:
            node = source.node
            shader = getattr(self, "_shade_" + node.type.lower(), None)
            if shader is None:
                self.notice(node, f"candela does not know nodes of the type {node.bl_label}; the surface is grey")
                self.made.values["base_color"] = 0.5
            else:
                shader(node)
        self.reader._groups = groups

    def set_normal(self, node):
        """Takes over a normal map, or a bump map."""
        source = self.reader.source(node.inputs["Normal"]) if "Normal" in node.inputs else None
        if source is None or not source.is_output:
            return
        found = source.node
        if found.type == "NORMAL_MAP":
            self._set_normal_map(found)
        elif found.type == "BUMP":
            self._set_bump(found)
        else:
            self.notice(found, "candela knows normals by Normal Map and Bump only")

    def _set_normal_map(self, node):
        color = self.read(node, "Color")
        strength = self.number(node, "Strength", 1.0)
        if node.space != "TANGENT" or (color.mapping is not None and color.mapping.uv == IN_SPACE):
            self.notice(node, "candela knows normal maps in tangent space only, of images; it is left out")
        elif not color.is_constant and strength > 0:
            if node.uv_map and color.mapping.uv is None:
                color.mapping.uv = node.uv_map
            color.source = None  # Codes are vectors here, and no colours.
            texture = self.texture(color, True, scale=strength)
            self.made.values["normal_map"] = texture

    def _set_bump(self, node):
        height = gray(self.read(node, "Height"))
        scale = self.number(node, "Distance", 1.0) * self.number(node, "Strength", 1.0)
        if not height.is_constant and scale > 0:
            self.made.values["bump_map"] = self.texture(height, False, scale=-scale if node.invert else scale)

    def set_opacity(self, value):
        if value.is_constant and value.number >= 1:
            return
        value = gray(value)
        self.set("opacity", value)

    def _shade_bsdf_principled(self, node):
        values = self.made.values
        transmission = self.read(node, "Transmission Weight")
        base = self.read(node, "Base Color")
        metallic = self.read(node, "Metallic")
        self.set("metalness", metallic)
        self.set("roughness", self.read(node, "Roughness"))
        self._set_reflection(node, transmission)
        if not transmission.is_constant or transmission.number > 0:
            self.set("transmission", transmission)
            values["thin_walled"] = False
            if transmission.is_constant and transmission.number > 0.5:
                # Since Blender 4, what passes has the root of the base colour, once at each of two surfaces.
                base = Value(numpy.sqrt(numpy.maximum(base.pixels, 0)), base.mapping,
                             is_color_attribute=base.is_color_attribute)
        self.set_base_color(base)
        diffuse_roughness = self.read(node, "Diffuse Roughness")
        if diffuse_roughness is not None and not (diffuse_roughness.is_constant and diffuse_roughness.number == 0):
            self.set("diffuse_roughness", diffuse_roughness)
        self._set_layers(node)
        self._set_film(node)
        self._set_emission(self.read(node, "Emission Color"), self.read(node, "Emission Strength"), node)
        self.set_opacity(self.read(node, "Alpha"))
        self.set_normal(node)
        self._set_subsurface(node, base)
        if self.number(node, "Anisotropic") > 0:
            self.notice(node, "its anisotropy is left out")

    def _set_subsurface(self, node, base):
        """Cycles' radius is 4 pi times the mean free path, and the latter is longer by 1 / (1 - g)."""
        weight = self.number(node, "Subsurface Weight")
        if weight <= 0:
            return
        if "transmission" in self.made.values:
            self.notice(node, "its subsurface scattering is left out, since it also transmits light")
            return
        g = min(max(self.number(node, "Subsurface Anisotropy"), 0.0), 0.9)
        radius = self.read(node, "Subsurface Radius").color * self.number(node, "Subsurface Scale", 0.05)
        if not base.is_constant:
            self.notice(node, "light is scattered below the surface by the mean colour of its image")
        color = base.pixels.reshape(-1, base.pixels.shape[-1])[:, :3].mean(0)
        self.made.values["subsurface"] = {
            "weight": min(weight, 1.0), "color": numpy.clip(color, 0, 1).tolist(), "g": g,
            "radius": numpy.maximum(numpy.broadcast_to(radius, 3) * (1 - g) / (4 * math.pi), 1e-6).tolist()}

    def _set_reflection(self, node, transmission):
        """Blender's level scales the reflectance at normal incidence, by 1 at 0.5; above, the index follows it."""
        ior = self.number(node, "IOR", 1.5)
        level = self.read(node, "Specular IOR Level")
        if not level.is_constant:
            self.set("specular", Value(level.pixels * 2, level.mapping), high=1.0)
        else:
            factor = 2 * level.number
            reflectance = min(((ior - 1) / (ior + 1)) ** 2 * factor, 0.99)
            if factor == 0:
                self.made.values["specular"] = 0.0
            elif factor != 1 and transmission.is_constant and transmission.number == 0:
                ior = (1 + math.sqrt(reflectance)) / (1 - math.sqrt(reflectance))
        self.made.values["ior"] = max(ior, 1.0)
        tint = self.read(node, "Specular Tint")
        if tint is not None and not (tint.is_constant and (tint.color >= 1).all()):
            self.set("specular_color", tint, True)

    def _set_layers(self, node):
        coat = self.read(node, "Coat Weight")
        if coat is not None and not (coat.is_constant and coat.number == 0):
            self.set("coat", coat)
            self.set("coat_roughness", self.read(node, "Coat Roughness"))
            self.made.values["coat_ior"] = max(self.number(node, "Coat IOR", 1.5), 1.0)
            tint = self.read(node, "Coat Tint")
            if tint is not None and not (tint.is_constant and (tint.color >= 1).all()):
                self.notice(node, "candela has no tint of a coat; it is clear")
        sheen = self.read(node, "Sheen Weight")
        if sheen is not None and not (sheen.is_constant and sheen.number == 0):
            self.set("fuzz", sheen)
            self.set("fuzz_color", self.read(node, "Sheen Tint"), True)
            self.set("fuzz_roughness", self.read(node, "Sheen Roughness"))

    def _set_film(self, node):
        thickness = self.read(node, "Thin Film Thickness")
        if thickness is None or (thickness.is_constant and thickness.number == 0):
            return
        if not thickness.is_constant:
            self.notice(node, "candela wants a constant thickness of a film; it is left out")
            return
        self.made.values.update(iridescence=1.0, iridescence_thickness=thickness.number,
                                iridescence_ior=max(self.number(node, "Thin Film IOR", 1.33), 1.0))

    def _set_emission(self, color, strength, node):
        if not strength.is_constant:
            self.notice(node, "candela wants a constant strength of emission; the mean of its image is used")
            strength = Value(strength.pixels.mean((0, 1)))
        if strength.number <= 0:
            return
        if color.is_constant:
            radiance = numpy.maximum(color.color * strength.number, 0)
            if radiance.any():
                self.made.values["emission"] = radiance.tolist()
        else:
            self.made.values["emission"] = self.texture(color, True, factor=strength.number)

    def _shade_emission(self, node):
        self.made.values.update(_BLACK)
        self._set_emission(self.read(node, "Color"), self.read(node, "Strength"), node)

    def _shade_bsdf_diffuse(self, node):
        self.made.values["specular"] = 0.0
        self.set_base_color(self.read(node, "Color"))
        roughness = self.read(node, "Roughness")
        if not (roughness.is_constant and roughness.number == 0):
            self.set("diffuse_roughness", roughness)
        self.set_normal(node)

    def _shade_bsdf_glossy(self, node):
        self.made.values["metalness"] = 1.0
        self.set_base_color(self.read(node, "Color"))
        self.set("roughness", self.read(node, "Roughness"))
        self.set_normal(node)

    _shade_bsdf_anisotropic = _shade_bsdf_glossy

    def _shade_bsdf_glass(self, node):
        self.made.values.update(transmission=1.0, thin_walled=False, ior=max(self.number(node, "IOR", 1.5), 1.0))
        self.set_base_color(self.read(node, "Color"))
        self.set("roughness", self.read(node, "Roughness"))
        self.set_normal(node)

    def _shade_bsdf_refraction(self, node):
        self.notice(node, "candela's refraction comes with reflection, as of glass")
        self._shade_bsdf_glass(node)

    def _shade_bsdf_translucent(self, node):
        self.made.values.update(specular=0.0, diffuse_transmission=1.0)
        color = self.read(node, "Color")
        self.set_base_color(color)
        self.set("diffuse_transmission_color", color, True)

    def _shade_bsdf_transparent(self, node):
        color = self.read(node, "Color")
        self.made.values.update(_BLACK)
        if color.is_constant and (color.color >= 1).all():
            self.made.values["opacity"] = 0.0
        else:
            self.notice(node, "candela lets light of all colours pass alike")
            self.set_opacity(Value(1 - color.pixels, color.mapping))

    def _shade_bsdf_hair(self, node):
        self.notice(node, "candela has no hair; the surface is grey")
        self.made.values["base_color"] = 0.5

    def _shade_holdout(self, node):
        self.notice(node, "candela has no holdouts; the surface is black")
        self.made.values.update(_BLACK)

    def _shade_add_shader(self, node):
        kinds = [self._kind(socket) for socket in node.inputs[:2]]
        if "EMISSION" in kinds and kinds[0] != kinds[1]:
            emission = kinds.index("EMISSION")
            self.shade(node.inputs[1 - emission])
            found = self.reader.source(node.inputs[emission]).node
            self._set_emission(self.read(found, "Color"), self.read(found, "Strength"), found)
        else:
            self.notice(node, "candela adds emission to another shader only; the first is used")
            self.shade(node.inputs[0])

    def _kind(self, socket):
        groups = list(self.reader._groups)
        source = self.reader.source(socket)
        self.reader._groups = groups
        return source.node.type if source is not None and source.is_output else None

    def _shade_mix_shader(self, node):
        share = gray(self.read_socket(node.inputs[0]))
        if share.is_constant and share.number <= 0:
            self.shade(node.inputs[1])
            return
        if share.is_constant and share.number >= 1:
            self.shade(node.inputs[2])
            return
        kinds = [self._kind(socket) for socket in node.inputs[1:3]]
        if "BSDF_TRANSPARENT" in kinds and kinds[0] != kinds[1]:
            clear = kinds.index("BSDF_TRANSPARENT")
            self.shade(node.inputs[2 - clear])
            opacity = share if clear == 0 else Value(1 - share.pixels, share.mapping)
            self.set_opacity(opacity)
            return
        self._mix_constants(node, share)

    def _mix_constants(self, node, share):
        """Two shaders by the mean of their values, which is what a mixture looks like if they are alike."""
        if not share.is_constant:
            self.notice(node, "candela mixes shaders in a constant ratio only; the mean of its image is used")
            share = Value(share.pixels.mean((0, 1)))
        sides = []
        for socket in node.inputs[1:3]:
            self.made = Material()
            self.shade(socket)
            sides.append(self.made)
        first, second = sides
        self.made = first if share.number < 0.5 else second
        if not _is_mixture(first, second):
            self.notice(node, "candela does not mix these shaders; the stronger one is used")
            return
        t = share.number
        for key in {**first.values, **second.values}:
            a, b = (numpy.array(side.values.get(key, _DEFAULTS.get(key, 0.0)), float) for side in (first, second))
            mixed = a * (1 - t) + b * t
            self.made.values[key] = mixed.tolist()


# What a principled material has where nothing is said.
_DEFAULTS = {"base_color": 0.8, "metalness": 0.0, "roughness": 0.5, "ior": 1.5, "specular": 1.0, "opacity": 1.0,
             "specular_color": 1.0, "fuzz_color": 1.0, "diffuse_transmission_color": 1.0}


def _is_mixture(first, second):
    values = [*first.values.values(), *second.values.values()]
    return not any(isinstance(value, (Texture, bool)) for value in values)


def read_material(material, notices, points=None):
    """The Material of Blender's one; of None, the grey that Blender shows. points: those of a mesh, for textures in space;
    False if it has too many triangles for them."""
    if material is None:
        made = Material()
        made.values = {"base_color": 0.8, "roughness": 0.5}
        return made
    try:
        found = Notices()
        made = _read(material, found, points)
        notices.take(found)
        return made
    except NeedsPoints:
        return Material(in_space=True)


def _read(material, notices, points):
    writer = _Writer(material, notices, points)
    tree = tree_of(material)
    output = (tree.get_output_node("CYCLES") or tree.get_output_node("ALL")) if tree is not None else None
    if tree is None:
        writer.made.values.update(base_color=list(material.diffuse_color[:3]), metalness=material.metallic,
                                  roughness=material.roughness)
    elif output is None:
        writer.made.values.update(_BLACK)
    else:
        for name in ("Volume", "Displacement"):
            if output.inputs[name].is_linked:
                writer.notices.add(writer.place, f"candela does not know {name.lower()}; it is left out")
        writer.shade(output.inputs["Surface"])
    values = writer.made.values
    if writer.single_sided and "transmission" not in values:
        values["double_sided"] = False
    if "fuzz" in values and values.get("fuzz") == 0:
        del values["fuzz"]
    return writer.made

