"""Candela's materials as nodes of Cycles."""

import math

import bpy

# How Blender calls candela's encodings.
COLOR_SPACES = {"srgb": "sRGB", "linear": "Non-Color"}
TEXTURE_KEYS = {"image", "factor", "encoding", "cutoff"}
PRINCIPLED_KEYS = {"type", "base_color", "metalness", "roughness", "ior", "anisotropy", "transmission", "thin_walled"}
PRINCIPLED_KEYS |= {"subsurface", "coat", "coat_roughness", "fuzz", "fuzz_roughness", "normal_map", "opacity"}


class Graph:
    """The nodes of one material."""

    def __init__(self, name, folder):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.folder = folder  # Of the scene's file.
        self.images = {}  # Nodes by file: each is looked up once.

    def node(self, kind, *values, **settings):
        """A new node, its first inputs being `values`: sockets, constants, or None for the default."""
        node = self.tree.nodes.new("ShaderNode" + kind)
        for name, setting in settings.items():
            setattr(node, name, setting)
        for entry, value in zip(node.inputs, values):
            self.set(entry, value)
        return node

    def set(self, entry, value):
        """Gives an input a socket, a constant, or, for None, nothing."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, entry)
        elif value is not None:
            entry.default_value = value

    def beyond(self, value):
        """A constant that may exceed the range of the input that it is for."""
        node = self.node("Value")
        node.outputs[0].default_value = value
        return node.outputs[0]

    def math(self, operation, a, b):
        return self.node("Math", a, b, operation=operation).outputs[0]

    def image(self, texture, encoding):
        """The node of a texture's image."""
        unknown = set(texture) - TEXTURE_KEYS
        assert not unknown, f"cycles_materials.py knows no {unknown} of textures"
        path = str((self.folder / texture["image"]).resolve())
        if path not in self.images:
            image = bpy.data.images.load(path, check_existing=True)
            image.colorspace_settings.name = COLOR_SPACES[texture.get("encoding", encoding)]
            image.alpha_mode = "CHANNEL_PACKED"  # Colours are not multiplied by alpha.
            self.images[path] = self.node("TexImage", image=image, interpolation="Linear", extension="REPEAT")
        return self.images[path]

    def color(self, value):
        if not isinstance(value, dict):
            return (*rgb(value), 1)
        image = self.image(value, "srgb").outputs["Color"]
        if "factor" not in value:
            return image
        return self.node("MixRGB", 1, image, (*rgb(value["factor"]), 1), blend_type="MULTIPLY").outputs[0]

    def number(self, value):
        if not isinstance(value, dict):
            return value
        red = self.node("SeparateColor", self.image(value, "linear").outputs["Color"]).outputs[0]
        return self.math("MULTIPLY", red, value["factor"]) if "factor" in value else red

    def normal(self, material):
        """The normal in world space, or None where it is the surface's."""
        if "normal_map" not in material:
            return None
        image = self.image(material["normal_map"], "linear")
        return self.node("NormalMap", 1, image.outputs["Color"], space="TANGENT").outputs[0]

    def cut(self, material, surface):
        """The surface where it is opaque."""
        if "opacity" not in material:
            return surface
        opacity = material["opacity"]
        assert "cutoff" in opacity and "factor" not in opacity, "opacity must be cut off"
        absent = self.math("LESS_THAN", self.image(opacity, "srgb").outputs["Alpha"], opacity["cutoff"])
        return self.node("MixShader", absent, surface, self.node("BsdfTransparent").outputs[0]).outputs[0]

    def volume(self, material):
        """What fills a solid, or None where nothing does."""
        parts = []
        if "scattering" in material:
            given = rgb(material["scattering"]["coefficient"])
            density = max(given)
            parts.append(self.node("VolumeScatter", (*[c / density for c in given], 1), density,
                                   material["scattering"].get("g", 0)))
        if "absorption" in material:
            given = absorption(material["absorption"])
            density = max(given)
            parts.append(self.node("VolumeAbsorption", (*[1 - c / density for c in given], 1), density))
        parts = [part.outputs[0] for part in parts]
        return self.node("AddShader", *parts).outputs[0] if len(parts) == 2 else parts[0] if parts else None

    def finish(self, surface, volume=None):
        self.node("OutputMaterial", surface, volume)
        return self.material


def rgb(value):
    return value if isinstance(value, list) else [value] * 3


def absorption(value):
    """Coefficients [1/m]."""
    return [-math.log(t) / value["distance"] for t in rgb(value["transmittance"])]


def f0(ior):
    """What a surface reflects of light that falls straight on it."""
    return ((ior - 1) / (ior + 1)) ** 2


def diffuse(graph, material):
    return graph.node("BsdfDiffuse", graph.color(material["reflectance"]), 0, graph.normal(material)).outputs[0]


def diffuse_transmission(graph, material):
    assert "absorption" not in material, "Cycles' translucent node has no inside"
    normal = graph.normal(material)
    front = graph.node("BsdfDiffuse", graph.color(material["reflectance"]), 0, normal)
    back = graph.node("BsdfTranslucent", graph.color(material["transmittance"]), normal)
    return graph.node("AddShader", front.outputs[0], back.outputs[0]).outputs[0]


def interface(graph, material):
    """No surface."""


def dielectric(graph, material):
    assert material["fresnel"] == "exact", "Cycles knows Fresnel's equations alone"
    return graph.node("BsdfGlass", (1, 1, 1, 1), 0, material["ior"], distribution="GGX").outputs[0]


def conductor(graph, material):
    """GGX with Schlick's Fresnel term, but at the angle to the shading normal instead of to the facet's: Cycles' node
    has none of its own."""
    normal = graph.normal(material)
    facing = graph.node("LayerWeight", 0.5, normal).outputs["Facing"]  # 1 - cosine, where "blend" is a half.
    schlick = graph.math("POWER", facing, 5)
    color = graph.node("MixRGB", schlick, graph.color(material["reflectance"]), (1, 1, 1, 1)).outputs[0]
    alpha = graph.number(material["alpha"])
    roughness = graph.math("SQRT", alpha, None) if isinstance(material["alpha"], dict) else math.sqrt(alpha)
    node = graph.node("BsdfGlossy", color, roughness, distribution="GGX")
    graph.set(node.inputs["Normal"], normal)
    return node.outputs[0]


def inputs_of_blender_3(graph, material):
    """It says how much of the light the dielectric reflects by "Specular", how it refracts by "IOR"; its coat has a
    quarter of the weight; its sheen is another and fainter model than candela's fuzz, without a roughness."""
    return {
        "Base Color": graph.color(material.get("base_color", 0.8)),
        "Specular": graph.beyond(f0(material.get("ior", 1.5)) / 0.08),
        "Transmission": material.get("transmission", 0),
        "Clearcoat": graph.beyond(4 * material.get("coat", 0)),
        "Clearcoat Roughness": material.get("coat_roughness", 0),
        "Sheen": material.get("fuzz", 0),
        "Sheen Tint": 0,
    }


def inputs_of_blender_4(graph, material, transmission):
    """Light that passes the surface gets the root of the colour."""
    color = material.get("base_color", 0.8)
    return {
        "Base Color": graph.color([c * c for c in rgb(color)] if transmission else color),
        "Transmission Weight": transmission,
    } | subsurface(material.get("subsurface")) | {
        "Coat Weight": material.get("coat", 0),
        "Coat Roughness": material.get("coat_roughness", 0),
        "Sheen Weight": material.get("fuzz", 0),
        "Sheen Roughness": material.get("fuzz_roughness", 0.5),
    }


def subsurface(given):
    """The colour is the base's, and the radius such that the mean free path is candela's: 1 / (4 pi) of it, without g."""
    if given is None:
        return {}
    g = given.get("g", 0)
    radius = [4 * math.pi / (1 - g) * r for r in rgb(given["radius"])]
    return {
        "Base Color": (*rgb(given["color"]), 1),
        "Subsurface Weight": given.get("weight", 1),
        "Subsurface Scale": 1,
        "Subsurface Radius": radius,
        "Subsurface Anisotropy": g,
    }


def principled_node(graph, material, inputs):
    """The roughness is the geometric mean of those along and across. "MULTI_GGX" keeps the light that microfacets throw
    at each other."""
    roughness = graph.number(material.get("roughness", 0.5))
    values = {"Metallic": material.get("metalness", 0), "IOR": material.get("ior", 1.5)}
    values["Normal"] = graph.normal(material)
    if "anisotropy" in material:
        across = roughness**2
        along = across + (1 - across) * material["anisotropy"] ** 2
        assert across >= 0.1 * along, "more anisotropy than Blender's"
        values["Anisotropic"] = (1 - across / along) / 0.9
        roughness = (across * along) ** 0.25
    node = graph.node("BsdfPrincipled", distribution="MULTI_GGX")
    for name, value in (values | inputs | {"Roughness": roughness}).items():
        graph.set(node.inputs[name], value)
    return node.outputs[0]


def principled(graph, material):
    """Blender's Principled BSDF."""
    unknown = set(material) - PRINCIPLED_KEYS
    assert not unknown, f"cycles_materials.py knows no {unknown} of principled materials"
    transmission = material.get("transmission", 0)
    assert transmission == 0 or not material.get("thin_walled", True), "Blender's transmission bounds solids"
    if bpy.app.version < (4, 0):
        return principled_node(graph, material, inputs_of_blender_3(graph, material))
    parts = [t for t, fraction in ((0, 1 - transmission), (1, transmission)) if fraction > 0]
    nodes = [principled_node(graph, material, inputs_of_blender_4(graph, material, t)) for t in parts]
    return nodes[0] if len(nodes) == 1 else graph.node("MixShader", transmission, *nodes).outputs[0]


def reflecting(name, material, folder):
    """A material of a scene."""
    graph = Graph(name, folder)
    return graph.finish(graph.cut(material, MODELS[material["type"]](graph, material)), graph.volume(material))


def emitting(name, radiance, folder):
    """Light from the front side alone, and light samples there alone."""
    graph = Graph(name, folder)
    back = graph.node("NewGeometry").outputs["Backfacing"]
    graph.material.cycles.emission_sampling = "FRONT"
    return graph.finish(graph.node("Emission", graph.color(radiance), graph.math("SUBTRACT", 1, back)).outputs[0])


MODELS = {
    "diffuse": diffuse,
    "diffuse_transmission": diffuse_transmission,
    "dielectric": dielectric,
    "interface": interface,
    "conductor": conductor,
    "principled": principled,
}
