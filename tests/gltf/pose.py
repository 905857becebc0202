"""The triangles of a glTF file at a time of an animation, in double precision.

Written from the specification (glTF 2.0, sections 3.5 to 3.7, 3.11 and appendix C), and not from candela's loader.
Needs numpy. Weights of skins are divided by their sum; a mesh that its node's transform flattens is left out
(docs/gltf.md).
"""

import base64
import json
import struct
from pathlib import Path
from urllib.parse import unquote

import numpy as np

DTYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
WIDEST = {5120: 127.0, 5121: 255.0, 5122: 32767.0, 5123: 65535.0}  # What 1 is, of normalised integers.


class File:
    def __init__(self, path):
        self.path, self.chunk = Path(path), b""
        data = self.path.read_bytes()
        if data.startswith(b"glTF"):
            size = struct.unpack_from("<I", data, 12)[0]
            self.chunk, data = data[28 + size:], data[20:20 + size]
        self.json = json.loads(data.decode("utf-8").rstrip("\0"))
        self.buffers = {}

    def items(self, key):
        return self.json.get(key, [])

    def buffer(self, index):
        if index not in self.buffers:
            uri = self.json["buffers"][index].get("uri")
            if uri is None:
                self.buffers[index] = self.chunk
            elif uri.startswith("data:"):
                self.buffers[index] = base64.b64decode(uri.split(",", 1)[1] + "==")
            else:
                self.buffers[index] = (self.path.parent / unquote(uri)).read_bytes()
        return self.buffers[index]

    def rows(self, view_index, offset, count, width, dtype):
        view = self.json["bufferViews"][view_index]
        size = width * np.dtype(dtype).itemsize
        start, stride = view.get("byteOffset", 0) + offset, view.get("byteStride", size)
        data = self.buffer(view["buffer"])
        rows = [np.frombuffer(data, dtype, width, start + i * stride) for i in range(count)] if stride != size else \
            np.frombuffer(data, dtype, count * width, start).reshape(count, width)
        return np.array(rows)

    def accessor(self, index):
        """Rows of numbers: doubles, integers of indices and joints included."""
        a = self.json["accessors"][index]
        width, dtype, count = WIDTHS[a["type"]], DTYPES[a["componentType"]], a["count"]
        if "bufferView" in a:
            values = self.rows(a["bufferView"], a.get("byteOffset", 0), count, width, dtype).astype(np.float64)
        else:
            values = np.zeros((count, width))
        if "sparse" in a:
            s = a["sparse"]
            at = self.rows(s["indices"]["bufferView"], s["indices"].get("byteOffset", 0), s["count"], 1,
                           DTYPES[s["indices"]["componentType"]])
            values[at[:, 0].astype(np.int64)] = self.rows(s["values"]["bufferView"], s["values"].get("byteOffset", 0),
                                                          s["count"], width, dtype)
        if a.get("normalized") and a["componentType"] in WIDEST:
            values = np.maximum(values / WIDEST[a["componentType"]], -1.0)
        return values


# --- Animations -------------------------------------------------------------------------------------------------------


def slerp(a, b, t):
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    cosine = a @ b
    b, cosine = (-b, -cosine) if cosine < 0 else (b, cosine)
    angle = np.arctan2(np.linalg.norm(b - cosine * a), cosine)
    if angle < 1e-9:
        return a + t * (b - a)
    return (np.sin((1 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle)


def sample(file, sampler, time, path):
    times = file.accessor(sampler["input"])[:, 0]
    mode = sampler.get("interpolation", "LINEAR")
    values = file.accessor(sampler["output"]).reshape(len(times), 3 if mode == "CUBICSPLINE" else 1, -1)
    middle = values[:, 1] if mode == "CUBICSPLINE" else values[:, 0]
    if time <= times[0] or time >= times[-1]:
        return middle[0 if time <= times[0] else -1]
    k = int(np.searchsorted(times, time, side="right")) - 1
    step = times[k + 1] - times[k]
    t = (time - times[k]) / step
    if mode == "STEP":
        return middle[k]
    if mode == "LINEAR":
        a, b = middle[k], middle[k + 1]
        return slerp(a, b, t) if path == "rotation" else a + t * (b - a)
    v0, b0, a1, v1 = values[k, 1], values[k, 2], values[k + 1, 0], values[k + 1, 1]
    return (2 * t**3 - 3 * t**2 + 1) * v0 + step * (t**3 - 2 * t**2 + t) * b0 + \
        (-2 * t**3 + 3 * t**2) * v1 + step * (t**3 - t**2) * a1


def animate(file, nodes, animation, time):
    for channel in animation["channels"]:
        target = channel["target"]
        if "node" not in target or target["path"] not in ("translation", "rotation", "scale", "weights"):
            continue
        node = nodes[target["node"]]
        if target["path"] != "weights":
            node.pop("matrix", None)
        node[target["path"]] = sample(file, animation["samplers"][channel["sampler"]], time, target["path"])


def duration(file, animation):
    """The times of the first and the last key."""
    times = [file.accessor(s["input"])[:, 0] for s in animation["samplers"]]
    return min(t[0] for t in times), max(t[-1] for t in times)


# --- Nodes ------------------------------------------------------------------------------------------------------------


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    rotation = np.array(node.get("rotation", (0, 0, 0, 1)))
    if not rotation.any():
        raise ValueError("a rotation of length 0")
    x, y, z, w = rotation / np.linalg.norm(rotation)
    matrix = np.identity(4)
    matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    matrix[:3, :3] *= np.array(node.get("scale", (1, 1, 1)))
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def world_matrices(nodes):
    parents = {child: i for i, node in enumerate(nodes) for child in node.get("children", [])}
    worlds = {}

    def world(i):
        if i not in worlds:
            worlds[i] = world(parents[i]) @ local_matrix(nodes[i]) if i in parents else local_matrix(nodes[i])
        return worlds[i]

    return [world(i) for i in range(len(nodes))], parents


def shown(file, nodes, parents, scene):
    """The indices of the nodes that a scene shows."""
    scenes = file.items("scenes")
    index = file.json.get("scene", 0) if scene is None else scene
    waiting = list(scenes[index].get("nodes", [])) if scenes else [i for i in range(len(nodes)) if i not in parents]
    while waiting:
        i = waiting.pop()
        if nodes[i].get("extensions", {}).get("KHR_node_visibility", {}).get("visible", True):
            yield i
            waiting += nodes[i].get("children", [])


def placed(file, node, world):
    """The matrices from a node's mesh to the world: one, or those of EXT_mesh_gpu_instancing."""
    extension = node.get("extensions", {}).get("EXT_mesh_gpu_instancing")
    if extension is None or "skin" in node:  # A skinned mesh is where its joints are.
        return [world]
    rows = {name.lower(): file.accessor(i) for name, i in extension["attributes"].items() if not name.startswith("_")}
    return [world @ local_matrix(dict(zip(rows, values))) for values in zip(*rows.values(), strict=True)]


# --- Meshes -----------------------------------------------------------------------------------------------------------


def corners(file, primitive, vertices):
    indices = np.arange(vertices)
    if "indices" in primitive:
        indices = file.accessor(primitive["indices"])[:, 0].astype(np.int64)
    mode, n = primitive.get("mode", 4), len(indices)
    if mode == 4:
        return indices[:n // 3 * 3].reshape(-1, 3)
    order = [(i, i + 1 + i % 2, i + 2 - i % 2) if mode == 5 else (i + 1, i + 2, 0) for i in range(n - 2)]
    return indices[np.array(order, dtype=np.int64).reshape(-1, 3)]


def morphed(file, primitive, name, weights):
    if name not in primitive["attributes"]:
        return None
    values = file.accessor(primitive["attributes"][name])
    for target, weight in zip(primitive.get("targets", []), weights):
        if name in target:
            values = values + weight * file.accessor(target[name])
    return values


def blended(file, primitive, joints):
    """A matrix for each vertex: the mean of its joints'."""
    total, matrices, n = 0.0, 0.0, 0
    while f"JOINTS_{n}" in primitive["attributes"]:
        which = file.accessor(primitive["attributes"][f"JOINTS_{n}"]).astype(np.int64)
        weights = file.accessor(primitive["attributes"][f"WEIGHTS_{n}"])
        which = np.where(weights > 0, which, 0)
        matrices = matrices + np.einsum("vk,vkij->vij", weights, joints[which])
        total, n = total + weights.sum(axis=1), n + 1
    if not np.all(total > 0):
        raise ValueError("a vertex that follows no joint")
    return matrices / total[:, None, None]


def skinned(file, node, primitive, worlds):
    """A matrix for each vertex, to the world."""
    skin = file.items("skins")[node["skin"]]
    joints = np.array([worlds[j] for j in skin["joints"]])
    if "inverseBindMatrices" in skin:
        inverse = file.accessor(skin["inverseBindMatrices"])[:len(joints)].reshape(-1, 4, 4)
        joints = joints @ inverse.transpose(0, 2, 1)
    return blended(file, primitive, joints)


def posed(file, primitive, weights, position, matrices, mirrored=False):
    """The triangles of a primitive, whose vertices go to the world by a matrix each."""
    vertices = np.full((len(position), 8), np.nan)
    vertices[:, :3] = np.einsum("vij,vj->vi", matrices[:, :3, :3], position) + matrices[:, :3, 3]
    normal = morphed(file, primitive, "NORMAL", weights)
    if normal is not None:
        turned = np.linalg.solve(matrices[:, :3, :3].transpose(0, 2, 1), normal[:, :, None])[:, :, 0]
        with np.errstate(invalid="ignore"):
            vertices[:, 3:6] = turned / np.linalg.norm(turned, axis=1, keepdims=True)
    uv = morphed(file, primitive, "TEXCOORD_0", weights)
    if uv is not None:
        vertices[:, 6:] = uv * (1, -1) + (0, 1)
    faces = corners(file, primitive, len(position))
    return vertices[faces[:, ::-1] if mirrored else faces]


def triangles(path, animation=None, time=None, scene=None):
    """As in triangles.py."""
    file = File(path)
    nodes = [dict(node) for node in file.items("nodes")]
    if animation is not None:
        animate(file, nodes, file.items("animations")[animation], time)
    worlds, parents = world_matrices(nodes)
    parts = [np.zeros((0, 3, 8))]
    for i in shown(file, nodes, parents, scene):
        if "mesh" not in nodes[i]:
            continue
        mesh = file.items("meshes")[nodes[i]["mesh"]]
        weights = nodes[i].get("weights", mesh.get("weights", []))
        places = placed(file, nodes[i], worlds[i])
        for primitive in mesh["primitives"]:
            position = morphed(file, primitive, "POSITION", weights)
            if position is None or primitive.get("mode", 4) < 4:
                continue
            if "skin" in nodes[i]:
                parts.append(posed(file, primitive, weights, position, skinned(file, nodes[i], primitive, worlds),
                                   np.linalg.det(worlds[i][:3, :3]) < 0))
                continue
            for world in places:
                edges = np.linalg.norm(world[:3, :3], axis=0)
                determinant = np.linalg.det(world[:3, :3])
                if abs(determinant) > 1e-12 * edges.prod():
                    matrices = np.broadcast_to(world, (len(position), 4, 4))
                    parts.append(posed(file, primitive, weights, position, matrices, determinant < 0))
    return np.concatenate(parts)
