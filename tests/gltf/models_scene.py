"""Models about scenes: how nodes place things, and what of a file is shown."""

import math

import matrices
import shapes
from models_normals import bump_map
from shapes import bump
from stage import METRE, chart, encoded, model

RED, GREEN = (0.8, 0.05, 0.04), (0.05, 0.6, 0.1)


def coloured_box():
    """A box about the origin whose sides and proportions tell how it is turned."""
    mesh = shapes.box((-0.2, -0.14, -0.07), (0.2, 0.14, 0.07))
    sides = [(0.8, 0.1, 0.1), (0.1, 0.7, 0.7), (0.1, 0.7, 0.1), (0.7, 0.1, 0.7), (0.1, 0.2, 0.9), (0.8, 0.7, 0.1)]
    mesh.colours = [side for side in sides for _ in range(4)]
    return mesh


@model("OrientationTest")
def orientation_test(stage):
    """Nodes turn, move and scale what they hold: by quaternions about each axis, by a matrix, by scale before rotation
    before translation, and by their parents. Each box on the left is so placed; the vertices of the right one
    are."""
    white = stage.unlit()
    along = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
    cases = [(f"{name} {angle}", [{"rotation": matrices.turn(axis, angle)}])
             for name, axis in along.items() for angle in (50, 200)]
    skewed = matrices.product(matrices.rotation(matrices.turn((1, 1, 0), 40)), matrices.scaling(0.7, 1.4, 1))
    cases += [
        ("oblique", [{"rotation": matrices.turn((1, 2, 3), 110)}]),
        ("matrix", [{"matrix": skewed}]),
        ("trs", [{"rotation": matrices.turn((0, 0, 1), 30), "scale": [1.4, 0.5, 1], "translation": [0.05, 0, 0]}]),
        ("parent", [{"scale": [1.3, 0.6, 1]}, {"rotation": matrices.turn((0, 0, 1), 40)}]),
        ("three", [{"rotation": matrices.turn((1, 0, 0), 60)}, {"translation": [0, 0.05, 0], "scale": [0.8, 0.8, 2]},
                   {"rotation": matrices.turn((0, 0, 1), 25)}]),
    ]
    for left, right, chain in stage.pairs(cases):
        matrix, node = matrices.IDENTITY, None
        x, y = stage.centre(left)
        node = stage.file.node(translation=[x, y, 0])
        for step in chain:
            if "matrix" in step:
                own = step["matrix"]
                step = {"matrix": matrices.column_major(own)}
            else:
                own = matrices.transform(step.get("translation", (0, 0, 0)), step.get("rotation", (0, 0, 0, 1)),
                                         step.get("scale", (1, 1, 1)))
            matrix = matrices.product(matrix, own)
            node = stage.file.node(node, **step)
        stage.put(coloured_box(), white, node)
        x, y = stage.centre(right)
        stage.put(coloured_box().moved(matrices.product(matrices.translation(x, y), matrix)), white)
    stage.tolerate(5, 64)


@model("NegativeScaleTest")
def negative_scale_test(stage):
    """Where a node's scale mirrors what it holds, fronts stay fronts, normals and tangents are mirrored with it: the
    single-sided, lit tiles on the left are mirrored along one, two or three axes, or by a parent; those on the
    right by their vertices."""
    normals = {"normalTexture": {"index": bump_map(stage)}}
    file = stage.file
    stage.sun((-0.6, 0.5, 0.62), 2.4)
    stage.sun((0.6, -0.5, 0.62), 0.8)
    plain, mapped = stage.surface((0.8, 0.5, 0.2)), stage.surface((0.8, 0.5, 0.2), **normals)
    cases = [("x", (-1, 1, 1), False), ("y", (1, -1, 1), False), ("x y", (-1, -1, 1), False),
             ("x normals", (-1, 1, 1), True), ("y normals", (1, -1, 1), True), ("parent", None, True),
             ("z of a box", (1, 1, -1), None), ("all of a box", (-1, -1, -1), None)]
    for left, right, scale, textured in stage.pairs(cases):
        half = (left[2] - left[0]) / 2 / METRE
        if textured is None:
            mesh, material = coloured_box(), stage.surface((1, 1, 1))
            matrix = matrices.rotation(matrices.turn((1, 2, 0.5), 50))
            mesh = mesh.moved(matrix)
        else:
            material = mapped if textured else plain
            mesh = shapes.sheet(-half, -half, half, half, 0, n=12 if not textured else 1,
                                normal=None if textured else lambda s, t: bump(s * 0.9, t * 0.8),
                                tangent=(lambda s, t: (1, 0, 0, 1)) if textured else None)
        x, y = stage.centre(left)
        if scale:  # Boxes stand in front of their references, which they would light.
            stage.put(mesh, material, translation=[x, y, 3 if textured is None else 0], scale=list(scale))
            matrix = matrices.scaling(*scale)
        else:
            parent = file.node(translation=[x, y, 0], scale=[1, -1, 1])
            stage.put(mesh, material, parent, rotation=matrices.turn((0, 0, 1), 90))
            matrix = matrices.product(matrices.scaling(1, -1), matrices.rotation(matrices.turn((0, 0, 1), 90)))
        x, y = stage.centre(right)
        stage.put(mesh.moved(matrices.product(matrices.translation(x, y), matrix)), material)
    stage.tolerate(6, 64)


@model("NodeVisibility")
def node_visibility(stage):
    """What KHR_node_visibility hides is not there, nor what is below it, even if that says it is visible; lights
    neither. Two ticks and a green tile show, nothing red; the sheet at the bottom is lit by a white sun alone, not by
    the hidden red one."""
    file = stage.file
    file.used.add("KHR_node_visibility")

    def seen(visible):
        return {"KHR_node_visibility": {"visible": visible}}

    cross = stage.unlit(RED)
    rects = stage.grid(3, 1, 64, 64, 20)
    for rect, name in zip(rects, ("hidden", "child", "visible")):
        stage.label(rect, name)
        stage.canvas.mark(rect, name != "visible")
    stage.put(stage.sheet(rects[0], 0), cross, extensions=seen(False))
    parent = file.node(extensions=seen(False))
    stage.put(stage.sheet(rects[1], 0), cross, parent, extensions=seen(True))
    stage.put(stage.sheet(rects[2], 0), stage.unlit(GREEN), extensions=seen(True))
    light = file.light(type="directional", intensity=math.pi, color=[1, 0, 0])
    file.node(rotation=matrices.towards((0, 0, -1)), extensions={**light, **seen(False)})
    stage.sun((0, 0, 1))
    bottom = [20, 190, 300, 230]
    stage.tile(bottom, stage.surface((0.5, 0.5, 0.5), extensions={"specular": {"specularFactor": 0}}))
    stage.expect(bottom, [encoded(0.5)] * 3)
    stage.expect(rects[2], [encoded(c) for c in GREEN])
    for rect in rects[:2]:
        stage.expect([rect[0], rect[1], rect[0] + 16, rect[1] + 16], (44, 46, 52))
        stage.expect([rect[0] + 24, rect[1] + 42, rect[0] + 30, rect[1] + 48], (60, 200, 80), 2)


@model("MultipleScenes")
def multiple_scenes(stage):
    """Of several scenes, the one that the file names is shown: the green one, and not the red one, which comes
    first."""
    file = stage.file
    rect = [100, 60, 220, 180]
    wrong = stage.put(stage.sheet(rect, 0.5), stage.unlit(RED))
    file.json["scenes"].append({"nodes": [], "name": "right"})
    assert file.json["scenes"][0]["nodes"] == [wrong]
    file.json["scene"] = 1
    stage.put(stage.sheet(rect), stage.unlit(GREEN))
    stage.expect(rect, [encoded(c) for c in GREEN])


@model("Cameras")
def cameras(stage):
    """The first camera is orthographic; the second one, in perspective, shows the same plane in the same size; the
    third one is turned by 90 degrees, and so shows the plane turned; the fourth one stands in a node that is moved
    and scaled, states neither aspect nor far end, and shows the upper right quarter."""
    stage.backdrop_z = 0.0
    colours = {"red": (220, 60, 50), "green": (60, 180, 70), "blue": (60, 90, 220), "yellow": (230, 210, 70)}
    for rect, colour in zip(((0, 14, 160, 127), (160, 14, 320, 127), (0, 127, 160, 240), (160, 127, 320, 240)),
                            colours.values()):
        stage.canvas.fill(rect, colour)
    stage.canvas.bits(60, 100, ("xxxxxxxx", "x.......", "xxxxx...", "x.......", "x......."), (20, 20, 20), 6)
    half, distance = 240 / 2 / METRE, 8.0
    yfov = 2 * math.atan(half / distance)
    nodes = [("perspective", {"aspectRatio": 4 / 3, "yfov": yfov, "znear": 0.1, "zfar": 100},
              {"translation": [0, 0, distance]}, None),
             ("turned", {"aspectRatio": 4 / 3, "yfov": yfov, "znear": 0.1, "zfar": 100},
              {"translation": [0, 0, distance], "rotation": matrices.turn((0, 0, 1), 90)}, None),
             ("quarter", {"yfov": yfov, "znear": 0.1}, {"translation": [0, 0, distance / 6]},
              {"translation": [80 / METRE, 60 / METRE, 0], "scale": [3, 3, 3]})]
    for name, perspective, node, parent in nodes:
        index = stage.file.add("cameras", {"type": "perspective", "name": name, "perspective": perspective})
        above = stage.file.node(**parent) if parent else None
        stage.file.node(above, name=name, camera=index, **node)
    quarters = {"left up": [4, 20, 56, 120], "right up": [264, 20, 316, 120], "left down": [4, 135, 56, 235],
                "right down": [264, 135, 316, 235]}

    def expect(*names):
        for rect, name in zip(quarters.values(), names):
            stage.expect(rect, colours[name], 4)

    expect("red", "green", "blue", "yellow")
    stage.check("--camera", "perspective")
    expect("red", "green", "blue", "yellow")
    stage.check("--camera", "turned")  # Up in the world is on the right of the picture.
    stage.expect([60, 20, 130, 110], colours["blue"], 4)
    stage.expect([190, 20, 250, 110], colours["red"], 4)
    stage.expect([60, 130, 130, 220], colours["yellow"], 4)
    stage.expect([190, 130, 250, 220], colours["green"], 4)
    stage.check("--camera", "quarter")
    stage.expect([10, 40, 310, 230], colours["green"], 4)


@model("MaterialsVariants")
def materials_variants(stage):
    """Without a choice, primitives have their own materials: both tiles are green. A variant that is chosen replaces
    that of the left tile: "blue" by a blue one, "chart" by an image; what it does not name stays."""
    file = stage.file
    file.used.add("KHR_materials_variants")
    variants = {"variants": [{"name": "blue"}, {"name": "chart"}]}
    file.json.setdefault("extensions", {})["KHR_materials_variants"] = variants
    left, right = [40, 60, 136, 156], [184, 60, 280, 156]
    stage.label(left, "varies")
    stage.label(right, "stays")
    green, blue, image = (stage.unlit(GREEN), stage.unlit((0.05, 0.1, 0.8)),
                          stage.unlit(texture=file.texture(chart())))
    for rect, mappings in ((left, [{"material": blue, "variants": [0]}, {"material": image, "variants": [1]}]),
                           (right, None)):
        mesh = stage.sheet(rect)
        primitive = file.primitive(mesh.attributes(), mesh.indices, green)
        if mappings:
            primitive["extensions"] = {"KHR_materials_variants": {"mappings": mappings}}
        file.node(mesh=file.mesh(primitive))
    shown = [encoded(c) for c in GREEN]
    stage.expect(left, shown)
    stage.expect(right, shown)
    stage.check("--variant", "blue")
    stage.expect(left, [encoded(c) for c in (0.05, 0.1, 0.8)])
    stage.expect(right, shown)
    stage.check("--variant", "chart")
    stage.expect([left[0], left[1], left[0] + 12, left[1] + 12], (255, 80, 60))
    stage.expect(right, shown)
