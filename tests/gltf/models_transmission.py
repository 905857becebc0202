"""Models of what passes surfaces: thin sheets, solids, and diffusely through leaves."""

import math

import shapes
from models_spheres import grey
from stage import chart, chart_colour, codes, encoded, linear, model, picture

CLEAR = {"ior": {"ior": 1}}  # Nothing is reflected, and nothing bent.


def slab(stage, rect, depth, z=0.0):
    """A closed box as deep as it says [m], from z backwards."""
    x0, y0, x1, y1 = stage.corners(rect)
    return shapes.box((x0, y0, z - depth), (x1, y1, z))


def paint(stage, rect, factor):
    """Eight by eight squares: a pattern of blocks of light and dark, times factor(column, row)."""
    side = (rect[2] - rect[0]) // 8
    for row in range(8):
        for column in range(8):
            behind = linear((225, 225, 220) if (row // 2 + column // 2) % 2 else (90, 100, 120))
            x, y = rect[0] + column * side, rect[1] + row * side
            shown = [encoded(b * f) for b, f in zip(behind, factor(column, row))]
            stage.canvas.fill((x, y, x + side, y + side), shown)


def pattern(stage, rect):
    paint(stage, rect, lambda column, row: (1, 1, 1))


@model("TransmissionTest")
def transmission_test(stage):
    """Thin sheets of index 1 show what is behind them, times their colour, which an image may say, and twice through
    two sheets; where a mask says so, they are not there. Where light does not pass, the sheet is matt. In each pair,
    the right tile is painted, or made in another way, so that it looks like the left one."""
    texture = stage.file.texture(chart())
    stage.sun((-0.3, 0.3, 0.9))

    def glass(colour=(1, 1, 1), factor=1.0, roughness=0.0, extensions=CLEAR, base=None, **more):
        return stage.surface(colour, 0, roughness, {"transmission": {"transmissionFactor": factor, **more},
                                                    **extensions}, base)

    tint = (0.25, 0.6, 0.9)
    tint_codes = codes(tint)
    mask = stage.file.texture(picture(8, 1, lambda x, y: (*tint_codes, 255 if x < 4 else 0), 4))
    masked = stage.file.material(
        {"transmission": {"transmissionFactor": 1}, **CLEAR}, alphaMode="MASK",
        pbrMetallicRoughness={"baseColorTexture": {"index": mask}, "metallicFactor": 0, "roughnessFactor": 0})
    # Label, the left sheet, a second one in front of it, the right one; or by how much the right one is darker.
    cases = [
        ("clear", glass(), None, lambda column, row: (1, 1, 1)),
        ("colour", glass(tint), None, lambda column, row: tint),
        ("two sheets", glass(tint), glass(tint), lambda column, row: [c * c for c in tint]),
        ("image", glass(base={"baseColorTexture": {"index": texture}}), None,
         lambda column, row: linear(chart_colour(column, row))),
        ("mask", masked, None, lambda column, row: linear(tint_codes) if column < 4 else (1, 1, 1)),
        ("half", glass(tint, 128 / 255), None, glass(tint, transmissionTexture=grey(stage, 128, 200, 10))),
        ("none", glass(tint, 0, 1, {}), None, stage.surface(tint)),
        ("index 1.5", glass(extensions={}), None, glass(extensions={"ior": {"ior": 1.5}})),
        ("matt", glass(tint, 1, 77 / 255, {}), None, glass(tint, 1, 1, {}, base={
            "metallicRoughnessTexture": grey(stage, 0, 77, 200)})),
    ]
    stage.backdrop_z = -0.3
    for left, right, material, second, reference in stage.pairs(cases, equal=False):
        matt = material == cases[-1][1]  # Such a sheet shows its neighbours near its edges.
        stage.equal(left, right, 9 if matt else 1)
        stage.shown(left)
        pattern(stage, left)
        stage.tile(left, material)
        if second is not None:
            stage.tile(left, second, 0.25)
        if callable(reference):
            paint(stage, right, reference)
        else:
            pattern(stage, right)
            stage.tile(right, reference)
    stage.tolerate(6, 256)


@model("TransmissionRoughnessTest")
def transmission_roughness_test(stage):
    """Slabs of glass before stripes: the rougher (from left to right), the more blurred. An index of 1 (first row)
    bends nothing, so that no roughness blurs; then 1.25, 1.5 and 2."""
    columns = (0, 0.1, 0.25, 0.5, 1)
    stage.backdrop_z = -0.6
    rects = stage.grid(5, 4, 52, 42)
    cells = iter(rects)
    stripes = (30, 60, 140), (225, 225, 220)
    for ior in (1, 1.25, 1.5, 2):
        for roughness in columns:
            rect = next(cells)
            stage.label(rect, f"{ior} {roughness}")
            for y in range(rect[1], rect[3], 7):
                stage.canvas.fill((rect[0], y, rect[2], y + 7), stripes[(y - rect[1]) // 7 % 2])
            stage.put(slab(stage, rect, 0.25), stage.surface((1, 1, 1), 0, roughness, {
                "transmission": {"transmissionFactor": 1}, "volume": {"thicknessFactor": 0.25}, "ior": {"ior": ior}}))
    for other in rects[1:5]:
        stage.equal(rects[0], other, 2)
    stage.differ(rects[5], rects[9], 2)
    stage.tolerate(8, 256)


BODY = (0.2, 0.7, 0.9)  # What is left of white light after one distance.


@model("AttenuationTest")
def attenuation_test(stage):
    """Light that passes a solid keeps the attenuation colour to the power of the way over the distance: a way as long
    as the distance shows the colour itself, twice the way its square. It is the way in the world, regardless of
    `thicknessFactor`, also under a scaled node; a factor of 0 is a thin sheet, which keeps all light. In each
    pair, the right tile is painted as the left one must look."""
    def body(distance=0.5, thickness=0.5, colour=BODY, base=(1, 1, 1)):
        volume = {"thicknessFactor": thickness, "attenuationColor": list(colour)}
        if distance:
            volume["attenuationDistance"] = distance
        return stage.surface(base, 0, 0, {"transmission": {"transmissionFactor": 1}, "volume": volume, **CLEAR})

    behind, tint = linear((225, 225, 220)), (0.5, 0.8, 1)
    # Label, depth of the box, material, and how many distances that is.
    cases = [
        ("1 distance", 0.5, body(), 1), ("2 distances", 1.0, body(), 2), ("half", 0.25, body(), 0.5),
        ("distance 0.25", 0.5, body(0.25), 2), ("distance 2", 0.5, body(2), 0.25), ("infinite", 0.5, body(None), 0),
        ("factor 0.1", 0.5, body(thickness=0.1), 1), ("factor 5", 0.5, body(thickness=5), 1),
        ("thin", 0.5, body(thickness=0), 0), ("scaled node", 0.25, body(), 1),
        ("base colour", 0.5, body(base=tint), 1), ("two bodies", 0.25, body(), 1),
    ]
    stage.sun()
    stage.backdrop_z = -2.0
    for (left, right, depth, material, power), (label, *_) in zip(stage.pairs(cases), cases):
        stage.canvas.fill(left, codes(behind))
        # The colour of the surface applies where light enters and where it leaves.
        base = [c * c for c in tint] if label == "base colour" else (1, 1, 1)
        stage.canvas.fill(right, codes(b * c ** power * f for b, c, f in zip(behind, BODY, base)))
        stage.put(slab(stage, left, depth), material, scale=[1, 1, 2 if label == "scaled node" else 1])
        if label == "two bodies":
            stage.put(slab(stage, left, depth, -0.5), material)


@model("DiffuseTransmissionTest")
def diffuse_transmission_test(stage):
    """Sheets that a sun lights from behind let through the fraction that the factor or an image's alpha states,
    in the colour of transmission, not in their own. In each pair, the right tile is painted as the left one must
    look; where all is reflected, it is black."""
    angle = math.radians(50)
    stage.backdrop_z = -50.0  # Out of the sun's way.
    stage.sun((0, math.sin(angle), -math.cos(angle)), math.pi / math.cos(angle))
    orange = (240, 150, 40)

    def leaf(base=(1, 1, 1), **values):
        return stage.surface(base, 0, 1, {"specular": {"specularFactor": 0}, "diffuse_transmission": values})

    def all_through(**values):
        return leaf(diffuseTransmissionFactor=1, **values)

    half, green = 128 / 255, (0.2, 0.9, 0.3)
    alpha, image = grey(stage, 250, 20, 90, 128), grey(stage, *orange)
    cases = [
        ("factor 0", leaf(diffuseTransmissionFactor=0), (0, 0, 0)),
        ("factor 0.5", leaf(diffuseTransmissionFactor=0.5), (0.5,) * 3),
        ("factor 1", all_through(), (1, 1, 1)),
        ("alpha", all_through(diffuseTransmissionTexture=alpha), (half,) * 3),
        ("colour", all_through(diffuseTransmissionColorFactor=list(green)), green),
        ("image", all_through(diffuseTransmissionColorTexture=image), linear(orange)),
        ("blue base", leaf((0, 0, 1), diffuseTransmissionFactor=1), (1, 1, 1)),
        ("product", leaf(diffuseTransmissionFactor=0.5, diffuseTransmissionColorFactor=[1, 0.5, 0.5],
                         diffuseTransmissionColorTexture=image),
         [0.5 * f * c for f, c in zip((1, 0.5, 0.5), linear(orange))]),
        ("none", stage.surface((1, 1, 1)), (0, 0, 0)),
    ]
    for left, right, material, shown in stage.pairs(cases):
        stage.tile(left, material)
        stage.canvas.fill(right, codes(shown))
    stage.tolerate(4, 64)
