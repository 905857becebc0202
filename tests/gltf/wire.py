"""Makes the scene of a glTF document show everything that is in it, so that a reader has to read it.

Whatever nothing refers to gets a use that fits: a node for a mesh, a mesh for a material, a material for a texture, and
so on. What is added comes after what is there, so that no pointer changes.
"""

import copy
import struct

import png
import reach
from gltf_file import data_uri

ATTRIBUTES = {"VEC2": "TEXCOORD_0", "VEC3": "POSITION", "VEC4": "COLOR_0"}
UNSIGNED = (5121, 5123, 5125)
PIXEL = png.write(1, 1, 4, bytes((128, 128, 255, 128)))  # A colour, a normal, and an opacity.
LOST = 1 << 20  # What an index that names nothing is raised by, so that nothing that is added takes its place.


def usable(document, array):
    items = document.get(array)
    return items if isinstance(items, list) else []


class Wirer:
    def __init__(self, document, seen, binary):
        self.document, self.seen, self.binary = copy.deepcopy(document), seen, binary
        self.roots = []

    def add(self, array, item):
        items = self.document.setdefault(array, [])
        items.append(item)
        return len(items) - 1

    def unused(self, array):
        return [i for i, item in enumerate(usable(self.document, array))
                if isinstance(item, dict) and f"/{array}/{i}" not in self.seen]

    def bytes(self, data):
        buffer = self.add("buffers", {"byteLength": len(data), "uri": data_uri("application/octet-stream", data)})
        return self.add("bufferViews", {"buffer": buffer, "byteLength": len(data)})

    def points(self, count):
        """Positions of which no three lie on a line."""
        return self.bytes(b"".join(struct.pack("<3f", i, i * i / count, 0) for i in range(count)))

    def triangle(self, count=3, **attributes):
        position = self.add("accessors", {"bufferView": self.points(count), "componentType": 5126, "count": count,
                                          "type": "VEC3", "min": [0, 0, 0], "max": [count, count, 0]})
        return {"attributes": {"POSITION": position, **attributes}}

    def floats(self, kind, rows):
        data = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
        return self.add("accessors", {"bufferView": self.bytes(data), "componentType": 5126, "count": len(rows),
                                      "type": kind})

    def show(self, primitive):
        self.roots.append(self.add("nodes", {"mesh": self.add("meshes", {"primitives": [primitive]})}))

    def show_material(self, material):
        uv = self.floats("VEC2", [(0, 0), (1, 0), (1, 1)])
        normal = self.floats("VEC3", [(0, 0, 1)] * 3)
        self.show({**self.triangle(TEXCOORD_0=uv, TEXCOORD_1=uv, NORMAL=normal), "material": material})

    def show_texture(self, texture):
        self.show_material(self.add("materials", {"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}))

    def show_accessor(self, index):
        """In one of the uses that its type allows; matrices of 2 or 3 columns have none."""
        accessor = self.document["accessors"][index]
        count = accessor.get("count", 3)
        count = count if isinstance(count, int) and 0 < count < 1000 else 3
        kind = accessor.get("type", "VEC3")
        if kind == "MAT4":
            self.show_skin({"joints": [0] * count, "inverseBindMatrices": index})
        elif kind == "SCALAR" and accessor.get("componentType") in UNSIGNED and not accessor.get("normalized"):
            self.show({**self.triangle(256), "indices": index})
        elif kind == "SCALAR":
            self.animate_weights(count, index)
        elif kind == "VEC3" or kind not in (*ATTRIBUTES, "MAT2", "MAT3"):
            # A triangle at one point, if there are not enough.
            corners = {} if count >= 3 else {"indices": self.add("accessors", {
                "bufferView": self.bytes(bytes(3)), "componentType": 5121, "count": 3, "type": "SCALAR"})}
            self.show({"attributes": {"POSITION": index}, **corners})
        elif kind in ATTRIBUTES:
            self.show(self.triangle(count, **{ATTRIBUTES[kind]: index}))

    def animate_weights(self, count, values):
        self.roots.append(self.add("nodes", {}))
        times = self.floats("SCALAR", [(i,) for i in range(count)])
        self.add("animations", {"samplers": [{"input": times, "output": values}],
                                "channels": [{"sampler": 0, "target": {"node": self.roots[-1], "path": "weights"}}]})

    def show_byte(self, view):
        """The first byte of a view, as a weight."""
        self.animate_weights(1, self.add("accessors", {"bufferView": view, "componentType": 5120, "normalized": True,
                                                       "count": 1, "type": "SCALAR"}))

    def show_skin(self, skin):
        joints = self.add("accessors", {"bufferView": self.bytes(bytes(12)), "componentType": 5121, "count": 3,
                                        "type": "VEC4"})
        weights = self.floats("VEC4", [(1, 0, 0, 0)] * 3)
        if not usable(self.document, "nodes"):
            self.roots.append(self.add("nodes", {}))
        index = skin if isinstance(skin, int) else self.add("skins", skin)
        mesh = self.add("meshes", {"primitives": [self.triangle(JOINTS_0=joints, WEIGHTS_0=weights)]})
        self.roots.append(self.add("nodes", {"mesh": mesh, "skin": index}))

    def show_all(self):
        for i in self.unused("meshes"):
            weights = {} if "weights" in self.document["meshes"][i] else self.weights(self.document["meshes"][i])
            node = self.add("nodes", {"mesh": i, **weights})
            self.roots.append(node)
            if "JOINTS_0" in str(self.document["meshes"][i]):
                self.document["nodes"][node]["skin"] = self.add("skins", {"joints": [node] * 4})
        for i in self.unused("cameras"):
            self.roots.append(self.add("nodes", {"camera": i}))
        for i in self.unused("skins"):
            self.show_skin(i)
        lights = (self.document.get("extensions") or {}).get("KHR_lights_punctual") or {}
        for i in range(len(lights.get("lights", []))):
            if f"/extensions/KHR_lights_punctual/lights/{i}" not in self.seen:
                self.roots.append(self.add("nodes", {"extensions": {"KHR_lights_punctual": {"light": i}}}))

    def weights(self, mesh):
        """Weights for the morph targets of a mesh that has none."""
        primitives = mesh.get("primitives")
        first = primitives[0] if isinstance(primitives, list) and primitives else {}
        targets = first.get("targets") if isinstance(first, dict) else None
        return {"weights": [0.5] * len(targets)} if isinstance(targets, list) and targets else {}

    def complete(self):
        """Gives values to what the validator allows to have none: buffers, textures, and accessors that are zero."""
        for i, buffer in enumerate(usable(self.document, "buffers")):
            size = buffer.get("byteLength") if isinstance(buffer, dict) else None
            if isinstance(size, int) and 0 < size < 1 << 20 and "uri" not in buffer and not (self.binary and i == 0):
                buffer["uri"] = data_uri("application/octet-stream", bytes(size))
        for texture in usable(self.document, "textures"):
            webp = texture.get("extensions", {}).get("EXT_texture_webp", {}) if isinstance(texture, dict) else {}
            if isinstance(texture, dict) and "source" not in texture and "source" not in webp:
                texture["source"] = self.add("images", {"uri": data_uri("image/png", PIXEL)})
        for mesh in usable(self.document, "meshes"):
            primitives = mesh.get("primitives") if isinstance(mesh, dict) else None
            for primitive in primitives if isinstance(primitives, list) else []:
                attributes = primitive.get("attributes") if isinstance(primitive, dict) else None
                if isinstance(attributes, dict):
                    primitive.update({"mode": 4} if primitive.get("mode", 4) < 4 else {})
                    self.fill(attributes.get("POSITION"), "VEC3", lambda i: (i, i * i / 100, 0))
                    self.fill(attributes.get("TANGENT"), "VEC4", lambda i: (1, 0, 0, 1))
        for skin in usable(self.document, "skins"):
            self.fill(skin.get("inverseBindMatrices"), "MAT4", lambda i: [int(k % 5 == 0) for k in range(16)])
        for animation in usable(self.document, "animations"):
            for sampler in animation.get("samplers", []):
                self.fill(sampler.get("input"), "SCALAR", lambda i: (i,))
                self.fill(sampler.get("output"), "VEC4", lambda i: (0, 0, 0, 1))

    def fill(self, index, kind, row):
        """Values in place of zeros, for an accessor of floats that has no others."""
        accessors = usable(self.document, "accessors")
        accessor = accessors[index] if isinstance(index, int) and index < len(accessors) else None
        if isinstance(accessor, dict) and (accessor.get("type"), accessor.get("componentType")) == (kind, 5126):
            if not {"bufferView", "sparse"} & set(accessor):
                rows = [row(i) for i in range(accessor["count"])]
                accessor["bufferView"] = self.bytes(b"".join(struct.pack(f"<{len(r)}f", *r) for r in rows))

    def show_parts(self):
        """Uses of what only an object can show."""
        for i in self.unused("images"):
            self.show_texture(self.add("textures", {"source": i}))
        for i in self.unused("samplers"):
            source = self.add("images", {"uri": data_uri("image/png", PIXEL)})
            self.show_texture(self.add("textures", {"source": source, "sampler": i}))
        for i in self.unused("accessors"):
            self.show_accessor(i)
        for i in self.unused("bufferViews"):
            self.show_byte(i)
        for i in self.unused("buffers"):
            self.show_byte(self.add("bufferViews", {"buffer": i, "byteLength": 1}))

    def finish(self):
        if not self.roots:
            return
        scenes = self.document.get("scenes")
        if not isinstance(scenes, list) or not scenes:
            nodes = usable(self.document, "nodes")
            children = {child for node in nodes for child in node.get("children", [])}
            self.document["scenes"] = [{"nodes": [i for i in range(len(nodes)) if i not in children]}]
            return
        chosen = scenes[self.document.get("scene", 0)]
        chosen["nodes"] = chosen.get("nodes", []) + self.roots


STEPS = [Wirer.complete, Wirer.show_all, lambda w: [w.show_material(i) for i in w.unused("materials")],
         lambda w: [w.show_texture(i) for i in w.unused("textures")], Wirer.show_parts]


def wired(document, seen_in, binary):
    """A copy of which the scene shows everything; seen_in(document) gives the objects that a document's scene shows.
    `binary`: the file has a chunk for its first buffer."""
    document = copy.deepcopy(document)
    for place in list(reach.pointers_within(document, "")):
        target = reach.target_of(document, place)
        if target and reach.value_at(document, target) is None:
            parent, key = place.rsplit("/", 1)
            parent = reach.value_at(document, parent)
            key = int(key) if isinstance(parent, list) else key.replace("~1", "/").replace("~0", "~")
            parent[key] += LOST
    for step in STEPS:
        wirer = Wirer(document, seen_in(document), binary)
        step(wirer)
        wirer.finish()
        document = wirer.document
    return document
