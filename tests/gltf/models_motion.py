"""Models that move: animations of nodes and of weights, and morph targets at rest."""

import math
import struct

import matrices
import shapes
from gltf_file import COMPONENTS
from shapes import bump
from stage import DARK, METRE, chart, codes, inset, model


class Animation:
    """An animation to which channels are added."""

    def __init__(self, file, name="motion"):
        self.file, self.item = file, {"name": name, "samplers": [], "channels": []}
        file.add("animations", self.item)

    def channel(self, node, path, times, values, interpolation=None):
        """Values are numbers or tuples; of CUBICSPLINE in-tangent, value and out-tangent of each key."""
        sampler = {"input": self.file.accessor([float(t) for t in times], bounds=True),
                   "output": self.file.accessor(values)}
        if interpolation:
            sampler["interpolation"] = interpolation
        self.item["samplers"].append(sampler)
        target = {"node": node, "path": path}
        self.item["channels"].append({"sampler": len(self.item["samplers"]) - 1, "target": target})


def slerp(a, b, t):
    """Between two unit quaternions, the shorter way, at even speed."""
    dot = sum(p * q for p, q in zip(a, b))
    if dot < 0:
        b, dot = [-q for q in b], -dot
    angle = math.acos(min(dot, 1))
    if angle < 1e-6:
        return list(a)
    return [(p * math.sin((1 - t) * angle) + q * math.sin(t * angle)) / math.sin(angle) for p, q in zip(a, b)]


def spline(v0, b0, a1, v1, td, t):
    """A cubic spline of glTF between two keys td apart, at t from 0 to 1, by their out- and in-tangents."""
    t2, t3 = t * t, t * t * t
    return [(2 * t3 - 3 * t2 + 1) * p + td * (t3 - 2 * t2 + t) * b + (3 * t2 - 2 * t3) * q + td * (t3 - t2) * a
            for p, b, q, a in zip(v0, b0, v1, a1)]


def sampled(times, values, interpolation, time, path):
    """What an animation says at a time: a reader in a few lines."""
    if time <= times[0] or len(times) == 1:
        return list(values[1] if interpolation == "CUBICSPLINE" else values[0])
    if time >= times[-1]:
        return list(values[-2] if interpolation == "CUBICSPLINE" else values[-1])
    k = max(i for i, t in enumerate(times) if t <= time)
    td = times[k + 1] - times[k]
    t = (time - times[k]) / td
    if interpolation == "STEP":
        return list(values[k])
    if interpolation == "LINEAR":
        a, b = values[k], values[k + 1]
        return slerp(a, b, t) if path == "rotation" else [p + (q - p) * t for p, q in zip(a, b)]
    result = spline(values[3 * k + 1], values[3 * k + 2], values[3 * k + 3], values[3 * k + 4], td, t)
    return matrices.unit(result) if path == "rotation" else result


GREEN, ORANGE = (0.05, 0.6, 0.1), (0.9, 0.6, 0.2)
STEP = 0.25  # Seconds between the keys of references; claims are about multiples of it.
LENGTH = 2.0


def reference_channel(animation, node, path, times, values, interpolation):
    """The same motion as even steps with a key at each multiple of STEP."""
    keys = [STEP * i for i in range(-1, round(LENGTH / STEP) + 3)]
    keys = [k for k in keys if k >= 0]
    animation.channel(node, path, keys, [tuple(sampled(times, values, interpolation, k, path)) for k in keys], "LINEAR")


@model("InterpolationTest")
def interpolation_test(stage):
    """Steps, lines and cubic splines, of scale, rotation and translation; before the first key and after the last one,
    things stay as they are there; a sampler that names no interpolation has lines. The left box of each pair moves
    so; the right one has a key for each quarter of a second, and both agree at 0, 0.5, 1.25 and 5 s. `--time` says
    when. The green square is on its way from the left to the right from 0 to 2 s."""
    file = stage.file
    animation, material = Animation(file), stage.unlit(texture=file.texture(chart()))
    times = [0.25, 1.0, 2.0]
    q = [matrices.turn((0, 0, 1), a) for a in (0, 120, 60)]
    keys = {"scale": [(0.5, 0.5, 1), (1.2, 0.4, 1), (0.7, 1.2, 1)], "rotation": [tuple(x) for x in q],
            "translation": [(-0.1, 0.0, 0.0), (0.12, 0.1, 0.0), (0.0, -0.12, 0.0)]}
    slopes = {"scale": [(0, 0, 0), (1.0, -1.0, 0), (0, 0, 0)],
              "rotation": [(0, 0, 0, 0), (0, 0, 1.0, -0.8), (0, 0, 0, 0)],
              "translation": [(0.0, 0.5, 0.0), (-0.4, 0.2, 0.0), (0.3, 0.0, 0.0)]}
    short = {"scale": "scale", "rotation": "turn", "translation": "move"}
    names = {"STEP": "step", "LINEAR": "line", "CUBICSPLINE": "spline"}
    cases = [(f"{names[name]} {short[path]}", name, path) for path in keys for name in names]
    cases.append(("none scale", None, "scale"))
    stage.check("--time", "0", spp=64, tolerance=6)
    for left, right, name, path in stage.pairs(cases):
        values = keys[path]
        if name == "CUBICSPLINE":
            values = [v for key, slope in zip(values, slopes[path]) for v in (slope, key, slope)]
        for rect, moves in ((left, Animation.channel), (right, None)):
            x, y = stage.centre(rect)
            half = (rect[2] - rect[0]) / 2 / METRE * 0.62
            holder = file.node(translation=[x, y, 0])
            node = stage.put(shapes.sheet(-half, -half, half, half), material, holder)
            if moves:
                animation.channel(node, path, times, values, name)
            else:
                reference_channel(animation, node, path, times, values, name or "LINEAR")
    first = stage.checks[-1]
    square, way = (126, 196, 146, 216), 160  # Pixels.
    node = stage.put(stage.sheet(square), stage.unlit(GREEN))
    animation.channel(node, "translation", [0, 2], [(0.0, 0.0, 0.0), (way / METRE, 0.0, 0.0)])
    for time in (0, 0.5, 1.25, 5):
        if time:
            stage.check("--time", str(time), spp=64, tolerance=6)
            stage.checks[-1].update(equal=first["equal"], shown=first["shown"])
        x = way * min(time, 2) / 2
        stage.expect((square[0] + x, square[1], square[2] + x, square[3]), codes(GREEN))


def morphed_sheet(stage, rect, weights, moves):
    """A sheet, and what of each of its vertices moves: (dx, dy, dz) by targets, functions of (s, t)."""
    mesh = stage.sheet(rect, n=6)
    places = [(c / 6, r / 6) for r in range(7) for c in range(7)]
    targets = [[move(s, t) for s, t in places] for move in moves]
    result = [tuple(p[k] + sum(w * target[i][k] for w, target in zip(weights, targets)) for k in range(3))
              for i, p in enumerate(mesh.positions)]
    return mesh, targets, result


def sparse_accessor(file, rows):
    """An accessor without a view, whose elements are zero but for some."""
    places = [i for i, row in enumerate(rows) if any(row)]
    stored = [struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows]
    return file.add("accessors", {
        "componentType": COMPONENTS["f32"][0], "count": len(rows), "type": "VEC3",
        "min": [min(c) for c in zip(*stored)], "max": [max(c) for c in zip(*stored)],
        "sparse": {"count": len(places),
                   "indices": {"bufferView": file.view(struct.pack(f"<{len(places)}H", *places)),
                               "componentType": COMPONENTS["u16"][0]},
                   "values": {"bufferView": file.view(b"".join(struct.pack("<3f", *rows[i]) for i in places))}}})


@model("MorphPrimitivesTest")
def morph_primitives_test(stage):
    """Morph targets move vertices by their weights, in all primitives of a mesh: by those of the mesh, or of the node,
    which come first; targets of normals and colours count, too, and sparse ones. The left sheet of each pair is
    morphed, the vertices of the right one have the result."""
    file = stage.file
    texture = file.texture(chart())
    stage.sun((-0.55, 0.6, 0.58))
    def lean(s, t):
        return 0.16 * (1 - t) - 0.08, 0.0, 0.0

    def swell(s, t):
        return 0.0, -0.1 * math.sin(math.pi * s) * t, 0.0

    def pull(s, t):
        return 0.1 * (s == 0.5), -0.1 * (t == 0.5), 0.0

    image = stage.unlit(texture=texture)
    cases = [("mesh 0.5", [0.5], None, [lean]), ("no weights", None, None, [lean]), ("node 1", [0.25], [1.0], [lean]),
             ("two targets", [0.5, -0.5], None, [lean, swell]), ("node of two", [0, 0], [0.3, 0.8], [lean, swell]),
             ("primitives", [0.6, 0.6], None, [lean, swell]), ("normals", [0.6], None, "normals"),
             ("colours", [0.5], None, "colours"), ("sparse", [0.75], None, "sparse")]
    for left, right, mesh_weights, node_weights, moves in stage.pairs(cases):
        weights = node_weights or mesh_weights or [0.0]
        node = {"weights": node_weights} if node_weights else {}
        more = {"weights": mesh_weights} if mesh_weights else {}
        if moves == "normals":
            clay = stage.surface((0.8, 0.6, 0.45))
            mesh = stage.sheet(left, n=12)
            places = [(c / 12, r / 12) for r in range(13) for c in range(13)]
            target = [tuple(2 * (a - b) for a, b in zip(bump(s, t), (0, 0, 1))) for s, t in places]
            primitive = file.primitive(mesh.attributes(), mesh.indices, clay, targets=[{"NORMAL": target}])
            file.node(mesh=file.mesh(primitive, **more), **node)
            stage.tile(right, clay, n=12, normal=lambda s, t: matrices.unit(
                [n + 2 * weights[0] * (m - n) for m, n in zip(bump(s, t), (0, 0, 1))]))
            continue
        if moves == "colours":
            white = stage.unlit()
            mesh = stage.sheet(left, colour=lambda s, t: (0.2, 0.2, 0.9))
            primitive = file.primitive(mesh.attributes(), mesh.indices, white, targets=[
                {"COLOR_0": [(1.0, 0.4, -0.8)] * 4}])
            file.node(mesh=file.mesh(primitive, **more), **node)
            stage.tile(right, white, colour=lambda s, t: (0.7, 0.4, 0.5))
            continue
        sparse = moves == "sparse"
        moves = [pull] if sparse else moves
        mesh, targets, result = morphed_sheet(stage, inset(left, 7), weights, moves)
        named = [{"POSITION": sparse_accessor(file, target) if sparse else target} for target in targets]
        half = len(mesh.indices) // 2
        parts = [mesh.indices[:half], mesh.indices[half:]] if len(moves) == 2 and not node_weights else [mesh.indices]
        materials = [image, stage.unlit((1, 0.6, 0.3), texture)] if len(parts) == 2 else [image]
        attributes = file.attributes(mesh.attributes())
        file.node(mesh=file.mesh(*(file.primitive(attributes, part, material, targets=named)
                                   for part, material in zip(parts, materials)), **more), **node)
        shift = (right[0] - left[0]) / METRE
        mesh.positions = [(x + shift, y, z) for x, y, z in result]
        attributes = file.attributes(mesh.attributes())
        file.node(mesh=file.mesh(*(file.primitive(attributes, part, material)
                                   for part, material in zip(parts, materials))))
    stage.flat_terminator()
    stage.tolerate(4, 64)


@model("MorphStressTest")
def morph_stress_test(stage):
    """Eight morph targets at once raise eight bars, whose weights an animation moves; the upper row by lines, the lower
    one by splines. The bar on the right of each is a sheet that a node scales, with a key for each quarter of a
    second: both are equally high at 0, 0.75 and 1.5 s, which `--time` says."""
    file = stage.file
    animation = Animation(file)
    orange = stage.unlit(ORANGE)
    tall, width = 80 / METRE, 14
    pairs, heights_at = [], {time: [] for time in (0, 0.75, 1.5)}
    for row, interpolation in enumerate(("LINEAR", "CUBICSPLINE")):
        bottom = 112 + 112 * row
        bars, places = [], []
        for k in range(8):
            rect = (8 + 39 * k, bottom - 4, 8 + 39 * k + width, bottom)
            bars.append(stage.sheet(rect))
            places.append(rect)
        mesh = shapes.joined(*bars)
        targets = [{"POSITION": [(0.0, tall if i // 4 == k and i % 4 < 2 else 0.0, 0.0)
                                 for i in range(len(mesh.positions))]} for k in range(8)]
        primitive = file.primitive(mesh.attributes(), mesh.indices, orange, targets=targets)
        node = file.node(mesh=file.mesh(primitive, weights=[0.0] * 8))
        times = [0.0, 0.6, 1.3, 2.0]
        keys = [[0.5 + 0.5 * math.sin(1.7 * k + 2.1 * i) for k in range(8)] for i in range(4)]
        values = [w for key in keys for w in key]
        if interpolation == "CUBICSPLINE":
            slope = [[0.3 * math.cos(1.3 * k + i) for k in range(8)] for i in range(4)]
            values = [w for key, s in zip(keys, slope) for part in (s, key, s) for w in part]
        animation.channel(node, "weights", times, values, interpolation)
        for k, rect in enumerate(places):
            beside = (rect[2] + 2, rect[1], rect[2] + 2 + width, rect[3])
            x0, y0, x1, y1 = stage.corners(beside)
            holder = file.node(translation=[x0, y0, 0])
            own = stage.put(shapes.sheet(0, 0, x1 - x0, y1 - y0), orange, holder)
            if interpolation == "LINEAR":
                single = [(key[k],) for key in keys]
            else:
                single = [(part[k],) for key, s in zip(keys, slope) for part in (s, key, s)]
            ticks = [STEP * i for i in range(9)]
            heights = [sampled(times, single, interpolation, t, "weights")[0] for t in ticks]
            assert min(heights) >= 0 and max(heights) <= 1.03
            animation.channel(own, "scale", ticks, [(1.0, 1 + h * tall / (y1 - y0), 1.0) for h in heights], "LINEAR")
            pairs.append((rect, beside))
            for time, found in heights_at.items():
                found.append(4 + 80 * heights[round(time / STEP)])
    for time, found in heights_at.items():
        stage.check("--time", str(time), spp=64, tolerance=6)
        for (rect, _), height in zip(pairs, found):
            stage.expect((rect[0], rect[3] - height, rect[2], rect[3]), codes(ORANGE))
            stage.expect((rect[0], rect[3] - 92, rect[2], rect[3] - height), DARK)
        for a, b in pairs:
            stage.equal((a[0], a[3] - 92, a[2], a[3]), (b[0], b[3] - 92, b[2], b[3]))
