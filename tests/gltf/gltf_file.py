"""A writer of glTF 2.0 files: values in; accessors, images, materials and nodes out.

A file is written as .glb, as .gltf with its files beside it, and as .gltf that contains all.
"""

import base64
import json
import struct
from urllib.parse import quote

import ktx

# Number of glTF, letter of struct, bytes; of each kind of component.
COMPONENTS = {"i8": (5120, "b", 1), "u8": (5121, "B", 1), "i16": (5122, "h", 2), "u16": (5123, "H", 2),
              "u32": (5125, "I", 4), "f32": (5126, "f", 4)}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
VERTICES, INDICES = 34962, 34963  # What a view is for.
NEAREST, LINEAR = 9728, 9729
REPEAT, MIRROR, CLAMP = 10497, 33648, 33071
POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, STRIP, FAN = range(7)


def media_type(image):
    return "image/ktx2" if image.startswith(ktx.SIGNATURE) else "image/png"


def data_uri(kind, data):
    return f"data:{kind};base64,{base64.b64encode(data).decode('ascii')}"


class GltfFile:
    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "candela: tests/gltf/make_models.py"},
                     "scene": 0, "scenes": [{"nodes": []}]}
        self.binary = bytearray()
        self.images = []  # The bytes of each: a PNG or a KTX 2 file.
        self.used, self.required = set(), set()  # Extensions.
        self.samplers = {}

    def add(self, kind, item):
        """Appends an item to a top-level array; its index."""
        items = self.json.setdefault(kind, [])
        items.append(item)
        return len(items) - 1

    # --- Bytes ------------------------------------------------------------------------------------------------------

    def view(self, data, target=None, stride=None):
        self.binary += bytes(-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if stride:
            view["byteStride"] = stride
        if target:
            view["target"] = target
        self.binary += data
        return self.add("bufferViews", view)

    def accessor(self, rows, component="f32", normalized=False, target=None, bounds=False):
        """An accessor in a view of its own; rows are numbers or tuples. Vertices are padded to four bytes."""
        number, letter, _ = COMPONENTS[component]
        rows = [row if isinstance(row, (tuple, list)) else (row,) for row in rows]
        packed = [struct.pack(f"<{len(row)}{letter}", *row) for row in rows]
        size = len(packed[0])
        stride = size + -size % 4 if target == VERTICES else size
        data = b"".join(row + bytes(stride - size) for row in packed)
        item = {"bufferView": self.view(data, target, stride if stride != size else None), "componentType": number,
                "count": len(rows), "type": TYPES[len(rows[0])]}
        if normalized:
            item["normalized"] = True
        if bounds:
            stored = list(zip(*(struct.unpack(f"<{len(row)}{letter}", data) for row, data in zip(rows, packed))))
            item["min"], item["max"] = [min(c) for c in stored], [max(c) for c in stored]
        return self.add("accessors", item)

    def attributes(self, attributes):
        """Accessors of vertices by name; a value is an index, rows of floats, or (rows, component, normalized)."""
        result = {}
        for name, value in attributes.items():
            if isinstance(value, tuple):
                rows, component, normalized = value
                value = self.accessor(rows, component, normalized, VERTICES, name == "POSITION")
            elif isinstance(value, list):
                value = self.accessor(value, target=VERTICES, bounds=name == "POSITION")
            result[name] = value
        return result

    def primitive(self, attributes, indices=None, material=None, mode=None, targets=None, component="u16"):
        """A primitive; targets are attributes of morph targets, each a dictionary."""
        item = {"attributes": self.attributes(attributes)}
        if indices is not None:
            item["indices"] = self.accessor(indices, component, target=INDICES)
        if material is not None:
            item["material"] = material
        if mode is not None:
            item["mode"] = mode
        if targets:
            item["targets"] = [self.attributes(target) for target in targets]
        return item

    # --- Materials --------------------------------------------------------------------------------------------------

    def image(self, data):
        self.images.append(data)
        return self.add("images", {})

    def texture(self, data, mag=NEAREST, wrap=(REPEAT, REPEAT), source=None):
        """A texture of an image's bytes, or of an image that is there already."""
        key = (mag, *wrap)
        if key not in self.samplers:
            smaller = NEAREST if mag == NEAREST else LINEAR
            self.samplers[key] = self.add("samplers", {"magFilter": mag, "minFilter": smaller, "wrapS": wrap[0],
                                                       "wrapT": wrap[1]})
        item = {"source": self.image(data) if source is None else source}
        if media_type(self.images[item["source"]]) == "image/ktx2":
            self.required.add("KHR_texture_basisu")
            item = {"extensions": {"KHR_texture_basisu": item}}
        return self.add("textures", {"sampler": self.samplers[key], **item})

    def material(self, extensions=None, required=(), **properties):
        """A material; extensions by name without KHR_materials_. What is in `required` must be understood."""
        item = dict(properties)
        if extensions:
            item["extensions"] = {f"KHR_materials_{name}": value for name, value in extensions.items()}
            self.used.update(item["extensions"])
        self.required.update(required)
        return self.add("materials", item)

    # --- Nodes ------------------------------------------------------------------------------------------------------

    def mesh(self, *primitives, **properties):
        return self.add("meshes", {"primitives": list(primitives), **properties})

    def node(self, parent=None, root=True, **properties):
        """A node, child of another one or of the scene; with root false, of none yet."""
        index = self.add("nodes", properties)
        if parent is not None:
            self.json["nodes"][parent].setdefault("children", []).append(index)
        elif root:
            self.scene_nodes().append(index)
        return index

    def scene_nodes(self):
        return self.json["scenes"][self.json["scene"]]["nodes"]

    def light(self, **properties):
        """A punctual light, to be named by a node."""
        self.used.add("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(properties)
        return {"KHR_lights_punctual": {"light": len(lights) - 1}}

    # --- Files ------------------------------------------------------------------------------------------------------

    def document(self):
        """The JSON without buffers' and images' places, in the order of the specification."""
        document = {"asset": self.json["asset"]}
        if self.used | self.required:
            document["extensionsUsed"] = sorted(self.used | self.required)
        if self.required:
            document["extensionsRequired"] = sorted(self.required)
        return json.loads(json.dumps({**document, **self.json}))  # A copy.

    def write_binary(self, path):
        document, binary = self.document(), bytearray(self.binary)
        for image, data in zip(document.get("images", []), self.images):
            binary += bytes(-len(binary) % 4)
            document["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            image.update(bufferView=len(document["bufferViews"]) - 1, mimeType=media_type(data))
            binary += data
        binary += bytes(-len(binary) % 4)
        document["buffers"] = [{"byteLength": len(binary)}]
        text = json.dumps(document, separators=(",", ":")).encode("ascii")
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)

    def write_separate(self, path):
        document = self.document()
        binary = path.with_suffix(".bin")
        binary.write_bytes(self.binary)
        document["buffers"] = [{"byteLength": len(self.binary), "uri": quote(binary.name)}]
        for index, (image, data) in enumerate(zip(document.get("images", []), self.images)):
            kind, space = media_type(data).removeprefix("image/"), " " if " " in path.stem else "_"
            picture = path.with_name(f"{path.stem}{space}{index}.{kind}")
            picture.write_bytes(data)
            image["uri"] = quote(picture.name)
        path.write_text(json.dumps(document, indent=2) + "\n", encoding="ascii")

    def write_embedded(self, path):
        document = self.document()
        uri = data_uri("application/octet-stream", bytes(self.binary))
        document["buffers"] = [{"byteLength": len(self.binary), "uri": uri}]
        for image, data in zip(document.get("images", []), self.images):
            image["uri"] = data_uri(media_type(data), data)
        path.write_text(json.dumps(document, indent=2) + "\n", encoding="ascii")

    def write(self, model_folder, containers):
        """Writes the file in the layout of Khronos' sample assets, once for each container."""
        name = model_folder.name
        ways = {"glTF-Binary": (self.write_binary, ".glb"), "glTF": (self.write_separate, ".gltf"),
                "glTF-Embedded": (self.write_embedded, ".gltf")}
        for container in containers:
            folder = model_folder / container
            folder.mkdir(parents=True, exist_ok=True)
            way, extension = ways[container]
            way(folder / (name + extension))
