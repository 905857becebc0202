#!/usr/bin/env python3
"""Compresses the conformance models: writes streams.json, which holds what the encoders made, so that no test needs them.

usage: compress.py

Needs DracoPy, meshoptimizer and numpy (PyPI). compressed(data, way) makes a .glb of a .glb, with `way` one of WAYS:

    meshopt      EXT_meshopt_compression of all views whose elements are whole words
    draco        KHR_draco_mesh_compression of all primitives of floats, whose vertices get another order
    sequential   the same in the order of the file, as morph targets need it

A primitive or view that the encoder cannot compress stays as it is.
"""

import base64
import hashlib
import json
import struct
import sys
import tempfile
from pathlib import Path

from gltf_file import TRIANGLES

WAYS = ("meshopt", "draco", "sequential")
# Each with times at which it is posed; none: at rest.
MODELS = {"BoxInterleaved": (None,), "MeshQuantization": (None,), "SimpleSparseAccessor": (None,),
          "MeshPrimitiveModes": (None,), "MorphStressTest": (None, 0.3, 1.1), "SimpleSkin": (None, 0.4, 1.2),
          "InterpolationTest": (None, 0.6, 1.25)}
POSITION_BITS = 14
STREAMS = Path(__file__).with_name("streams.json")
SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
LETTERS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Stored:
    """Answers with what an encoder said earlier to the same request."""

    def __init__(self):
        self.answers = json.loads(STREAMS.read_text(encoding="ascii")) if STREAMS.exists() else {}

    def ask(self, request, data):
        """A stream, and further facts about it; none if the encoder had no answer."""
        key = hashlib.sha256(json.dumps(request).encode() + data).hexdigest()[:16]
        if key not in self.answers:
            sys.exit("streams.json lacks a stream: run compress.py")
        answer = self.answers[key]
        return answer and {**answer, "stream": base64.b64decode(answer["stream"])}


class Encoder(Stored):
    """Asks the encoders, and keeps their answers."""

    def __init__(self):
        super().__init__()
        self.old, self.answers = self.answers, {}

    def ask(self, request, data):
        key = hashlib.sha256(json.dumps(request).encode() + data).hexdigest()[:16]
        if key not in self.answers:
            answer = self.old.get(key, False)
            if answer is False:
                answer = encode_meshopt(request, data) if "mode" in request else encode_draco(request, data)
                answer = answer and {**answer, "stream": base64.b64encode(answer["stream"]).decode("ascii")}
            self.answers[key] = answer
        return super().ask(request, data)


def encode_meshopt(request, data):
    import meshoptimizer
    import numpy
    meshoptimizer.encode_vertex_version(0)  # What EXT_meshopt_compression allows.
    count, stride = request["count"], request["stride"]
    if request["mode"] == "ATTRIBUTES":
        return {"stream": bytes(meshoptimizer.encode_vertex_buffer(numpy.frombuffer(data, numpy.uint8), count, stride))}
    indices = numpy.frombuffer(data, numpy.uint16 if stride == 2 else numpy.uint32).astype(numpy.uint32)
    encode = (meshoptimizer.encode_index_buffer if request["mode"] == "TRIANGLES"
              else meshoptimizer.encode_index_sequence)
    return {"stream": bytes(encode(indices, count, int(indices.max()) + 1))}


def encode_draco(request, data):
    """`data` are the attributes in the order of the request, then the indices."""
    import DracoPy
    import numpy
    arrays, offset = {}, 0
    for name, component, width in request["attributes"]:
        kind = numpy.dtype(LETTERS[component])
        size = kind.itemsize * width * request["vertices"]
        arrays[name] = numpy.frombuffer(data[offset:offset + size], kind).reshape(-1, width).copy()
        offset += size
    faces = numpy.frombuffer(data[offset:], numpy.uint32).reshape(-1, 3)
    names = [name for name in arrays if name != "POSITION"]
    stream = DracoPy.encode(arrays["POSITION"], faces, quantization_bits=POSITION_BITS, compression_level=request["level"],
                            preserve_order=request["level"] == 0,
                            generic_attributes={i: arrays[name] for i, name in enumerate(names)})
    mesh = DracoPy.decode(stream)
    [position] = [a["unique_id"] for a in mesh.attributes if a["attribute_type"] == 0]
    return {"stream": bytes(stream), "vertices": len(mesh.points), "indices": mesh.faces.size,
            "ids": {"POSITION": position, **{name: i for i, name in enumerate(names)}}}


def read(data):
    """The document and the binary chunk of a .glb."""
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + size]), data[28 + size:]


def write(document, binary, more=()):
    """A .glb; `more` are its buffers after the first."""
    binary = bytes(binary) + bytes(-len(binary) % 4)
    document["buffers"] = [{"byteLength": len(binary)}, *more]
    text = json.dumps(document, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def require(document, name):
    for key in ("extensionsUsed", "extensionsRequired"):
        document.setdefault(key, []).append(name)


class Views:
    """The views of a file in a new binary chunk."""

    def __init__(self, document, binary):
        self.document, self.old, self.binary = document, binary, bytearray()

    def bytes(self, index):
        view = self.document["bufferViews"][index]
        start = view.get("byteOffset", 0)
        return self.old[start:start + view["byteLength"]]

    def place(self, data):
        self.binary += bytes(-len(self.binary) % 4)
        self.binary += data
        return {"buffer": 0, "byteOffset": len(self.binary) - len(data), "byteLength": len(data)}


def streams_of_views(document):
    """For each view that accessors read from its start on: the request for its stream."""
    requests = {}
    triangles = {document["accessors"][p["indices"]].get("bufferView") for mesh in document["meshes"]
                 for p in mesh["primitives"] if "indices" in p and p.get("mode", TRIANGLES) == TRIANGLES}
    indices = {document["accessors"][p["indices"]].get("bufferView") for mesh in document["meshes"]
               for p in mesh["primitives"] if "indices" in p}
    for accessor in document["accessors"]:
        index = accessor.get("bufferView")
        if index is None:
            continue
        view, size = document["bufferViews"][index], SIZES[accessor["componentType"]]
        if index in indices:
            if size > 1:
                mode = "TRIANGLES" if index in triangles and accessor["count"] % 3 == 0 else "INDICES"
                requests[index] = {"mode": mode, "count": accessor["count"], "stride": size}
            continue
        stride = view.get("byteStride", size * WIDTHS[accessor["type"]])
        if stride % 4 == 0 and view["byteLength"] == stride * accessor["count"]:
            requests[index] = {"mode": "ATTRIBUTES", "count": accessor["count"], "stride": stride}
    return requests


def with_meshopt(document, binary, encoder):
    name, views, fallback = "EXT_meshopt_compression", Views(document, binary), 0
    requests = streams_of_views(document)
    for index, view in enumerate(document["bufferViews"]):
        data = views.bytes(index)
        answer = encoder.ask(requests[index], data) if index in requests else None
        if not answer:
            view.update(views.place(data))
            continue
        request = requests[index]
        view["extensions"] = {name: {**views.place(answer["stream"]), "byteStride": request["stride"],
                                     "count": request["count"], "mode": request["mode"]}}
        view.update(buffer=1, byteOffset=fallback)
        fallback += len(data) + -len(data) % 4
    require(document, name)
    return write(document, views.binary, [{"byteLength": fallback, "extensions": {name: {"fallback": True}}}])


def elements(document, views, index):
    """The packed elements of an accessor."""
    accessor = document["accessors"][index]
    size = SIZES[accessor["componentType"]] * WIDTHS[accessor["type"]]
    data, start = views.bytes(accessor["bufferView"]), accessor.get("byteOffset", 0)
    stride = document["bufferViews"][accessor["bufferView"]].get("byteStride", size)
    return b"".join(data[start + i * stride:start + i * stride + size] for i in range(accessor["count"]))


def draco_request(document, views, primitive, level):
    """What DracoPy is asked for a primitive; none if it cannot hold it."""
    accessors = document["accessors"]
    named = {name: accessors[i] for name, i in primitive["attributes"].items()}
    # Positions are floats, DracoPy's generic attributes unsigned or floats.
    fits = named["POSITION"]["componentType"] == 5126 and all(
        a["componentType"] in (5121, 5123, 5125, 5126) and "bufferView" in a and "sparse" not in a
        for a in named.values())
    if "indices" not in primitive or primitive.get("mode", TRIANGLES) != TRIANGLES or not fits:
        return None
    order = ["POSITION", *(name for name in named if name != "POSITION")]
    data = b"".join(elements(document, views, primitive["attributes"][name]) for name in order)
    corners = accessors[primitive["indices"]]
    numbers = struct.unpack(f"<{corners['count']}{LETTERS[corners['componentType']]}",
                            elements(document, views, primitive["indices"]))
    request = {"level": level, "vertices": named["POSITION"]["count"],
               "attributes": [[n, named[n]["componentType"], WIDTHS[named[n]["type"]]] for n in order]}
    return request, data + struct.pack(f"<{len(numbers)}I", *numbers)


def with_draco(document, binary, encoder, level):
    name, views, done = "KHR_draco_mesh_compression", Views(document, binary), False
    for index, view in enumerate(document["bufferViews"]):
        view.update(views.place(views.bytes(index)))
    views.old = bytes(views.binary)
    for primitive in [p for mesh in document["meshes"] for p in mesh["primitives"]]:
        request = draco_request(document, views, primitive, level)
        if not request or (level > 0 and "targets" in primitive):
            continue
        answer, done = encoder.ask(*request), True
        document["bufferViews"].append(views.place(answer["stream"]))
        for key, holder in [*((n, primitive["attributes"]) for n in list(answer["ids"])), ("indices", primitive)]:
            accessor = dict(document["accessors"][holder[key]])
            accessor["count"] = answer["indices"] if key == "indices" else answer["vertices"]
            for gone in ("bufferView", "byteOffset"):
                accessor.pop(gone, None)
            document["accessors"].append(accessor)
            holder[key] = len(document["accessors"]) - 1
        primitive["extensions"] = {**primitive.get("extensions", {}), name: {
            "bufferView": len(document["bufferViews"]) - 1, "attributes": answer["ids"]}}
    if done:
        require(document, name)
    return write(document, views.binary) if done else None


def compressed(data, way, encoder=None):
    """A .glb of a .glb; none if nothing of it can be compressed so."""
    document, binary = read(data)
    encoder = encoder or Stored()
    if way == "meshopt":
        return with_meshopt(document, binary, encoder)
    return with_draco(document, binary, encoder, 7 if way == "draco" else 0)


def main():
    import stage
    import make_models  # noqa: F401  # Registers the models.
    encoder = Encoder()
    with tempfile.TemporaryDirectory() as folder:
        for name in MODELS:
            claims = stage.make(name, Path(folder))
            data = (Path(folder) / claims[0]["file"]).read_bytes()
            for way in WAYS:
                compressed(data, way, encoder)
    lines = [f'"{key}": {json.dumps(answer, separators=(",", ":"))}' for key, answer in sorted(encoder.answers.items())]
    STREAMS.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="ascii")
    print(f"{len(lines)} streams, {STREAMS.stat().st_size} bytes")


if __name__ == "__main__":
    main()
