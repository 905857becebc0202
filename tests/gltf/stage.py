"""What all models share: a camera under which pixels have exact places, a backdrop with labels, and claims.

The view of the first camera is SIZE pixels, orthographic, from +Z; 64 pixels are a metre. Rectangles are
(left, top, right, bottom) in these pixels; at a multiple of the size they grow alike.

make() returns a model's claims, one dict for each rendering:

    model, file, claim    the file relative to the folder
    size                  pixels of the picture in which the rectangles are
    arguments             further arguments of `candela render`
    spp                   samples per pixel that suffice for the tolerance
    tolerance             in 8-bit codes of sRGB, for means over blocks of 4 by 4 pixels
    equal                 pairs of rectangles: no block differs by more than the tolerance
    differ                pairs of rectangles: some block differs by more than four times the tolerance
    shown                 rectangles of which some block differs from the backdrop's colour by more than four times
                          the tolerance
    colours               rectangles whose blocks must have this colour (codes), within the tolerance
"""

import math
import sys
from pathlib import Path

import matrices
import png
import shapes
from gltf_file import CLAMP, GltfFile, NEAREST

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scenes"))
from make_materials import LINE, dots, font  # noqa: E402

SIZE = (320, 240)
METRE = 64.0  # In pixels.
DARK, GREY, INK = (44, 46, 52), (128, 128, 128), (214, 214, 208)
LETTERS = font()
MARKS = {  # Eight by eight dots.
    True: ".......x ......xx .....xx. x...xx.. xx.xx... .xxx.... ..x..... ........",
    False: "x.....x. .x...x.. ..x.x... ...x.... ..x.x... .x...x.. x.....x. ........",
}
# Columns, rows and the side of a tile, for so many pairs of tiles.
GRIDS = ((2, 3, 56), (3, 4, 40), (4, 5, 32))
KINDS = ("equal", "differ", "colours", "shown")  # Of claims about rectangles.
MODELS = {}  # By name: what makes it, and the containers in which it is written.


def model(name, containers=("glTF-Binary",)):
    """Registers a function that fills a stage; what its docstring says is the claim."""
    def register(function):
        MODELS[name] = (function, containers)
        return function
    return register


def encoded(linear):
    """The sRGB code from 0 to 255 of a linear value."""
    c = min(max(linear, 0.0), 1.0)
    return round(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055))


def decoded(code):
    c = code / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def linear(codes):
    return [decoded(code) for code in codes]


def codes(colour):
    return tuple(encoded(c) for c in colour)


class Canvas:
    """A picture of codes to paint on: the backdrop, and textures."""

    def __init__(self, width, height, colour, channels=3):
        self.width, self.height, self.channels = width, height, channels
        self.pixels = bytearray(bytes(colour) * (width * height))

    def fill(self, rect, colour):
        x0, y0, x1, y1 = (int(round(c)) for c in rect)
        x0, y0, x1, y1 = max(x0, 0), max(y0, 0), min(x1, self.width), min(y1, self.height)
        for y in range(y0, y1):
            start = (y * self.width + x0) * self.channels
            self.pixels[start:start + max(x1 - x0, 0) * self.channels] = bytes(colour) * max(x1 - x0, 0)

    def bits(self, x, y, rows, colour, dot=1):
        for j, row in enumerate(rows):
            for i, ink in enumerate(row):
                if ink is True or ink == "x":
                    self.fill((x + i * dot, y + j * dot, x + (i + 1) * dot, y + (j + 1) * dot), colour)

    def text(self, x, y, text, colour=INK, centred=False):
        rows = dots(text, LETTERS)
        self.bits(round(x - len(rows[0]) / 2) if centred else x, y, rows, colour)

    def mark(self, rect, good):
        """A tick or a cross that fills a square."""
        dot = (rect[2] - rect[0]) // 8
        self.bits(rect[0], rect[1], MARKS[good].split(), (60, 200, 80) if good else (230, 60, 50), dot)

    def png(self):
        return png.write(self.width, self.height, self.channels, self.pixels)


def picture(width, height, function, channels=3):
    """A PNG file of function(column, row), whose values are codes."""
    pixels = bytearray()
    for row in range(height):
        for column in range(width):
            pixels += bytes(function(column, row))
    return png.write(width, height, channels, pixels)


def solid(*codes):
    """A PNG file of one pixel."""
    return png.write(1, 1, len(codes), bytes(codes))


F = "........ .xxxxx.. .x...... .xxxx... .x...... .x...... .x...... ........".split()


def chart_colour(column, row):
    """Eight by eight pixels that no turn and no mirror leaves as they are: F on blue, with a corner of each colour."""
    corners = {(0, 0): (255, 80, 60), (7, 0): (60, 220, 90), (0, 7): (255, 220, 60), (7, 7): (240, 120, 240)}
    return corners.get((column, row), (235, 235, 235) if F[row][column] == "x" else (40, 90, 170))


def chart():
    return picture(8, 8, chart_colour)


def inset(rect, by=1):
    """Whole pixels within a rectangle, so far from its edges."""
    return [math.ceil(rect[0]) + by, math.ceil(rect[1]) + by, math.floor(rect[2]) - by, math.floor(rect[3]) - by]


class Stage:
    def __init__(self, name):
        self.name, self.file = name, GltfFile()
        self.canvas = Canvas(*SIZE, DARK)
        self.canvas.text(4, 2, "".join(c if c in LETTERS else " " for c in name.lower()), GREY)
        self.backdrop_z = -1.0
        self.backdrop_lit = False  # Readers take surfaces that glow as the light of a scene.
        self.checks = []
        self.check()

    # --- Claims -----------------------------------------------------------------------------------------------------

    def check(self, *arguments, tolerance=2, spp=16):
        """Begins a rendering with arguments of its own, of which further claims speak."""
        if self.checks and not any(self.checks[-1][kind] for kind in KINDS):
            self.checks.pop()
        self.checks.append({"arguments": list(arguments), "spp": spp, "tolerance": tolerance,
                            **{kind: [] for kind in KINDS}})

    def tolerate(self, tolerance, spp):
        self.checks[-1].update(tolerance=tolerance, spp=spp)

    def flat_terminator(self):
        """Lets light end as the tiles themselves face it. Otherwise, flat tiles with bent normals at their vertices are
        lit as the curved surface that the normals describe, unlike flat tiles with a normal map, and with more noise.
        """
        self.checks[-1]["arguments"] += ["--terminator", "flat"]

    def equal(self, a, b, by=1):
        self.checks[-1]["equal"].append([inset(a, by), inset(b, by)])

    def differ(self, a, b, by=1):
        self.checks[-1]["differ"].append([inset(a, by), inset(b, by)])

    def shown(self, rect, by=1):
        """Claims that there is something besides the backdrop."""
        self.checks[-1]["shown"].append(inset(rect, by))

    def expect(self, rect, colour, by=1):
        """Claims that a rectangle has a colour all over."""
        self.checks[-1]["colours"].append([inset(rect, by), list(colour)])

    # --- Places -----------------------------------------------------------------------------------------------------

    def corners(self, rect):
        """The x and y [m] of a rectangle's left, lower, right and upper edges."""
        x, y = SIZE[0] / 2, SIZE[1] / 2
        return (rect[0] - x) / METRE, (y - rect[3]) / METRE, (rect[2] - x) / METRE, (y - rect[1]) / METRE

    def centre(self, rect):
        x0, y0, x1, y1 = self.corners(rect)
        return (x0 + x1) / 2, (y0 + y1) / 2

    def grid(self, columns, rows, width, height, top=14):
        """Rectangles in rows from the top, each with room for a label below it."""
        across, down = SIZE[0] / columns, (SIZE[1] - top) / rows
        assert width <= across and height + LINE + 2 <= down, (self.name, across, down)
        return [[int(c) for c in (i * across + (across - width) / 2, top + j * down,
                                  i * across + (across - width) / 2 + width, top + j * down + height)]
                for j in range(rows) for i in range(columns)]

    def label(self, rect, text):
        self.canvas.text((rect[0] + rect[2]) / 2, rect[3] + 2, text, centred=True)

    def pairs(self, cases, equal=True):
        """For each case, whose first item is its label: two squares that must look alike, and its other items."""
        columns, rows, side = next(g for g in GRIDS if g[0] * g[1] >= len(cases))
        for rect, (label, *case) in zip(self.grid(columns, rows, 2 * side + 2, side), cases):
            left, right = [rect[0], rect[1], rect[0] + side, rect[3]], [rect[2] - side, rect[1], rect[2], rect[3]]
            self.label(rect, label)
            if equal:
                self.equal(left, right)
                self.shown(left)
            yield left, right, *case

    # --- Things -----------------------------------------------------------------------------------------------------

    def sheet(self, rect, z=0, **functions):
        x0, y0, x1, y1 = self.corners(rect)
        return shapes.sheet(x0, y0, x1, y1, z, **functions)

    def put(self, mesh, material, parent=None, **node):
        """A node with a mesh of one primitive."""
        primitive = self.file.primitive(mesh.attributes(), mesh.indices, material)
        return self.file.node(parent, mesh=self.file.mesh(primitive), **node)

    def tile(self, rect, material, z=0, **functions):
        return self.put(self.sheet(rect, z, **functions), material)

    def unlit(self, colour=(1, 1, 1), texture=None, alpha=1, **properties):
        """A material that shows a linear colour, or a texture times it, in any light."""
        base = {"baseColorFactor": [*colour, alpha], "metallicFactor": 0}
        if texture is not None:
            base["baseColorTexture"] = texture if isinstance(texture, dict) else {"index": texture}
        return self.file.material({"unlit": {}}, pbrMetallicRoughness=base, **properties)

    def surface(self, colour=(0.8, 0.8, 0.8), metallic=0, roughness=1, extensions=None, base=None, **properties):
        """A lit material; `base` are further keys of pbrMetallicRoughness."""
        return self.file.material(extensions, pbrMetallicRoughness={
            "baseColorFactor": [*colour, 1], "metallicFactor": metallic, "roughnessFactor": roughness, **(base or {})},
            **properties)

    def sun(self, direction=(-0.4, 0.5, 0.77), lux=math.pi, colour=(1, 1, 1), parent=None):
        """A directional light that comes from a direction; a white, matt sheet that faces it has the radiance 1."""
        light = self.file.light(type="directional", intensity=lux, color=list(colour))
        self.file.node(parent, rotation=matrices.towards([-c for c in direction]), extensions=light)

    def finish(self):
        """Adds the backdrop and the camera, which is the first one."""
        texture = self.file.texture(self.canvas.png(), NEAREST, (CLAMP, CLAMP))
        matt = {"extensions": {"specular": {"specularFactor": 0}}, "base": {"baseColorTexture": {"index": texture}}}
        material = self.surface((1, 1, 1), **matt) if self.backdrop_lit else self.unlit(texture=texture)
        self.tile((0, 0, *SIZE), material, self.backdrop_z)
        camera = {"type": "orthographic", "name": "front", "orthographic": {
            "xmag": SIZE[0] / 2 / METRE, "ymag": SIZE[1] / 2 / METRE, "znear": 0.1, "zfar": 1000}}
        self.file.json.setdefault("cameras", []).insert(0, camera)
        for node in self.file.json["nodes"]:
            if "camera" in node:
                node["camera"] += 1
        self.file.node(name="front", camera=0, translation=[0, 0, 20])
        nodes = self.file.scene_nodes()
        nodes.insert(0, nodes.pop())


def make(name, folder):
    """Writes a model, and returns its claims."""
    function, containers = MODELS[name]
    stage = Stage(name)
    function(stage)
    stage.finish()
    stage.file.write(folder / "Models" / name, containers)
    stage.check()
    checks = stage.checks[:-1] or stage.checks
    extension = ".glb" if containers[0] == "glTF-Binary" else ".gltf"
    claim = {"model": name, "file": f"Models/{name}/{containers[0]}/{name}{extension}",
             "claim": " ".join(function.__doc__.split()), "size": list(SIZE)}
    return [{**claim, **check} for check in checks]
