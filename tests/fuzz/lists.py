#!/usr/bin/env python3
"""Gives candela files in which one list has a hundred thousand entries, and prints the CPU seconds that each takes.

usage: lists.py CANDELA [--entries 100000] [NAME...]

No list should take more than two seconds. Exits 1 if one takes twenty: then the time grows with the square of the entries,
or faster. (Between the two, it depends on the machine.)
"""
import argparse
import base64
import json
import os
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile
import zlib

HANG = 20

CAMERA = '"cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40}}'
CORNERS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
PERSPECTIVE = {"type": "perspective", "perspective": {"yfov": 1}}


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


# One white pixel.
PNG = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0)) +
       chunk(b"IDAT", zlib.compress(b"\0\xff")) + chunk(b"IEND", b""))


def data(content):
    return "data:;base64," + base64.b64encode(content).decode()


def gltf(**members):
    """A glTF file of a triangle, with these members besides or instead."""
    document = {"asset": {"version": "2.0"},
                "buffers": [{"uri": data(CORNERS), "byteLength": 36}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "nodes": [{"mesh": 0}]}
    document.update(members)
    return "a.gltf", json.dumps(document)


def native(shapes='[{"type": "sphere", "radius": 1, "material": "m0"}]', materials=None, more=""):
    materials = materials or '{"m0": {"type": "diffuse", "reflectance": 0.5}}'
    return "a.json", f'{{{CAMERA}, "materials": {materials}, "shapes": {shapes}{more}}}'


def joined(text, n):
    """text.format(i) for i < n, with commas."""
    return ",".join(text.replace("%", str(i)) for i in range(n))


def primitive(**members):
    return {"attributes": {"POSITION": 0}, **members}


def skin(n):
    return gltf(nodes=[{"mesh": 0, "skin": 0}] + [{"name": "j"} for _ in range(n)],
                skins=[{"joints": list(range(1, n + 1))}],
                accessors=[{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                           {"componentType": 5121, "count": 3, "type": "VEC4"},
                           {"componentType": 5126, "count": 3, "type": "VEC4"}],
                meshes=[{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}])


def textured(n, **material):
    return gltf(images=[{"uri": data(PNG)}], textures=[{"source": 0, "sampler": i} for i in range(n)],
                samplers=[{"wrapS": 33071} for _ in range(n)],
                materials=[{"emissiveFactor": [1, 1, 1], "emissiveTexture": {
                    "index": i, "extensions": {"KHR_texture_transform": {"offset": [i / n, 0]}}}, **material}
                    for i in range(n)],
                meshes=[{"primitives": [primitive(material=i) for i in range(n)]}])


def animated(n):
    return gltf(nodes=[{"mesh": 0} for _ in range(n)],
                accessors=[{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                           {"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR"},
                           {"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"}],
                animations=[{"channels": [{"sampler": i, "target": {"node": i, "path": "translation"}}
                                          for i in range(n)],
                             "samplers": [{"input": 1, "output": 2} for _ in range(n)]}])


def variants(n):
    return gltf(materials=[{} for _ in range(n)],
                extensions={"KHR_materials_variants": {"variants": [{"name": f"v{i}"} for i in range(n)]}},
                meshes=[{"primitives": [primitive(extensions={"KHR_materials_variants": {
                    "mappings": [{"material": i, "variants": [i]} for i in range(n)]}})]}])


def chain(n):
    return gltf(nodes=[{"mesh": 0}] + [{"children": [i]} for i in range(n)], scenes=[{"nodes": [n]}])


def ply(elements="", properties="", row="0 0 0"):
    return "a.ply", ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
                     properties + "element face 1\nproperty list uchar int vertex_indices\n" + elements + "end_header\n" +
                     "".join(f"{p}{row[5:]}\n" for p in ("0 0 0", "1 0 0", "0 1 0")) + "3 0 1 2\n")


def exr(n, of):
    """An OpenEXR file of two pixels whose header has that many attributes or channels."""
    def attribute(name, kind, content):
        return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(content)) + content
    channels = n if of == "channels" else 1
    names = [b"Y"] + [b"c%06d" % i for i in range(channels - 1)]
    content = b"".join(name + struct.pack("<iiii", 2, 0, 1, 1) for name in
                       (name + b"\0" for name in sorted(names))) + b"\0"
    box = struct.pack("<4i", 0, 0, 1, 0)
    header = (attribute("channels", "chlist", content) + attribute("compression", "compression", b"\0") +
              attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box) +
              attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) +
              attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)) +
              attribute("screenWindowWidth", "float", struct.pack("<f", 1)))
    if of == "attributes":
        header += b"".join(attribute(f"a{i}", "int", b"\0\0\0\0") for i in range(n))
    start = b"v/1\x01\x02\0\0\0" + header + b"\0"
    pixels = bytes(8 * channels)
    return start + struct.pack("<Qii", len(start) + 8, 0, len(pixels)) + pixels


# Each makes a file, (name, content), for n entries; further files of the folder may follow, and options.
LISTS = {
    "gltf cameras of one name": lambda n: gltf(
        cameras=[PERSPECTIVE], nodes=[{"mesh": 0}] + [{"camera": 0, "name": "a"} for _ in range(n)]),
    "gltf cameras": lambda n: gltf(cameras=[{**PERSPECTIVE, "name": f"c{i}"} for i in range(n)],
                                   nodes=[{"mesh": 0}] + [{"camera": i} for i in range(n)]),
    "gltf materials of one name": lambda n: gltf(
        materials=[{"name": "a"} for _ in range(n)], meshes=[{"primitives": [primitive(material=i) for i in range(n)]}]),
    "gltf materials of a native scene's names": lambda n: (
        *native("[]", "{" + joined('"m%": {"type": "diffuse", "reflectance": 0.5}', n) + "}", ', "scene": "b.gltf"'),
        {"b.gltf": gltf(materials=[{"name": f"m{i}"} for i in range(n)],
                        meshes=[{"primitives": [primitive(material=i) for i in range(n)]}])[1]}),
    "gltf textures": textured,
    "gltf images": lambda n: gltf(images=[{"uri": data(PNG + b"%d" % i)} for i in range(n)], textures=[{"source": i} for i in range(n)],
                                  materials=[{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": i}}
                                             for i in range(n)],
                                  meshes=[{"primitives": [primitive(material=i) for i in range(n)]}]),
    "gltf nodes, wide": lambda n: gltf(nodes=[{"mesh": 0, "translation": [i, 0, 0]} for i in range(n)]),
    "gltf nodes, deep": chain,
    "gltf children": lambda n: gltf(nodes=[{"children": list(range(1, n + 1))}] + [{"mesh": 0} for _ in range(n)]),
    "gltf meshes": lambda n: gltf(meshes=[{"primitives": [primitive()]} for _ in range(n)],
                                  nodes=[{"mesh": i} for i in range(n)]),
    "gltf accessors and views": lambda n: gltf(
        bufferViews=[{"buffer": 0, "byteLength": 36} for _ in range(n)],
        accessors=[{"bufferView": i, "componentType": 5126, "count": 3, "type": "VEC3"} for i in range(n)],
        meshes=[{"primitives": [{"attributes": {"POSITION": i}} for i in range(n)]}]),
    "gltf buffers": lambda n: gltf(
        buffers=[{"uri": data(CORNERS), "byteLength": 36} for _ in range(n)],
        bufferViews=[{"buffer": i, "byteLength": 36} for i in range(n)],
        accessors=[{"bufferView": i, "componentType": 5126, "count": 3, "type": "VEC3"} for i in range(n)],
        meshes=[{"primitives": [{"attributes": {"POSITION": i}} for i in range(n)]}]),
    "gltf animations": lambda n: (*gltf(animations=[{"channels": [], "samplers": []} for _ in range(n)]), {},
                                  ["--time", "0", "--animation", "all"]),
    "gltf channels and samplers": lambda n: (*animated(n), {}, ["--time", "0"]),
    "gltf joints": skin,
    "gltf skins": lambda n: gltf(nodes=[{"mesh": 0, "skin": i} for i in range(n)],
                                 skins=[{"joints": [0]} for _ in range(n)]),
    "gltf morph targets": lambda n: gltf(meshes=[{"primitives": [primitive(targets=[{"POSITION": 0}] * n)],
                                                  "weights": [1e-6] * n}]),
    "gltf variants": lambda n: (*variants(n), {}, ["--variant", f"v{n - 1}"]),
    "gltf lights": lambda n: gltf(extensions={"KHR_lights_punctual": {"lights": [{"type": "point"} for _ in range(n)]}},
                                  nodes=[{"mesh": 0}] + [{"extensions": {"KHR_lights_punctual": {"light": i}}}
                                                         for i in range(n)]),
    "gltf extensions": lambda n: gltf(extensionsUsed=[f"E_{i}" for i in range(n)]),
    "gltf keys": lambda n: ("a.gltf", '{"x": {' + joined('"%": 0', n) + "}, " + joined('"k%": 0', n) + "," + gltf(
        nodes=[{"mesh": 0} for _ in range(n)])[1][1:]),
    "gltf attributes": lambda n: gltf(meshes=[{"primitives": [{"attributes": {
        **{f"_A{i}": 0 for i in range(n)}, "POSITION": 0}}]}]),
    "gltf scenes": lambda n: (*gltf(scenes=[{"nodes": [0]} for _ in range(n)]), {}, ["--scene", str(n - 1)]),
    "native shapes": lambda n: native("[" + joined('{"type": "sphere", "center": [%, 0, 0], "material": "m0"}', n) + "]"),
    "native solids in one place": lambda n: native(
        "[" + joined('{"type": "sphere", "radius": 1, "material": "m0"}', n) + "]",
        '{"m0": {"type": "dielectric", "ior": 1.5}}'),
    "native materials": lambda n: native(materials="{" + joined('"m%": {"type": "diffuse", "reflectance": 0.5}', n) + "}"),
    "native textures": lambda n: (*native("[" + joined(
        '{"type": "quad", "vertices": [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], "emission": {"image": "a.png", '
        '"uv_offset": [%, 0]}}', n) + "]"), {"a.png": PNG}),
    "native cameras": lambda n: ("a.json", '{"cameras": {' + joined(
        '"c%": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40}', n) +
        '}, "shapes": [{"type": "sphere", "radius": 1, "emission": 1}]}'),
    "native lights": lambda n: native(more=', "lights": [' + joined(
        '{"type": "point", "position": [0, 0, %], "intensity": 1}', n) + "]"),
    "native objects": lambda n: native(
        '[{"type": "instance", "object": "o0"}]', more=', "objects": {' + joined(
            '"o%": [{"type": "sphere", "radius": 1, "material": "m0"}]', n) + "}"),
    "native instances": lambda n: native("[" + joined('{"type": "instance", "object": "o"}', n) + "]", more=(
        ', "objects": {"o": [{"type": "sphere", "radius": 1, "material": "m0"}]}')),
    "native positions": lambda n: native(
        '[{"type": "mesh", "material": "m0", "positions": [' + joined("[%, 0, 0]", n) + ', [0, 1, 0]], "triangles": [' +
        joined(f"[0, 1, {n}]", n) + "]}]"),
    "native keys": lambda n: ("a.json", "{" + joined('"k%": 0', n) + "}"),
    "native warnings": lambda n: native(more=', "lights": [' + joined(
        '{"type": "point", "position": [0, 0, %], "intensity": 0}', n) + "]"),
    "obj groups": lambda n: ("a.obj", TRIANGLE + "".join(f"g g{i}\no o{i}\ns {i}\nf 1 2 3\n" for i in range(n))),
    "obj usemtl": lambda n: ("a.obj", "mtllib a.mtl\n" + TRIANGLE + "".join(f"usemtl m{i}\nf 1 2 3\n" for i in range(n)),
                             {"a.mtl": "".join(f"newmtl m{i}\nKd 1 1 1\n" for i in range(n))}),
    "obj mtllib": lambda n: ("a.obj", "mtllib a.mtl\n" * n + TRIANGLE + "usemtl a\nf 1 2 3\n",
                             {"a.mtl": "newmtl a\nKd 1 1 1\n"}),
    "obj corners at one position": lambda n: ("a.obj", TRIANGLE + "".join(f"vt {i} 0\n" for i in range(n)) + "".join(
        f"f 1/{i + 1} 2/1 3/1\n" for i in range(n))),
    "obj corners of a face": lambda n: ("a.obj", "".join(f"v {i} 0 {i * i}\n" for i in range(1000)) +
                                        "f " + " ".join(str(i % 1000 + 1) for i in range(n)) + "\n"),
    "mtl newmtl of one name": lambda n: ("a.obj", "mtllib a.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\n",
                                         {"a.mtl": "newmtl a\nKd 1 1 1\n" * n}),
    "mtl statements": lambda n: ("a.obj", "mtllib a.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\n",
                                 {"a.mtl": "newmtl a\n" + "".join(f"unknown{i} 1\n" for i in range(n))}),
    "ply elements": lambda n: ply(elements="".join(f"element e{i} 0\nproperty int x\n" for i in range(n))),
    "ply properties": lambda n: ply(properties="".join(f"property int p{i}\n" for i in range(n)), row="0 0 0" + " 0" * n),
    "ply comments": lambda n: ply(elements="comment a\n" * n),
    "exr attributes": lambda n: (*native(more=', "environment": {"file": "a.exr"}'), {"a.exr": exr(n, "attributes")}),
    "exr channels": lambda n: (*native(more=', "environment": {"file": "a.exr"}'), {"a.exr": exr(n, "channels")}),
}


def run(candela, made, folder):
    """The CPU seconds that candela takes, or None if it hangs; and its exit code."""
    name, content, others, options = (*made, *[{}, []][len(made) - 2:])
    for path, text in {name: content, **others}.items():
        (folder / path).write_bytes(text.encode() if isinstance(text, str) else text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.run([candela, "info", "--json", *options, folder / name], stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL, preexec_fn=lambda: resource.setrlimit(
                                 resource.RLIMIT_CPU, (HANG, HANG)))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return (None if process.returncode < 0 else seconds), process.returncode


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("candela", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--entries", type=int, default=100_000)
    options = parser.parse_args()
    slow = []
    for name, make in LISTS.items():
        if options.names and name not in options.names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            seconds, code = run(options.candela.resolve(), make(options.entries), pathlib.Path(folder))
        print(f"{name:42} {'hangs' if seconds is None else f'{seconds:5.1f} s'}   exit code {code}", flush=True)
        if seconds is None:
            slow.append(name)
    sys.exit(", ".join(slow) + ": slow" if slow else 0)


if __name__ == "__main__":
    main()
