"""Models of spheres side by side: metals, plastics, coats, cloth, thin films, glass.

Spheres stand one behind the other, so that an orthographic camera sees them side by side, and none reflects another.
Their files have no light: a reader shows them in surroundings of its own.
"""

import shapes
from gltf_file import INDICES
from models_normals import bump_map
from stage import METRE, decoded, model, solid

APART = 6.0  # Metres from one sphere to the next one.
CODES = (0, 64, 128, 191, 255)
GOLD, RED, TEAL, BLACK = (0.6, 0.44, 0.17), (0.3, 0.02, 0.02), (0.02, 0.12, 0.13), (0.02,) * 3


def fraction(code):
    return code / 255


class Balls:
    """Spheres at the cells of a grid, one mesh for all."""

    def __init__(self, stage, columns, rows, deep=True, size=0.88):
        self.stage = stage
        width, height = 320 // columns, (240 - 14) // rows - 11
        self.diameter = int(min(width, height) * size)
        self.cells = stage.grid(columns, rows, self.diameter, self.diameter)
        mesh = shapes.sphere(self.diameter / 2 / METRE)
        attributes = stage.file.attributes(mesh.attributes())
        self.primitive = {"attributes": attributes, "indices": stage.file.accessor(mesh.indices, "u16", target=INDICES)}
        self.deep = deep
        self.count = 0
        if deep:
            stage.backdrop_z, stage.backdrop_lit = -250.0, True

    def put(self, label, material):
        """The next sphere; its cell."""
        rect = self.cells[self.count]
        x, y = self.stage.centre(rect)
        z = -APART * self.count if self.deep else 0
        self.stage.label(rect, label)
        mesh = self.stage.file.mesh({**self.primitive, "material": material})
        self.stage.file.node(mesh=mesh, translation=[x, y, z])
        self.count += 1
        return rect

    def rows(self, *rows):
        """Rows of (label, material); their rectangles."""
        return [[self.put(label, material) for label, material in row] for row in rows]


def alike(stage, rows, *pairs):
    """Claims that the spheres of two rows look alike, for each pair of rows."""
    for a, b in pairs:
        for one, other in zip(rows[a], rows[b]):
            stage.equal(one, other, 0)


def grey(stage, *codes):
    return {"index": stage.file.texture(solid(*codes))}


@model("MetalRoughSpheres")
def metal_rough_spheres(stage):
    """Roughness grows from left to right, from a mirror to matt. The upper two rows are metal, the lower two plastic;
    the first of both has its values from factors, the second, which looks alike, from the green and blue of images,
    whose red says nothing."""
    balls = Balls(stage, 5, 4)
    rows = []
    for metallic, colour in ((255, GOLD), (0, TEAL)):
        rows.append([(f"{fraction(code):.2f}", stage.surface(colour, fraction(metallic), fraction(code))) for code in CODES])
        rows.append([("image", stage.surface(colour, 1, 1, base={"metallicRoughnessTexture": grey(
            stage, 37, code, metallic)})) for code in CODES])
    rects = balls.rows(*rows)
    alike(stage, rects, (0, 1), (2, 3))
    stage.differ(rects[0][0], rects[0][4], 4)
    stage.differ(rects[0][2], rects[2][2], 4)
    stage.tolerate(10, 256)


@model("ClearCoatTest")
def clear_coat_test(stage):
    """A coat mirrors the studio on a matt, red base: more with its weight (the upper two rows), sharper with less
    roughness (the lower two). The second row of both has its values from the red or the green of an image and looks
    like the first one; a weight of 0 looks like no coat."""
    balls = Balls(stage, 5, 4)

    def coat(**values):
        return stage.surface(RED, 0, 0.9, {"clearcoat": values} if values else None)

    rows = [[(f"{fraction(c):.2f}", coat(clearcoatFactor=fraction(c)) if c else coat()) for c in CODES],
            [("image", coat(clearcoatFactor=1, clearcoatTexture=grey(stage, c, 90, 50))) for c in CODES],
            [(f"{fraction(c):.2f}", coat(clearcoatFactor=1, clearcoatRoughnessFactor=fraction(c))) for c in CODES],
            [("image", coat(clearcoatFactor=1, clearcoatRoughnessFactor=1,
                            clearcoatRoughnessTexture=grey(stage, 90, c, 50))) for c in CODES]]
    rects = balls.rows(*rows)
    alike(stage, rects, (0, 1), (2, 3))
    stage.differ(rects[0][0], rects[0][4], 4)
    stage.differ(rects[2][0], rects[2][4], 4)
    stage.tolerate(10, 256)


@model("CompareClearcoat")
def compare_clearcoat(stage):
    """Normal maps of base and coat are different things. From the upper left: rough gold; the same under a smooth coat;
    with a normal map of the base, whose coat stays smooth; with a normal map of the coat alone; with one map for
    both; and a coat alone on black. The coats of the second and third sphere mirror the studio alike."""
    texture = bump_map(stage)
    info = {"index": texture, "extensions": {"KHR_texture_transform": {"scale": [12, 6]}}}
    stage.file.required.add("KHR_texture_transform")
    coat = {"clearcoatFactor": 1}
    bumpy = {**coat, "clearcoatNormalTexture": info}
    balls = Balls(stage, 3, 2)
    balls.put("base", stage.surface(GOLD, 1, 0.5))
    balls.put("coat", stage.surface(GOLD, 1, 0.5, {"clearcoat": coat}))
    balls.put("bumpy base", stage.surface(GOLD, 1, 0.5, {"clearcoat": coat}, normalTexture=info))
    balls.put("bumpy coat", stage.surface(GOLD, 1, 0.5, {"clearcoat": bumpy}))
    balls.put("both", stage.surface(GOLD, 1, 0.5, {"clearcoat": bumpy}, normalTexture=info))
    balls.put("black", stage.surface(BLACK, 0, 1, {"clearcoat": coat}))
    stage.tolerate(10, 256)


@model("SheenTestGrid")
def sheen_test_grid(stage):
    """Fibres brighten edges, the more narrowly the less rough they are (from left to right: rougher). Rows: white and
    blue sheen by factors; blue by an image, like the row before; roughness by an image's alpha, like the first row."""
    balls = Balls(stage, 5, 4)

    def cloth(**values):
        return stage.surface(BLACK, 0, 1, {"sheen": values})

    codes = (51, 102, 153, 204, 255)
    blue = (100, 120, 250)
    factor = [decoded(c) for c in blue]
    white = [1, 1, 1]
    rows = [[(f"white {fraction(c):.1f}", cloth(sheenColorFactor=white, sheenRoughnessFactor=fraction(c))) for c in codes],
            [(f"blue {fraction(c):.1f}", cloth(sheenColorFactor=factor, sheenRoughnessFactor=fraction(c))) for c in codes],
            [("image", cloth(sheenColorFactor=white, sheenColorTexture=grey(stage, *blue),
                             sheenRoughnessFactor=fraction(c))) for c in codes],
            [("alpha", cloth(sheenColorFactor=white, sheenRoughnessFactor=1,
                             sheenRoughnessTexture=grey(stage, 200, 90, 10, c))) for c in codes]]
    rects = balls.rows(*rows)
    alike(stage, rects, (1, 2), (0, 3))
    stage.differ(rects[0][0], rects[0][4], 0)
    stage.tolerate(10, 256)


def iridescence(stage, metallic):
    base = ((0.6, 0.6, 0.6), 1, 0.1) if metallic else (BLACK, 0, 0.1)
    balls = Balls(stage, 5, 4)

    def film(**values):
        return stage.surface(*base, {"iridescence": {"iridescenceFactor": 1, **values}})

    nm = (150, 275, 400, 525, 650)
    image = [round(255 * (t - 100) / 600) for t in nm]  # Between 100 and 700 nm.
    exact = [100 + 600 * fraction(c) for c in image]
    rows = [[(f"1.3 {t}", film(iridescenceThicknessMaximum=t)) for t in nm],
            [(f"1.8 {t}", film(iridescenceIor=1.8, iridescenceThicknessMaximum=x)) for t, x in zip(nm, exact)],
            [("image", film(iridescenceIor=1.8, iridescenceThicknessMinimum=100, iridescenceThicknessMaximum=700,
                            iridescenceThicknessTexture=grey(stage, 200, c, 30))) for c in image],
            [("none", stage.surface(*base)), ("weight 0", film(iridescenceFactor=0)),
             ("image 0", film(iridescenceTexture=grey(stage, 0, 200, 90))),
             ("weight .5", film(iridescenceFactor=fraction(128), iridescenceIor=1.8)),
             ("image .5", film(iridescenceIor=1.8, iridescenceTexture=grey(stage, 128, 10, 255)))]]
    rects = balls.rows(*rows)
    alike(stage, rects, (1, 2))
    last = rects[3]
    for a, b in ((0, 1), (0, 2), (3, 4)):
        stage.equal(last[a], last[b], 0)
    stage.differ(rects[1][1], rects[1][3], 4)
    stage.tolerate(10, 256)


@model("IridescenceMetallicSpheres")
def iridescence_metallic_spheres(stage):
    """A thin film colours metal, by its thickness (from left to right, in nm) and its index (first row 1.3, then 1.8).
    The third row has its thickness from the green of an image and looks like the second one. In the last row, the
    first three have no film, and the last two half of one."""
    iridescence(stage, True)


@model("IridescenceDielectricSpheres")
def iridescence_dielectric_spheres(stage):
    """As for metal, but on black plastic, whose reflection alone is coloured, by thickness and index of the film."""
    iridescence(stage, False)


@model("SpecularTest")
def specular_test(stage):
    """Reflection of plastic with an index of 1.8 grows with its weight (first row), which an image's alpha may say
    (second row, alike); it is coloured, but white at the edge (third row), which an image may say (fourth row)."""
    balls = Balls(stage, 5, 4)

    def plastic(**values):
        return stage.surface(BLACK, 0, 0.15, {"ior": {"ior": 1.8}, "specular": values})

    colours = [(255, 255, 255), (250, 200, 110), (240, 80, 80), (90, 140, 250), (0, 0, 0)]
    rows = [[(f"{fraction(c):.2f}", plastic(specularFactor=fraction(c))) for c in CODES],
            [("alpha", plastic(specularTexture=grey(stage, 200, 90, 10, c))) for c in CODES],
            [("colour", plastic(specularColorFactor=[decoded(c) for c in colour])) for colour in colours],
            [("image", plastic(specularColorTexture=grey(stage, *colour))) for colour in colours]]
    rects = balls.rows(*rows)
    alike(stage, rects, (0, 1), (2, 3))
    stage.differ(rects[0][0], rects[0][4], 0)
    stage.tolerate(10, 256)


def checks(stage, balls, size, colours=((30, 30, 34), (225, 225, 220))):
    """A backdrop of squares, the same behind each sphere; labels stay on dark ground."""
    for rect in balls.cells:
        for y in range(0, rect[3] - rect[1], size):
            for x in range(0, rect[2] - rect[0], size):
                square = (rect[0] + x, rect[1] + y, min(rect[0] + x + size, rect[2]), min(rect[1] + y + size, rect[3]))
                stage.canvas.fill(square, colours[(x + y) // size % 2])


GLASS = {"transmission": {"transmissionFactor": 1}, "volume": {"thicknessFactor": 1}}


@model("CompareIor")
def compare_ior(stage):
    """Above, solid spheres of glass: with an index of 1 there is nothing to see but the squares behind, and the higher
    the index, the stronger they are bent. Below, black plastic, which reflects two suns the more the higher its index.
    No index is 1.5."""
    balls = Balls(stage, 6, 3, deep=False)
    stage.backdrop_z = -0.6
    stage.sun((-0.5, 0.5, 0.7))
    stage.sun((0.7, -0.2, 0.7), 1)
    values = (1, 1.2, None, 1.5, 1.8, 2.4)

    def ior(value):
        return {} if value is None else {"ior": {"ior": value}}

    rects = balls.rows(
        [(f"{v or 'no ior'}", stage.surface((1, 1, 1), 0, 0, {**GLASS, **ior(v)})) for v in values],
        [(f"{v or 'no ior'}", stage.surface(BLACK, 0, 0.3, ior(v))) for v in values])
    checks(stage, balls, 7)
    empty = balls.cells[12]
    stage.label(empty, "empty")
    for row in rects:
        stage.equal(row[2], row[3], 0)
    stage.equal(rects[0][0], empty, 0)
    stage.differ(rects[0][1], rects[0][5], 4)
    stage.differ(rects[1][1], rects[1][5], 4)
    stage.tolerate(12, 256)


@model("DispersionTest")
def dispersion_test(stage):
    """The higher the dispersion (from left to right: none, 0, 0.5, 2, 10), the wider the fringes of colour at the
    edges of the squares behind solid glass, of an index of 1.5 above and 1.8 below. The first two of a row are
    alike, without colour."""
    balls = Balls(stage, 5, 2, deep=False)
    stage.backdrop_z = -1.0
    rows = []
    for ior in (1.5, 1.8):
        rows.append([(f"{ior} {v}", stage.surface((1, 1, 1), 0, 0, {
            **GLASS, "ior": {"ior": ior}, **({} if v == "none" else {"dispersion": {"dispersion": v}})}))
            for v in ("none", 0, 0.5, 2, 10)])
    rects = balls.rows(*rows)
    checks(stage, balls, 14)
    for row in rects:  # Near the edges, spheres show their neighbours.
        stage.equal(row[0], row[1], 18)
        stage.differ(row[1], row[4], 8)
    stage.tolerate(12, 256)
