#!/usr/bin/env python3
"""Makes materials.json, a chart of what the keys of the principled material do: `python3 make_materials.py` writes it,
and its labels, squares and sky into materials/.

Equal spheres in one light, on the steps of a stair. Along each half of a step they differ in one key.
"""

import json
import math
import struct
import textwrap
import zlib
from pathlib import Path

import radiance_picture

HERE = Path(__file__).parent
FOLDER = HERE / "materials"

COPPER = [0.95, 0.6, 0.45]
GOLD = [1, 0.77, 0.34]
SILVER = [0.95, 0.93, 0.88]
RED = [0.6, 0.03, 0.03]
BLUE = [0.03, 0.12, 0.5]
TEAL = [0.03, 0.3, 0.32]
CLAY = [0.6, 0.36, 0.22]

GLASS = {"base_color": 1, "roughness": 0, "transmission": 1, "thin_walled": False}
PANE = {"base_color": 1, "roughness": 0, "transmission": 1}


def values(key, *numbers):
    """Spheres that differ by the value of one key: their labels and what each adds to the row's material."""
    return [(f"{number:g}", {key: number}) for number in numbers]


def absorption(transmittance, distance):
    return {"absorption": {"transmittance": transmittance, "distance": distance}}


# Left and right half of each step, from the top: the name of the materials, the key, the kind of material, what all
# spheres have, and in what they differ.
ROWS = [
    (
        ("metalness", "metalness", "", {"base_color": COPPER, "roughness": 0.3},
         values("metalness", 0, 0.25, 0.5, 0.75, 1)),
        ("metal_roughness", "roughness", "metal", {"base_color": GOLD, "metalness": 1},
         values("roughness", 0, 0.15, 0.3, 0.5, 1)),
    ),
    (
        ("plastic_roughness", "roughness", "plastic", {"base_color": RED},
         values("roughness", 0, 0.15, 0.3, 0.5, 1)),
        ("diffuse_roughness", "diffuse_ roughness", "matt", {"base_color": CLAY, "specular": 0},
         values("diffuse_roughness", 0, 0.25, 0.5, 0.75, 1)),
    ),
    (
        ("specular", "specular", "", {"base_color": BLUE, "roughness": 0.2},
         values("specular", 0, 0.25, 0.5, 0.75, 1)),
        ("specular_color", "specular_ color", "ior 2", {"base_color": 0.02, "roughness": 0.2, "ior": 2},
         [("white", {"specular_color": 1}), ("gold", {"specular_color": [1, 0.6, 0.15]}),
          ("red", {"specular_color": [1, 0.1, 0.1]}), ("blue", {"specular_color": [0.1, 0.25, 1]}),
          ("black", {"specular_color": 0})]),
    ),
    (
        ("ior", "ior", "plastic", {"base_color": TEAL, "roughness": 0.1},
         values("ior", 1, 1.25, 1.5, 2, 3)),
        ("iridescence", "iridescence", "metal", {"base_color": 0.7, "metalness": 1, "roughness": 0.15,
                                                 "iridescence_ior": 1.5, "iridescence_thickness": 350},
         values("iridescence", 0, 0.25, 0.5, 0.75, 1)),
    ),
    (
        ("anisotropy", "anisotropy", "metal", {"base_color": SILVER, "metalness": 1, "roughness": 0.25},
         values("anisotropy", 0, 0.25, 0.5, 0.75, 1)),
        ("anisotropy_rotation", "anisotropy_ rotation", "anisotropy 0.8",
         {"base_color": SILVER, "metalness": 1, "roughness": 0.25, "anisotropy": 0.8},
         values("anisotropy_rotation", 0, 30, 60, 90, 135)),
    ),
    (
        ("coat", "coat", "on metal", {"base_color": RED, "metalness": 1, "roughness": 0.5},
         values("coat", 0, 0.25, 0.5, 0.75, 1)),
        ("coat_roughness", "coat_ roughness", "on metal",
         {"base_color": RED, "metalness": 1, "roughness": 0.5, "coat": 1},
         values("coat_roughness", 0, 0.15, 0.3, 0.5, 1)),
    ),
    (
        ("coat_darkening", "coat_ darkening", "matt", {"base_color": CLAY, "roughness": 0.8, "coat": 1},
         values("coat_darkening", 0, 0.25, 0.5, 0.75, 1)),
        ("coat_ior", "coat_ior", "matt", {"base_color": CLAY, "roughness": 0.8, "coat": 1, "coat_darkening": 1},
         values("coat_ior", 1.2, 1.35, 1.5, 1.8, 2.5)),
    ),
    (
        ("sheen_color", "sheen_color", "cloth", {"base_color": 0.03, "roughness": 1, "sheen_roughness": 0.4},
         [("black", {"sheen_color": 0}), ("grey", {"sheen_color": 0.3}), ("white", {"sheen_color": 1}),
          ("red", {"sheen_color": [0.9, 0.1, 0.15]}), ("blue", {"sheen_color": [0.1, 0.25, 0.9]})]),
        ("sheen_roughness", "sheen_ roughness", "cloth", {"base_color": [0.25, 0.02, 0.08], "roughness": 1,
                                                          "sheen_color": [0.9, 0.5, 0.6]},
         values("sheen_roughness", 0.1, 0.25, 0.5, 0.75, 1)),
    ),
    (
        ("metal_film", "iridescence_ thickness", "metal",
         {"base_color": 0.7, "metalness": 1, "roughness": 0.15, "iridescence": 1, "iridescence_ior": 1.5},
         values("iridescence_thickness", 150, 250, 350, 500, 800)),
        ("plastic_film", "iridescence_ thickness", "plastic",
         {"base_color": 0.02, "roughness": 0.15, "iridescence": 1, "iridescence_ior": 1.8},
         values("iridescence_thickness", 150, 250, 350, 500, 800)),
    ),
    (
        ("transmission", "transmission", "solid", {**GLASS, "base_color": [0.3, 0.75, 0.75]},
         values("transmission", 0, 0.25, 0.5, 0.75, 1)),
        ("glass_roughness", "roughness", "solid", {**GLASS, **absorption([0.7, 0.9, 0.85], 1)},
         values("roughness", 0, 0.1, 0.2, 0.35, 0.6)),
    ),
    (
        ("transmittance", "absorption. transmittance", "solid", GLASS,
         [("white", absorption(1, 1)), ("green", absorption([0.3, 0.8, 0.4], 1)),
          ("amber", absorption([0.9, 0.45, 0.05], 1)), ("ruby", absorption([0.7, 0.02, 0.03], 1)),
          ("smoke", absorption(0.15, 1))]),
        ("dispersion", "dispersion", "solid", {**GLASS, "ior": 1.7},
         values("dispersion", 0, 0.5, 1, 3, 10)),
    ),
    (
        ("pane_roughness", "roughness", "thin wall", {**PANE, "base_color": [0.7, 0.9, 0.85]},
         values("roughness", 0, 0.1, 0.2, 0.35, 0.6)),
        ("diffuse_transmission", "diffuse_ transmission", "thin wall",
         {"base_color": [0.75, 0.75, 0.7], "diffuse_transmission_color": [0.9, 0.55, 0.2]},
         values("diffuse_transmission", 0, 0.25, 0.5, 0.75, 1)),
    ),
]
CHECKERED = 3  # So many of the last steps have squares, which show what passes through the spheres.

# The stair [m]: the front edge of the lowest step is at z = 0.
WIDTH = 16.0  # Of both halves.
FRAME = 0.3  # What the camera sees to the left and right of them.
DEPTH, RISE = 1.42, 0.7
RADIUS = 0.48
SPHERE_Z = 0.9  # Of the centres, from the front edge of their step.
LABELS = 2.1  # Width of the column of keys.
PITCH = 1.16
MARGIN = 0.1  # Left of the keys.
SQUARE = PITCH / 8
SQUARES = 40  # In a row.
GREY = 0.36

HEIGHT = 64  # Of the sky's image, in pixels.
LAMP_SIZE, LAMP_DISTANCE = 30, 45  # The lamp's radiance is in W/(m^2 sr).
LAMP_RADIANCE = 4.6

ELEVATION = math.radians(28)  # Of the camera.
DISTANCE = 300.0
PIXELS = 72  # Per metre.

# Letters, five or fewer dots wide; x marks ink. The lowest two rows are below the line.
GLYPHS = "abcdefghi jklmnopqr stuvwxyz_. 0123456789".split()
INK = """
..... x.... ..... ....x ..... ..xx ..... x.... x
..... x.... ..... ....x ..... .x.. ..... x.... .
.xxx. xxxx. .xxxx .xxxx .xxx. xxxx .xxxx xxxx. x
....x x...x x.... x...x x...x .x.. x...x x...x x
.xxxx x...x x.... x...x xxxxx .x.. x...x x...x x
x...x x...x x.... x...x x.... .x.. x...x x...x x
.xxxx xxxx. .xxxx .xxxx .xxxx .x.. .xxxx x...x x
..... ..... ..... ..... ..... .... ....x ..... .
..... ..... ..... ..... ..... .... .xxx. ..... .

..x x... x. ..... ..... ..... ..... ..... ....
... x... x. ..... ..... ..... ..... ..... ....
..x x..x x. xxxx. xxxx. .xxx. xxxx. .xxxx x.xx
..x x.x. x. x.x.x x...x x...x x...x x...x xx..
..x xx.. x. x.x.x x...x x...x x...x x...x x...
..x x.x. x. x.x.x x...x x...x x...x x...x x...
..x x..x .x x.x.x x...x .xxx. xxxx. .xxxx x...
x.x .... .. ..... ..... ..... x.... ....x ....
.x. .... .. ..... ..... ..... x.... ....x ....

..... .x.. ..... ..... ..... ..... ..... ..... ..... .
..... .x.. ..... ..... ..... ..... ..... ..... ..... .
.xxxx xxxx x...x x...x x.x.x x...x x...x xxxxx ..... .
x.... .x.. x...x x...x x.x.x .x.x. x...x ...x. ..... .
.xxx. .x.. x...x x...x x.x.x ..x.. x...x ..x.. ..... .
....x .x.. x...x .x.x. x.x.x .x.x. x...x .x... ..... .
xxxx. .xxx .xxxx ..x.. .x.x. x...x .xxxx xxxxx ..... x
..... .... ..... ..... ..... ..... ....x ..... xxxxx .
..... .... ..... ..... ..... ..... .xxx. ..... ..... .

.xxx. .x. .xxx. xxxx. ...x. xxxxx .xxx. xxxxx .xxx. .xxx.
x...x xx. x...x ....x ..xx. x.... x.... ....x x...x x...x
x...x .x. ....x ....x .x.x. x.... x.... ...x. x...x x...x
x...x .x. ...x. .xxx. x..x. xxxx. xxxx. ..x.. .xxx. .xxxx
x...x .x. ..x.. ....x xxxxx ....x x...x .x... x...x ....x
x...x .x. .x... ....x ...x. ....x x...x .x... x...x ....x
.xxx. xxx xxxxx xxxx. ...x. xxxx. .xxx. .x... .xxx. .xxx.
..... ... ..... ..... ..... ..... ..... ..... ..... .....
..... ... ..... ..... ..... ..... ..... ..... ..... .....
"""
LINE = 9  # Rows of dots.
DOT = WIDTH / 600  # About two pixels.


def font():
    """The rows of each letter, from the top; true is ink."""
    letters = {" ": [[False] * 2] * LINE}
    for names, block in zip(GLYPHS, INK.strip().split("\n\n")):
        for name, rows in zip(names, zip(*(row.split() for row in block.splitlines()))):
            letters[name] = [[dot == "x" for dot in row] for row in rows]
    return letters


def dots(text, letters):
    """A line of text as rows of dots, with one empty dot between letters."""
    return [sum((letters[letter][row] + [False] for letter in text), [])[:-1] for row in range(LINE)]


class Sheet:
    """The image with all labels: for each step a strip for its riser, with the keys, and one for its tread."""

    TREAD, RISER = LINE + 1, 2 * LINE + 3

    def __init__(self):
        self.letters = font()
        self.width = round(WIDTH / DOT)
        self.rows = [[False] * self.width for _ in range((self.TREAD + self.RISER) * len(ROWS))]

    def write(self, text, x, row, centred=False):
        """Writes text at x [m] from the left of the stair, its top in this row."""
        line = dots(text, self.letters)
        first = round(x / DOT - (len(line[0]) / 2 if centred else 0))
        for r, inked in enumerate(line):
            for c, ink in enumerate(inked):
                self.rows[row + r][first + c] |= ink

    def riser(self, step):
        """The first row of a riser's strip, and the row after its last."""
        top = step * (self.TREAD + self.RISER)
        return top, top + self.RISER

    def tread(self, step):
        top = self.riser(step)[1]
        return top, top + self.TREAD


def write_png(path, rows):
    """Writes rows of booleans, a multiple of eight in each, as black where they are true and white elsewhere."""
    packed = b""
    for row in rows:
        bits = "".join("0" if ink else "1" for ink in row)
        packed += b"\0" + int(bits, 2).to_bytes(len(bits) // 8, "big")
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 1, 0, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n"
    for kind, body in ((b"IHDR", header), (b"IDAT", zlib.compress(packed, 9)), (b"IEND", b"")):
        data += struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    path.write_bytes(data)


def half_left(half):
    """The left edge of a half of the stair, from its left [m]."""
    return half * WIDTH / 2


def sphere_x(half, column):
    return half_left(half) + LABELS + PITCH * (column + 0.5)


def write_labels():
    sheet = Sheet()
    for step, row in enumerate(ROWS):
        for half, (_, key, kind, _, spheres) in enumerate(row):
            lines = key.split()
            top = sheet.riser(step)[1] - len(lines) * (LINE + 1)
            for i, line in enumerate(lines):
                sheet.write(line, half_left(half) + MARGIN, top + i * (LINE + 1))
            sheet.write(kind, half_left(half) + MARGIN, sheet.tread(step)[0])
            for column, (label, _) in enumerate(spheres):
                sheet.write(label, sphere_x(half, column), sheet.tread(step)[0], centred=True)
    write_png(FOLDER / "labels.png", sheet.rows)
    return sheet


def write_squares():
    """Two by two squares, of four pixels each."""
    write_png(FOLDER / "squares.png", [[(x // 4 + y // 4) % 2 == 0 for x in range(8)] for y in range(8)])


def numbers(points):
    return [[round(x, 6) for x in point] for point in points]


def quad(corners, material):
    return {"type": "quad", "vertices": numbers(corners), "material": material}


def flat(left, right, z, y0, y1):
    """The corners of an upright rectangle that faces the camera."""
    return [(left, y0, z), (right, y0, z), (right, y1, z), (left, y1, z)]


def level(left, right, y, z0, z1):
    """The corners of a horizontal rectangle that faces up."""
    return [(left, y, z0), (right, y, z0), (right, y, z1), (left, y, z1)]


class Mesh:
    """Rectangles with texture coordinates, given by two opposite corners of their image."""

    def __init__(self, material):
        self.shape = {"type": "mesh", "material": material, "positions": [], "uvs": [], "triangles": []}

    def add(self, corners, u, v):
        base = len(self.shape["positions"])
        self.shape["positions"] += numbers(corners)
        self.shape["uvs"] += numbers([(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])])
        self.shape["triangles"] += [[base, base + 1, base + 2], [base, base + 2, base + 3]]


def front_edge(row):
    """Height and depth of the front edge of the step of a row, counted from the top."""
    step = len(ROWS) - 1 - row
    return step * RISE, -step * DEPTH


def label_mesh(sheet):
    """Two rectangles for each step, just before its riser and just above its tread, also above the squares."""
    mesh = Mesh("labels")
    left, right, above = -WIDTH / 2, WIDTH / 2, 0.001
    riser_height, tread_depth = sheet.RISER * DOT / math.cos(ELEVATION), sheet.TREAD * DOT / math.sin(ELEVATION)
    for row in range(len(ROWS)):
        y, z = front_edge(row)
        v = [[1 - r / len(sheet.rows) for r in reversed(strip)] for strip in (sheet.riser(row), sheet.tread(row))]
        mesh.add(flat(left, right, z - DEPTH + above, y + 0.03, y + 0.03 + riser_height), (0, 1), v[0])
        mesh.add(level(left, right, y + above, z - 0.05, z - 0.05 - tread_depth), (0, 1), v[1])
    return mesh.shape


def stair():
    """Treads and risers, wider than what the camera sees, with a wall above and a floor in front."""
    side = WIDTH
    shapes = [quad(level(-side, side, 0, 12, 0), "grey")]
    for step in range(len(ROWS)):
        y, z = step * RISE, -step * DEPTH
        last = step == len(ROWS) - 1
        shapes.append(quad(level(-side, side, y, z, z - DEPTH), "grey"))
        shapes.append(quad(flat(-side, side, z - DEPTH, y, y + (3 if last else 1) * RISE), "grey"))
    top = len(ROWS) * RISE
    shapes.append(quad(level(-side, side, top + 2 * RISE, -len(ROWS) * DEPTH, -len(ROWS) * DEPTH - 12), "grey"))
    return shapes


def square_mesh():
    """Squares behind and below the spheres of the last steps."""
    mesh = Mesh("squares")
    for row in range(len(ROWS) - CHECKERED, len(ROWS)):
        y, z = front_edge(row)
        for half in range(2):
            left = half_left(half) + LABELS - WIDTH / 2
            width, deep, high = SQUARES * SQUARE, 6 * SQUARE, RISE
            right, near = left + width, z - DEPTH + deep
            u = (0, SQUARES / 2)
            mesh.add(level(left, right, y + 0.0005, near, z - DEPTH), u, (0, 3))
            mesh.add(flat(left, right, z - DEPTH + 0.002, y, y + high), u, (3, 3 + high / SQUARE / 2))
    return mesh.shape


def unit(v):
    return [x / math.hypot(*v) for x in v]


def radiance(direction):
    """Of the sky: a bright band on the right, light grey above and in front, dark behind and below."""
    x, y, z = direction
    grey = 0.55 + 0.35 * y + 0.15 * z
    grey = grey * (0.25 + 0.75 / (1 + math.exp(-y / 0.06)))
    azimuth = math.atan2(z, x)
    band = math.exp(-0.5 * ((azimuth - 0.25) / 0.22) ** 2) * math.exp(-0.5 * ((y - 0.45) / 0.28) ** 2)
    return [grey + 2.2 * band] * 3


def encoded_row(row):
    """Of the sky, from the top."""
    elevation = math.pi * (0.5 - (row + 0.5) / HEIGHT)
    across, y = math.cos(elevation), math.sin(elevation)
    azimuths = [math.pi * ((column + 0.5) / HEIGHT - 1) for column in range(2 * HEIGHT)]  # From -Z towards +X.
    return radiance_picture.encoded_row([radiance((across * math.sin(a), y, -across * math.cos(a))) for a in azimuths])


def header():
    return radiance_picture.header("make_materials.py", 2 * HEIGHT, HEIGHT)


def write_sky():
    (FOLDER / "studio.hdr").write_bytes(header() + b"".join(encoded_row(row) for row in range(HEIGHT)))


def lamp(middle):
    """A square lamp, up on the left, which faces the middle of the stair."""
    n = unit([-0.45, 0.78, 0.44])
    right = unit([n[2], 0, -n[0]])
    up = [n[1] * right[2] - n[2] * right[1], n[2] * right[0] - n[0] * right[2], n[0] * right[1] - n[1] * right[0]]
    corners = []
    for s, t in ((-1, -1), (-1, 1), (1, 1), (1, -1)):
        across = [LAMP_SIZE / 2 * (s * r + t * u) for r, u in zip(right, up)]
        corners.append([m + LAMP_DISTANCE * a + c for m, a, c in zip(middle, n, across)])
    return {"type": "quad", "vertices": numbers(corners), "emission": LAMP_RADIANCE}


def camera():
    """The camera, which looks at the middle of the stair, and how high what it sees is."""
    steps = len(ROWS)
    middle = [0, steps * RISE / 2, -steps * DEPTH / 2]
    position = [0, middle[1] + DISTANCE * math.sin(ELEVATION), middle[2] + DISTANCE * math.cos(ELEVATION)]
    seen = steps * (RISE * math.cos(ELEVATION) + DEPTH * math.sin(ELEVATION)) + FRAME
    fov = round(math.degrees(2 * math.atan(seen / 2 / DISTANCE)), 4)
    return {"position": numbers([position])[0], "look_at": numbers([middle])[0], "vertical_fov": fov}, seen


def spheres():
    """The materials of the spheres, by name, and the spheres."""
    materials, shapes = {}, []
    for row, halves in enumerate(ROWS):
        y, z = front_edge(row)
        for half, (name, _, _, common, differences) in enumerate(halves):
            for column, (label, own) in enumerate(differences):
                material = f"{name}_{label}"
                assert material not in materials
                materials[material] = {"type": "principled", **common, **own}
                centre = (sphere_x(half, column) - WIDTH / 2, y + RADIUS + 0.001, z - SPHERE_Z)
                shape = {"type": "sphere", "center": numbers([centre])[0], "radius": RADIUS, "material": material}
                shapes.append(shape)
    return materials, shapes


def scene(sheet):
    view, seen = camera()
    materials, balls = spheres()
    labels = {"image": "materials/labels.png", "factor": GREY, "filter": "nearest"}
    squares = {"image": "materials/squares.png", "factor": 0.7, "filter": "nearest"}
    return {
        "$schema": "scene.schema.json",
        "cameras": {"main": view},
        "film": {"size": [round((WIDTH + 2 * FRAME) * PIXELS), round(seen * PIXELS)]},
        "integrator": {"spp": 256},
        "environment": {"file": "materials/studio.hdr"},
        "materials": {
            "grey": {"type": "diffuse", "reflectance": GREY},
            "labels": {"type": "diffuse", "reflectance": labels},
            "squares": {"type": "diffuse", "reflectance": squares},
            **materials,
        },
        "shapes": [*stair(), label_mesh(sheet), square_mesh(), lamp(view["look_at"]), *balls],
    }


LINE_LENGTH = 120


def lines(value, indent=0, before=""):
    """JSON that breaks lines only where they would be too long."""
    one_line = " " * indent + before + json.dumps(value).replace("{", "{ ").replace("}", " }")
    if len(one_line) < LINE_LENGTH or not isinstance(value, (dict, list)):
        return one_line
    inner = indent + 4
    if isinstance(value, dict):
        parts = [lines(item, inner, f"{json.dumps(key)}: ") for key, item in value.items()]
    elif isinstance(value[0], dict):
        parts = [lines(item, inner) for item in value]
    else:
        parts = textwrap.wrap(" ".join(json.dumps(item).replace(" ", "") + "," for item in value), LINE_LENGTH - inner)
        text = "\n".join(" " * inner + part for part in parts).rstrip(",")
        return f"{' ' * indent}{before}[\n{text}\n{' ' * indent}]"
    opened, closed = "{}" if isinstance(value, dict) else "[]"
    return " " * indent + before + opened + "\n" + ",\n".join(parts) + "\n" + " " * indent + closed


COMMENT = """\
// What the keys of the principled material do, side by side in one light: along each half of a step, the spheres differ
// in one key. Copy a material from here, and change it from there. make_materials.py made this file.
"""


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    write_sky()
    write_squares()
    (HERE / "materials.json").write_text(COMMENT + lines(scene(write_labels())) + "\n", encoding="utf-8")
