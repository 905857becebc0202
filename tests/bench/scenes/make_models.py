#!/usr/bin/env python3
"""Makes the models of tests/bench/batches.py in a folder, with NumPy and Pillow: `make_models.py FOLDER`.

    models/000.glb … 199.glb   small models, as shops and collections have them: most are plain and textured, few use
                               one extension or another, and every feature is somewhere
    textured-100k.glb          100 000 triangles with images of 1024² for colour, normals, metal and roughness
    skinned.glb                a stalk of 30 000 triangles that eight joints bend, in two seconds
    moving.glb                 a ring that moves among a million triangles, in two seconds

Seeds are fixed: the models are always the same. `--features` prints how many of the small models have which feature.
"""

import argparse
import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

import model_shapes as shapes  # noqa: E402 (needs the path)
import textured_images as images  # noqa: E402 (needs the path)
from model_file import VERTICES, ModelFile  # noqa: E402 (needs the path)

COUNT = 200
# Of how many small models each feature is a part; see features().
SHARES = {
    "base texture": 0.7, "jpeg": 0.45, "normal texture": 0.4, "metal-rough texture": 0.35, "occlusion texture": 0.25,
    "packed occlusion": 0.5, "emissive texture": 0.07, "emissive factor": 0.05, "no normals": 0.1, "tangents": 0.25,
    "vertex colours": 0.1, "second uv": 0.1, "mask": 0.08, "blend": 0.07, "double-sided": 0.25, "metal": 0.2,
    "instances": 0.15, "camera": 0.06, "lights": 0.04, "quantized": 0.03, "texture transform": 0.08, "clearcoat": 0.04,
    "clearcoat normal": 0.5, "sheen": 0.03, "transmission": 0.05, "volume": 0.025, "ior": 0.03, "specular": 0.04,
    "emissive strength": 0.02, "anisotropy": 0.015, "iridescence": 0.015, "dispersion": 0.01,
    "diffuse transmission": 0.01, "unlit": 0.04, "specular-glossiness": 0.025, "grey image": 0.05,
}
PATTERNS = (images.planks, images.bricks, images.weave, images.marble, images.plaster, images.brushed, images.hammered,
            images.spots, images.stripes, images.mosaic)
SHAPES = (shapes.sphere, shapes.torus, shapes.knot, shapes.vase, shapes.box)
FRAMES, RATE = 60, 30.0


def features():
    """The features of each small model: of every deck of COUNT cards, as many as its share are drawn."""
    result = [set() for _ in range(COUNT)]
    for deck, (name, share) in enumerate(SHARES.items()):
        for model in np.random.default_rng(1000 + deck).permutation(COUNT)[: round(share * COUNT)]:
            result[model].add(name)
    return result


# --- Materials -------------------------------------------------------------------------------------------------------


def palette(chance):
    return chance.integers(20, 250, (3, 3)).tolist()


def color(chance):
    return chance.uniform(0.1, 0.9, 3).round(3).tolist()


class Material:
    """What a model's features make of one material; other materials of a model have colour and a picture at most."""

    def __init__(self, file, have, chance, exotic=True):
        self.file, self.have, self.chance = file, have if exotic else have & {"base texture", "jpeg"}, chance
        self.size = int(chance.choice([128, 256, 512], p=[0.5, 0.35, 0.15]))
        self.height, self.tint = PATTERNS[chance.integers(len(PATTERNS))](self.size, int(chance.integers(1 << 30)))
        self.extensions = {}

    def has(self, name):
        return name in self.have

    def reference(self, pixels, jpeg=None, **more):
        """A reference to a picture, transformed if the model has the feature."""
        result = {"index": self.file.picture(pixels, self.has("jpeg") if jpeg is None else jpeg), **more}
        if self.has("texture transform"):
            transform = {"offset": [0.25, 0.1], "rotation": 0.5, "scale": [2, 1.5]}
            result["extensions"] = {"KHR_texture_transform": transform}
            self.file.used.add("KHR_texture_transform")
        return result

    def base_picture(self):
        pixels = images.colors(self.tint, palette(self.chance))
        if not (self.has("mask") or self.has("blend")):
            return images.codes(self.tint)[..., None] if self.has("grey image") else pixels
        holes = images.smooth(0.4, 0.6, self.height - self.height.min())
        opacity = holes if self.has("mask") else 0.3 + 0.7 * self.tint
        return np.concatenate([pixels, images.codes(np.broadcast_to(opacity, self.tint.shape))[..., None]], -1)

    def metal_rough(self):
        """Pictures and factors of metal, roughness and occlusion."""
        chance, numbers = self.chance, {}
        metal = 1.0 if self.has("metal") else 0.0
        orm = np.stack([images.codes(0.6 + 0.4 * self.tint), images.codes(0.3 + 0.6 * self.tint),
                        images.codes(metal * np.ones_like(self.tint))], -1)
        occlusion = None
        if self.has("metal-rough texture"):
            numbers["metallicRoughnessTexture"] = self.reference(orm)
            if self.has("packed occlusion"):
                occlusion = dict(numbers["metallicRoughnessTexture"])
        else:
            numbers |= {"metallicFactor": metal, "roughnessFactor": round(chance.uniform(0.1, 1), 3)}
        if self.has("occlusion texture"):
            occlusion = occlusion or self.reference(orm[..., :1], texCoord=int(self.has("second uv")))
        return numbers, occlusion

    def add_extensions(self, normal):
        """One or the other of the extensions, few of them together."""
        chance, more = self.chance, self.extensions
        one = {
            "sheen": {"sheenColorFactor": color(chance), "sheenRoughnessFactor": 0.4},
            "ior": {"ior": 1.33},
            "emissive strength": {"emissiveStrength": 4.0},
            "dispersion": {"dispersion": 0.3},
            "unlit": {},
            "anisotropy": {"anisotropyStrength": 0.7, "anisotropyRotation": 0.6},
            "iridescence": {"iridescenceFactor": 1.0, "iridescenceIor": 1.4},
            "diffuse transmission": {"diffuseTransmissionFactor": 0.5, "diffuseTransmissionColorFactor": color(chance)},
        }
        more |= {name.replace(" ", "_"): value for name, value in one.items() if self.has(name)}
        if self.has("specular"):
            more["specular"] = {"specularFactor": 0.6}
            if self.has("base texture"):
                tinted = np.concatenate([images.colors(self.tint, palette(chance)), images.codes(self.tint)[..., None]],
                                        -1)
                more["specular"]["specularTexture"] = self.reference(tinted, jpeg=False)
        if self.has("clearcoat"):
            more["clearcoat"] = {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.1}
            if self.has("clearcoat normal") and normal:
                more["clearcoat"]["clearcoatNormalTexture"] = dict(normal)
        if self.has("transmission") or self.has("volume") or self.has("dispersion"):
            more["transmission"] = {"transmissionFactor": 0.9}
        if self.has("volume") or self.has("dispersion"):
            more["volume"] = {"thicknessFactor": 0.5, "attenuationColor": color(chance), "attenuationDistance": 0.8}

    def add(self):
        """The index of the material in the file."""
        chance, item = self.chance, {}
        numbers, occlusion = self.metal_rough()
        alpha = 0.5 if self.has("blend") and not self.has("base texture") else 1.0
        numbers["baseColorFactor"] = [1, 1, 1, 1] if self.has("base texture") else [*color(chance), alpha]
        if self.has("base texture"):
            picture = self.base_picture()
            numbers["baseColorTexture"] = self.reference(picture, self.has("jpeg") and picture.shape[-1] == 3)
        normal = self.has("normal texture") and self.reference(images.normals(self.height, 0.01))
        self.add_extensions(normal)
        item["pbrMetallicRoughness"] = numbers
        if normal:
            item["normalTexture"] = normal
        if occlusion:
            item["occlusionTexture"] = occlusion
        if self.has("emissive texture"):
            spots = images.colors(images.smooth(0.7, 0.8, self.tint), ((0, 0, 0), (255, 200, 120)))
            item |= {"emissiveTexture": self.reference(spots), "emissiveFactor": [1, 1, 1]}
        elif self.has("emissive factor") or self.has("emissive strength"):
            item["emissiveFactor"] = color(chance)
        if self.has("mask"):
            item |= {"alphaMode": "MASK", "alphaCutoff": 0.5}
        elif self.has("blend"):
            item["alphaMode"] = "BLEND"
        if self.has("double-sided"):
            item["doubleSided"] = True
        if self.has("specular-glossiness"):
            glossy = {"diffuseFactor": numbers["baseColorFactor"], "specularFactor": [0.2, 0.2, 0.2],
                      "glossinessFactor": 0.6}
            if "baseColorTexture" in numbers:
                glossy["diffuseTexture"] = numbers["baseColorTexture"]
            self.extensions = {"pbrSpecularGlossiness": glossy}
        return self.file.material(self.extensions, **item)


# --- Small models ----------------------------------------------------------------------------------------------------


def mesh_of_triangles(chance, count):
    """A mesh of about so many triangles."""
    shape = SHAPES[chance.integers(len(SHAPES))]
    rows = max(4, round(math.sqrt(count / 2 / 2)))
    return shape(2 * rows, rows)


def quantized(file, mesh, material):
    """The same in 16 and 8 bits; positions in units of the node's scale of 2."""
    file.required.add("KHR_mesh_quantization")
    codes = np.clip(np.rint(mesh.positions / 2 * 32767), -32767, 32767).astype(np.int16)
    attributes = {"POSITION": file.bounded(codes, VERTICES, True),
                  "NORMAL": file.vertices(np.rint(mesh.normals * 127).astype(np.int8), True)}
    if mesh.uvs.max() <= 1:
        attributes["TEXCOORD_0"] = file.vertices(np.rint(mesh.uvs * 65535).astype(np.uint16), True)
    else:
        attributes["TEXCOORD_0"] = file.vertices(mesh.uvs)
    return {"attributes": attributes, "indices": file.indices(mesh.triangles), "material": material}


def more_attributes(file, mesh, have):
    more = {}
    if "second uv" in have:
        more["TEXCOORD_1"] = file.vertices(mesh.uvs / np.maximum(mesh.uvs.max(0), 1))
    if "vertex colours" in have:
        wave = 0.6 + 0.4 * np.sin(4 * mesh.positions)
        more["COLOR_0"] = file.vertices(np.concatenate([images.codes(wave), np.full((len(wave), 1), 255, np.uint8)], 1),
                                        True)
    return more


def add_part(file, have, chance, triangles, exotic):
    """A mesh with a material of its own; returns the mesh's index and the scale of its nodes."""
    material = Material(file, have, chance, exotic).add()
    mesh = mesh_of_triangles(chance, triangles)
    if exotic and "quantized" in have:
        return file.mesh(quantized(file, mesh, material)), 2.0
    used = file.json["materials"][material]
    uvs = "texture" in str(used).lower() or bool(chance.integers(2))
    more = more_attributes(file, mesh, have) if exotic else {}
    normals = "no normals" not in have
    return file.mesh(file.mesh_of(mesh, material, normals, normals and "tangents" in have, uvs, more)), 1.0


def add_camera(file, name="Camera", angle=0.6, distance=6.0, height=2.0):
    """A perspective camera around the origin, `angle` [rad] to the right."""
    down = math.atan2(height, distance)
    a, b = angle / 2, -down / 2
    turn = [math.cos(a) * math.sin(b), math.sin(a) * math.cos(b), -math.sin(a) * math.sin(b), math.cos(a) * math.cos(b)]
    camera = file.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1, "aspectRatio": 1}})
    place = [distance * math.sin(angle), height, distance * math.cos(angle)]
    file.node(name=name, camera=camera, translation=place, rotation=turn)


def add_lights(file):
    key = file.light(type="directional", intensity=3.0, color=[1, 0.95, 0.9])
    file.node(name="Sun", extensions=key, rotation=[-0.38, 0.1, 0.05, 0.92])
    lamp = file.light(type="point", intensity=20.0)
    file.node(name="Lamp", extensions=lamp, translation=[-2, 2.5, 2])
    spot = file.light(type="spot", intensity=30.0, spot={"innerConeAngle": 0.3, "outerConeAngle": 0.5})
    file.node(name="Spot", extensions=spot, translation=[0, 3, 0], rotation=[-0.7071, 0, 0, 0.7071])


def small_model(index, have):
    file, chance = ModelFile(), np.random.default_rng(index)
    parts = int(chance.choice([1, 2, 3, 4, 6], p=[0.5, 0.2, 0.12, 0.1, 0.08]))
    triangles = 200 * 25 ** chance.random()
    root = file.node(name=f"Model {index}", scale=[round(10 ** chance.uniform(-1, 1), 3)] * 3)
    for part in range(parts):
        mesh, scale = add_part(file, have, chance, triangles / parts, part == 0)
        around = 2 * math.pi * part / parts
        place = [0, 0, 0] if parts == 1 else [1.6 * math.sin(around), 0, 1.6 * math.cos(around)]
        file.node(root, name=f"Part {part}", mesh=mesh, translation=place, scale=[scale] * 3)
        if part == 0 and "instances" in have:
            for copy in range(1, 6):
                half = 0.4 * copy
                file.node(root, name=f"Copy {copy}", mesh=mesh, translation=[place[0], 2.1 * copy, place[2]],
                          rotation=[0, math.sin(half), 0, math.cos(half)], scale=[scale * (1 - 0.1 * copy)] * 3)
    if "camera" in have:
        add_camera(file)
    if "lights" in have:
        add_lights(file)
    return file


# --- Large models ----------------------------------------------------------------------------------------------------


def textured():
    file = ModelFile()
    height, tint = images.mosaic(1024, 1)
    rough = np.stack([images.codes(np.ones_like(tint)), images.codes(0.2 + 0.5 * tint), images.codes(tint > 0.6)], -1)
    numbers = {"baseColorTexture": {"index": file.picture(images.colors(tint, ((50, 45, 40), (30, 110, 100),
                                                                               (220, 180, 70), (190, 70, 50))), True)},
               "metallicRoughnessTexture": {"index": file.picture(rough)}}
    normals = {"index": file.picture(images.normals(height, 0.004))}
    material = file.material(pbrMetallicRoughness=numbers, normalTexture=normals)
    file.node(name="Knot", mesh=file.mesh(file.mesh_of(shapes.knot(500, 100), material)))
    return file


def animation(file, channels):
    """Values at the times of all frames, by node and path."""
    times = file.bounded(np.arange(FRAMES, dtype=np.float32).reshape(-1, 1) / np.float32(RATE))
    item = {"name": "Action", "samplers": [], "channels": []}
    for (node, path), values in channels.items():
        item["channels"].append({"sampler": len(item["samplers"]), "target": {"node": node, "path": path}})
        item["samplers"].append({"input": times, "output": file.array(np.ascontiguousarray(values, np.float32))})
    file.add("animations", item)


def turns(angles, axis):
    """Quaternions about an axis."""
    rows = np.zeros((len(angles), 4))
    rows[:, axis], rows[:, 3] = np.sin(angles / 2), np.cos(angles / 2)
    return rows


def skinned():
    file, joints, length = ModelFile(), 8, 4.0
    step = length / joints

    def point(u, v):
        around, radius = 2 * np.pi * u, 0.3 * np.sqrt(np.clip(1.02 - v, 1e-4, 1)) * (1 + 0.06 * np.sin(60 * v))
        return np.stack([radius * np.sin(around), length * v, radius * np.cos(around)], -1)

    mesh = shapes.sheet(point, 100, 150, (1, 4))
    at = np.clip(mesh.positions[:, 1] / step, 0, joints - 1.001)
    lower = at.astype(int)
    names = np.zeros((len(at), 4), np.uint8)
    names[:, 0], names[:, 1] = lower, lower + 1
    weights = np.zeros((len(at), 4), np.float32)
    weights[:, 1] = at - lower
    weights[:, 0] = 1 - weights[:, 1]
    _, tint = images.weave(512, 3)
    material = file.material(pbrMetallicRoughness={
        "baseColorTexture": {"index": file.picture(images.colors(tint, ((40, 60, 90), (220, 200, 150))), True)},
        "metallicFactor": 0, "roughnessFactor": 0.5})
    more = {"JOINTS_0": file.vertices(names), "WEIGHTS_0": file.vertices(weights)}
    index = file.mesh(file.mesh_of(mesh, material, more=more))
    nodes = []
    for joint in range(joints):
        nodes.append(file.node(nodes[-1] if nodes else None, name=f"Joint {joint}",
                               translation=[0, step if joint else -length / 2, 0]))
    inverse = np.tile(np.eye(4, dtype=np.float32), (joints, 1, 1))
    inverse[:, 3, 1] = -step * np.arange(joints)  # Columns of the matrix are rows of the array.
    skin = file.add("skins", {"joints": nodes, "inverseBindMatrices": file.array(inverse)})
    file.node(name="Stalk", mesh=index, skin=skin)
    phase = 2 * np.pi * np.arange(FRAMES) / FRAMES
    animation(file, {(node, "rotation"): turns(0.2 * np.sin(phase + 0.6 * joint), 2)
                     for joint, node in enumerate(nodes)})
    add_camera(file, distance=9.0, height=4.0, angle=0.3)
    return file


def moving():
    """Half of the triangles are hills, a tenth each five knots; the ring has four thousand more."""
    file = ModelFile()
    paint = [file.material(pbrMetallicRoughness={"baseColorFactor": [*rgb, 1], "metallicFactor": 0,
                                                 "roughnessFactor": rough})
             for rgb, rough in (((0.35, 0.45, 0.3), 0.9), ((0.7, 0.3, 0.2), 0.4), ((0.8, 0.7, 0.3), 0.2))]
    file.node(name="Hills", mesh=file.mesh(file.mesh_of(shapes.ground(500, 500, 10, 0.25), paint[0], uvs=False)))
    for which in range(5):
        angle = 2 * math.pi * which / 5
        knot = shapes.knot(500, 100, 2, 2 * (which % 3) + 1, 0.2).moved(
            (2.6 * math.sin(angle), 0.7, 2.6 * math.cos(angle)), 0.7)
        file.node(name=f"Knot {which}", mesh=file.mesh(file.mesh_of(knot, paint[1], uvs=False)))
    ring = file.node(name="Ring", scale=[0.5] * 3,
                     mesh=file.mesh(file.mesh_of(shapes.torus(80, 25), paint[2], uvs=False)))
    phase = 2 * np.pi * np.arange(FRAMES) / FRAMES
    place = np.stack([1.2 * np.sin(phase), 0.9 + 0.2 * np.sin(3 * phase), 1.2 * np.cos(phase)], -1)
    animation(file, {(ring, "translation"): place, (ring, "rotation"): turns(phase, 0)})
    add_camera(file, distance=7.0, height=4.0)
    return file


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    parser.add_argument("--features", action="store_true", help="print how many small models have which feature")
    options = parser.parse_args()
    (options.folder / "models").mkdir(parents=True, exist_ok=True)
    for name, make in (("textured-100k", textured), ("skinned", skinned), ("moving", moving)):
        make().write_binary(options.folder / f"{name}.glb")
    all_features = features()
    for index, have in enumerate(all_features):
        small_model(index, have).write_binary(options.folder / "models" / f"{index:03}.glb")
    if options.features:
        for name in SHARES:
            print(f"{sum(name in have for have in all_features):4} {name}")


if __name__ == "__main__":
    main()
