"""Models of skins: meshes that joints bend. References are the same meshes, bent here."""

from dataclasses import replace

import matrices
import shapes
from models_motion import Animation
from stage import METRE, chart, model


class Rig:
    """Nodes, and where each one stands in the world."""

    def __init__(self, file):
        self.file, self.globals = file, {}

    def node(self, parent=None, **properties):
        index = self.file.node(parent, **properties)
        own = matrices.transform(properties.get("translation", (0, 0, 0)), properties.get("rotation", (0, 0, 0, 1)),
                                 properties.get("scale", (1, 1, 1)))
        self.globals[index] = matrices.product(self.globals.get(parent, matrices.IDENTITY), own)
        return index


def blended(parts):
    """The weighted sum of matrices, from pairs (weight, matrix)."""
    return [[sum(w * m[i][j] for w, m in parts) for j in range(4)] for i in range(4)]


def bent(mesh, influences, joints, inverses):
    """The mesh as a skin bends it: for each vertex, pairs of joint and weight; matrices of joints and their binds."""
    skins = [matrices.product(joint, inverse) for joint, inverse in zip(joints, inverses)]
    positions, normals = [], []
    for p, n, pairs in zip(mesh.positions, mesh.normals, influences):
        matrix = blended([(w, skins[j]) for j, w in pairs])
        positions.append(matrices.point(matrix, p))
        normals.append(matrices.normal(matrix, n))
    return replace(mesh, positions=positions, normals=normals)


def strip(width, height, z=0.0, rows=16):
    """An upright sheet that stands on the origin."""
    mesh = shapes.sheet(-width / 2, 0, width / 2, height)
    mesh.positions = [(x, height * row / rows, z) for row in range(rows, -1, -1) for x in (-width / 2, width / 2)]
    mesh.uvs = [(s, 1 - row / rows) for row in range(rows, -1, -1) for s in (0.0, 1.0)]
    mesh.normals = [(0.0, 0.0, 1.0)] * len(mesh.positions)
    mesh.indices = [i for row in range(rows) for a in (2 * row,) for i in (a, a + 2, a + 3, a, a + 3, a + 1)]
    return mesh


def two_joints(mesh, height):
    """Influences that go over from the lower to the upper joint in the middle half of a strip."""
    result = []
    for _, y, _ in mesh.positions:
        w = min(max(2 * y / height - 0.5, 0.0), 1.0)
        result.append([(0, 1 - w), (1, w)])
    return result


def quantized(influences, largest):
    """Weights as integers whose sum is the largest code, and the same ones as shares."""
    rows = []
    for pairs in influences:
        weights = [round(largest * w) for _, w in pairs]
        weights[0] += largest - sum(weights)
        rows.append([(joint, weight / largest) for (joint, _), weight in zip(pairs, weights)])
    return rows


def skin_attributes(influences, joint_kind="u8", weight_kind="f32"):
    largest = {"f32": 1, "u8": 255, "u16": 65535}[weight_kind]
    joints = [tuple([j if w else 0 for j, w in pairs] + [0] * (4 - len(pairs))) for pairs in influences]
    weights = [tuple([w if largest == 1 else round(largest * w) for _, w in pairs] + [0] * (4 - len(pairs)))
               for pairs in influences]
    return {"JOINTS_0": (joints, joint_kind, False), "WEIGHTS_0": (weights, weight_kind, largest > 1)}


def add_skin(file, joints, inverses=None, **more):
    skin = {"joints": list(joints), **more}
    if inverses is not None:
        skin["inverseBindMatrices"] = file.accessor([tuple(matrices.column_major(m)) for m in inverses])
    return file.add("skins", skin)


def put_skinned(file, mesh, influences, skin, material, kinds=("u8", "f32"), parent=None, **node):
    attributes = {**mesh.attributes(), **skin_attributes(influences, *kinds)}
    primitive = file.primitive(attributes, mesh.indices, material)
    return file.node(parent, mesh=file.mesh(primitive), skin=skin, **node)


def put_reference(stage, mesh, material, shift):
    mesh.positions = [(x + shift, y, z) for x, y, z in mesh.positions]
    stage.put(mesh, material)


@model("SimpleSkin")
def simple_skin(stage):
    """Joints bend strips by the weights of vertices: with joints as bytes or shorts, weights as floats, bytes or
    shorts; without inverse bind matrices; with a transform of the mesh's own node, which has no effect, or one
    above the joints, which has; with four joints to a vertex; with normals that turn; with an animation of the
    joint at 1 s. The right strip of each pair is bent beforehand."""
    file, rig = stage.file, Rig(stage.file)
    stage.sun((-0.3, 0.75, 0.6))
    image, clay = stage.unlit(texture=file.texture(chart()), doubleSided=True), stage.surface((0.8, 0.6, 0.45))
    animation = Animation(file)
    stage.check("--time", "1", spp=64, tolerance=5)
    side, up = ((0, 0, 1), -40), ((1, 0, 0), -50)
    for left, right, case, bend in stage.pairs([
            ("floats", ("u8", "f32"), side), ("bytes", ("u16", "u8"), side), ("shorts", ("u8", "u16"), side),
            ("no inverse", "plain", side), ("mesh node", "node", side), ("above", "above", side),
            ("four", "four", side), ("normals", "normals", up), ("animation", "animation", side)]):
        x, y = stage.centre(left)
        height, width = 34 / METRE, 14 / METRE
        above = {"scale": [0.8, 0.8, 1], "rotation": matrices.turn((0, 0, 1), 20)} if case == "above" else {}
        root = rig.node(translation=[x, y - height / 2, 0], **above)
        mesh = strip(width, height)
        material = clay if case == "normals" else image
        influences, middle = two_joints(mesh, height), height / 2
        turned = {"rotation": matrices.turn(*bend)}
        if case == "four":
            joints, inverses = [root], [matrices.IDENTITY]
            for k in range(3):
                joints.append(rig.node(joints[-1], translation=[0, height / 4, 0],
                                       rotation=matrices.turn((0, 0, 1), -20)))
                inverses.append(matrices.translation(0, -(k + 1) * height / 4))
            influences = []
            for _, py, _ in mesh.positions:
                raw = [max(0.0, 1 - abs(py / height * 4 - k - 0.5) / 2) for k in range(4)]
                influences.append([(k, w / sum(raw)) for k, w in enumerate(raw)])
        elif case == "plain":  # Vertices are in the space of their only joint.
            influences = [[(int(p[1] > middle), 1.0)] for p in mesh.positions]
            mesh.positions = [(p[0], p[1] - middle * pairs[0][0], p[2]) for p, pairs in zip(mesh.positions, influences)]
            joints = [root, rig.node(root, translation=[0, middle, 0], **turned)]
            inverses = [matrices.IDENTITY] * 2
        else:
            joints = [root, rig.node(root, translation=[0, middle, 0], **turned)]
            inverses = [matrices.IDENTITY, matrices.translation(0, -middle)]
        if case == "animation":  # From the other side to the same place.
            file.json["nodes"][joints[1]]["rotation"] = matrices.turn((0, 0, 1), 60)
            animation.channel(joints[1], "rotation", [0, 1], [tuple(matrices.turn((0, 0, 1), 60)),
                                                              tuple(turned["rotation"])])
        kinds = case if isinstance(case, tuple) else ("u8", "f32")
        if kinds[1] != "f32":
            influences = quantized(influences, {"u8": 255, "u16": 65535}[kinds[1]])
        skin = add_skin(file, joints, None if case == "plain" else inverses, skeleton=root)
        node = {"translation": [3, 1, -2], "rotation": matrices.turn((1, 2, 3), 70)} if case == "node" else {}
        put_skinned(file, mesh, influences, skin, material, kinds, **node)
        reference = bent(mesh, influences, [rig.globals[j] for j in joints], inverses)
        put_reference(stage, reference, material, (right[0] - left[0]) / METRE)


@model("RecursiveSkeletons")
def recursive_skeletons(stage):
    """A joint may hold further things: a plain mesh, which moves with it, and the joints of another skin, whose mesh
    stands below joints, too, but does not move with them twice. Two skins may share joints. On the right, everything
    is bent beforehand."""
    file, rig = stage.file, Rig(stage.file)
    texture = file.texture(chart())
    colours = [stage.unlit(c, texture, doubleSided=True) for c in ((1, 1, 1), (1, 0.7, 0.4), (0.5, 0.8, 1))]
    stage.tolerate(5, 64)
    for left, right, case in stage.pairs([("joint holds", "hand"), ("skin in skin", "nested"), ("shared", "shared")]):
        shift = (right[0] - left[0]) / METRE
        x, y = stage.centre(left)
        height, width = 26 / METRE, 14 / METRE
        root = rig.node(translation=[x - 6 / METRE, y - 26 / METRE, 0])
        parent = root
        for level in range(3 if case == "nested" else 1):
            tall = height * (1 - 0.25 * level)
            mesh = strip(width, tall, 0.03 * level)
            lower = rig.node(parent, **({"translation": [0, tall * 0.5, 0]} if level else {}))
            upper = rig.node(lower, translation=[0, tall / 2, 0],
                             rotation=matrices.turn((0, 0, 1), 50 if level % 2 else -35))
            inverses = [matrices.IDENTITY, matrices.translation(0, -tall / 2)]
            influences = two_joints(mesh, tall)
            skin = add_skin(file, [lower, upper], inverses)
            # Its node stands below a joint, which has no effect.
            put_skinned(file, mesh, influences, skin, colours[level], parent=upper if level else None)
            places = [rig.globals[lower], rig.globals[upper]]
            put_reference(stage, bent(mesh, influences, places, inverses), colours[level], shift)
            parent = upper
        if case == "hand":
            hand = shapes.sheet(-0.1, 0, 0.1, 0.2)
            file.node(upper, mesh=file.mesh(file.primitive(hand.attributes(), hand.indices, colours[1])),
                      translation=[0, tall / 2, 0.01])
            put_reference(stage, hand.moved(matrices.product(
                rig.globals[upper], matrices.translation(0, tall / 2, 0.01))), colours[1], shift)
        if case == "shared":  # The same joints in the other order, and further away.
            mesh = strip(width, height, 0.03)
            inverses = [matrices.translation(0.15, -height / 2, 0), matrices.translation(0.15, 0, 0)]
            influences = [[(1 - j, w) for j, w in pairs] for pairs in two_joints(mesh, height)]
            skin = add_skin(file, [upper, lower], inverses)
            put_skinned(file, mesh, influences, skin, colours[2])
            put_reference(stage, bent(mesh, influences, places[::-1], inverses), colours[2], shift)
