"""Writes arrays and pictures into a .glb, for make_models.py."""

import io
import sys
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "gltf"))

import gltf_file  # noqa: E402 (needs the path)

INDICES, VERTICES = gltf_file.INDICES, gltf_file.VERTICES
COMPONENTS = {"int8": 5120, "uint8": 5121, "int16": 5122, "uint16": 5123, "uint32": 5125, "float32": 5126}


class ModelFile(gltf_file.GltfFile):
    def __init__(self):
        super().__init__()
        self.json["asset"]["generator"] = "candela: tests/bench/scenes/make_models.py"

    def array(self, values, target=None, normalized=False):
        """An accessor of rows, in a view of its own; rows of vertices are padded to four bytes."""
        rows = values.reshape(len(values), -1)
        size = rows.itemsize * rows.shape[1]
        padding = -size % 4 if target == VERTICES else 0
        data = np.concatenate([rows.view(np.uint8).reshape(len(rows), -1), np.zeros((len(rows), padding), np.uint8)], 1)
        kind = "MAT4" if values.shape[1:] == (4, 4) else gltf_file.TYPES[rows.shape[1]]
        item = {"bufferView": self.view(data.tobytes(), target, size + padding if padding else None),
                "componentType": COMPONENTS[str(values.dtype)], "count": len(values), "type": kind}
        if normalized:
            item["normalized"] = True
        return self.add("accessors", item)

    def bounded(self, values, target=None, normalized=False):
        """The same with the bounds that positions and times must have."""
        index = self.array(values, target, normalized)
        item = self.json["accessors"][index]
        rows = values.reshape(len(values), -1)
        item["min"], item["max"] = rows.min(0).tolist(), rows.max(0).tolist()
        return index

    def vertices(self, values, normalized=False):
        return self.array(np.ascontiguousarray(values), VERTICES, normalized)

    def indices(self, triangles):
        """In the smallest of glTF's types."""
        largest = triangles.max()
        kind = np.uint8 if largest < 255 else np.uint16 if largest < 65535 else np.uint32
        return self.array(np.ascontiguousarray(triangles.reshape(-1, 1), kind), INDICES)

    def mesh_of(self, mesh, material, normals=True, tangents=False, uvs=True, more=None):
        """A primitive with these attributes of the mesh, and with more accessors by name."""
        attributes = {"POSITION": self.bounded(mesh.positions, VERTICES)}
        if normals:
            attributes["NORMAL"] = self.vertices(mesh.normals)
        if tangents:
            attributes["TANGENT"] = self.vertices(mesh.tangents)
        if uvs:
            attributes["TEXCOORD_0"] = self.vertices(mesh.uvs)
        return {"attributes": attributes | (more or {}), "indices": self.indices(mesh.triangles), "material": material}

    def picture(self, pixels, jpeg=False):
        """A texture of bytes of the shape height x width x channels."""
        data = io.BytesIO()
        image = Image.fromarray(pixels[..., 0] if pixels.shape[-1] == 1 else pixels)
        if jpeg:
            image.save(data, "JPEG", quality=88)
        else:
            image.save(data, "PNG", compress_level=6)
        self.binary += bytes(-len(self.binary) % 4)
        image = self.add("images", {"bufferView": self.view(data.getvalue()),
                                    "mimeType": "image/jpeg" if jpeg else "image/png"})
        sampler = {"magFilter": 9729, "minFilter": 9987}
        if sampler not in self.json.setdefault("samplers", []):
            self.json["samplers"].append(sampler)
        return self.add("textures", {"source": image, "sampler": self.json["samplers"].index(sampler)})
