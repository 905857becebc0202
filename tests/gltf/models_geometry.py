"""Models about how vertices reach their places: containers, accessors, primitives."""

import struct

import matrices
import shapes
from gltf_file import COMPONENTS, FAN, LINES, POINTS, STRIP, TRIANGLES, VERTICES
from stage import chart, model


def small_box(stage, rect):
    """A box seen at an angle, with a colour for each side, in a rectangle."""
    x, y = stage.centre(rect)
    r = (rect[2] - rect[0]) / 64 / 2 * 0.55
    turned = matrices.rotation(matrices.turn((1, 0, 0), 35)), matrices.rotation(matrices.turn((0, 1, 0), 40))
    matrix = matrices.product(matrices.translation(x, y), *turned, matrices.scaling(r, r, r))
    mesh = shapes.box((-1, -1, -1), (1, 1, 1))
    sides = [(0.8, 0.1, 0.1), (0.1, 0.7, 0.7), (0.1, 0.7, 0.1), (0.7, 0.1, 0.7), (0.1, 0.2, 0.9), (0.8, 0.7, 0.1)]
    mesh.colours = [side for side in sides for _ in range(4)]
    return mesh.moved(matrix)


@model("BoxInterleaved")
def box_interleaved(stage):
    """Attributes of vertices may stand in one view by turns, with a stride, from different offsets; those of the box on
    the left do, with gaps between them, and those of the right one do not."""
    [(left, right)] = list(stage.pairs([("stride 44",)]))
    mesh, white = small_box(stage, left), stage.unlit()
    data = b"".join(struct.pack("<3f4x3f2f3B5x", *p, *n, *uv, *(round(255 * c) for c in colour))
                    for p, n, uv, colour in zip(mesh.positions, mesh.normals, mesh.uvs, mesh.colours))
    view = stage.file.view(data, VERTICES, 44)
    stored = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in mesh.positions]
    bounds = {"min": [min(c) for c in zip(*stored)], "max": [max(c) for c in zip(*stored)]}
    names = {}
    for name, offset, component, kind, more in (
            ("POSITION", 0, "f32", "VEC3", bounds), ("NORMAL", 16, "f32", "VEC3", {}),
            ("TEXCOORD_0", 28, "f32", "VEC2", {}), ("COLOR_0", 36, "u8", "VEC3", {"normalized": True})):
        names[name] = stage.file.add("accessors", {
            "bufferView": view, "byteOffset": offset, "componentType": COMPONENTS[component][0], "type": kind,
            "count": len(mesh.positions), **more})
    primitive = stage.file.primitive(names, mesh.indices, white)
    stage.file.node(mesh=stage.file.mesh(primitive))
    mesh = small_box(stage, right)
    mesh.colours = [tuple(round(255 * c) / 255 for c in colour) for colour in mesh.colours]
    stage.put(mesh, white)
    stage.tolerate(4, 64)


@model("Box With Spaces", ("glTF", "glTF-Binary"))
def box_with_spaces(stage):
    """Names of files may have spaces, which stand as %20 in their addresses: a box with an image, as the one beside it
    that has its colours from its vertices."""
    texture = stage.file.texture(chart())
    (left, right), (a, b) = stage.pairs([("box",), ("image",)])
    for rect in (left, right):
        stage.put(small_box(stage, rect), stage.unlit())
    for rect in (a, b):
        stage.tile(rect, stage.unlit(texture=texture))
    stage.tolerate(4, 64)


@model("XmpMetadata")
def xmp_metadata(stage):
    """Metadata of KHR_xmp_json_ld, of the asset, a scene, a node, a mesh and a material, changes nothing: a reader that
    does not know it shows the same two boxes."""
    [(left, right)] = list(stage.pairs([("metadata",)]))
    stage.put(small_box(stage, right), stage.unlit())
    stage.put(small_box(stage, left), stage.unlit())
    document = stage.file.json
    packet = {"@context": {"dc": "http://purl.org/dc/elements/1.1/"}, "@id": "", "dc:title": {
        "@type": "rdf:Alt", "rdf:_1": {"@language": "en", "@value": "A box"}}, "dc:format": "model/gltf-binary"}
    document.setdefault("extensions", {})["KHR_xmp_json_ld"] = {"packets": [packet]}
    stage.file.used.add("KHR_xmp_json_ld")
    for item in (document["asset"], document["scenes"][0], document["nodes"][-1], document["meshes"][-1],
                 document["materials"][-1]):
        item.setdefault("extensions", {})["KHR_xmp_json_ld"] = {"packet": 0}
    stage.tolerate(4, 64)


@model("SimpleSparseAccessor")
def simple_sparse_accessor(stage):
    """Accessors may replace some of their elements: those of a view, or zeros where there is no view; the places as
    bytes, shorts or ints. Each left sheet gets its tips so; the right one has them in its vertices. The last
    one is a sheet whose colours are sparse."""
    file = stage.file
    for left, right, index, with_view in stage.pairs([
            ("bytes", "u8", True), ("shorts", "u16", True), ("ints", "u32", True), ("no view", "u16", False),
            ("colours", "u8", None)]):
        mesh = stage.sheet(left, n=4)
        places = [6, 8, 12, 16, 18]
        mesh.colours = [(0.1, 0.3, 0.8) if with_view is not None else (0.0, 0.0, 0.0)] * len(mesh.positions)
        if with_view is None:
            values = [(0.9, 0.5, 0.1)] * len(places)
            base = list(mesh.colours)
        else:
            values = [(x + 0.06, y + 0.06, z + 0.05) for x, y, z in (mesh.positions[i] for i in places)]
            base = list(mesh.positions)
            if not with_view:
                base = [(0.0, 0.0, 0.0)] * len(base)
                places, values = list(range(len(base))), [(x + 0.02 * y, y, z) for x, y, z in mesh.positions]
        result = list(base)
        for i, value in zip(places, values):
            result[i] = value
        number = file.accessor(result, target=VERTICES, bounds=True)  # Its bounds are those of the result.
        item = file.json["accessors"][number]
        file.json["bufferViews"].pop()
        del file.binary[-(len(base) * 12):]
        if with_view is False or with_view is None:
            del item["bufferView"]
        else:
            item["bufferView"] = file.view(b"".join(struct.pack("<3f", *row) for row in base), VERTICES)
        item["sparse"] = {
            "count": len(places),
            "indices": {"bufferView": file.view(struct.pack(f"<{len(places)}{COMPONENTS[index][1]}", *places)),
                        "componentType": COMPONENTS[index][0]},
            "values": {"bufferView": file.view(b"".join(struct.pack("<3f", *row) for row in values))}}
        attributes = mesh.attributes()
        attributes["POSITION" if with_view is not None else "COLOR_0"] = number
        checks = [(0.1, 0.3, 0.8) if (i % 2) else (0.9, 0.8, 0.5) for i in range(len(mesh.positions))]
        if with_view is not None:
            attributes["COLOR_0"] = checks
        file.node(mesh=file.mesh(file.primitive(attributes, mesh.indices, stage.unlit())))
        # The same about the right tile.
        shift = (right[0] - left[0]) / 64
        mesh = stage.sheet(left, n=4)
        mesh.colours = result if with_view is None else checks
        if with_view is not None:
            mesh.positions = result
        mesh.positions = [(x + shift, y, z) for x, y, z in mesh.positions]
        stage.put(mesh, stage.unlit())
    stage.tolerate(4, 64)


@model("MeshPrimitiveModes")
def mesh_primitive_modes(stage):
    """Triangles, strips and fans, with indices and without, all face the viewer and fill the same square, in colours
    that come from their vertices; so do indices of all three sizes. Points and lines, in the lower right corner,
    are not surfaces: a renderer of surfaces leaves them out and says so."""
    file = stage.file
    corners = [(0, 0), (0, 1), (1, 0), (1, 1)]  # s and t: down, then to the right.
    colour = {(0, 0): (0.8, 0.1, 0.1), (0, 1): (0.1, 0.7, 0.1), (1, 0): (0.1, 0.2, 0.9), (1, 1): (0.8, 0.7, 0.1)}

    def put(rect, order, mode, indices=None, component="u16", points=corners):
        x0, y0, x1, y1 = stage.corners(rect)
        order = order or range(len(points))
        positions = [(x0 + (x1 - x0) * points[i][0], y1 + (y0 - y1) * points[i][1], 0.0) for i in order]
        attributes = {"POSITION": positions, "COLOR_0": [colour[points[i]] for i in order]}
        primitive = file.primitive(attributes, indices, white, mode, component=component)
        file.node(mesh=file.mesh(primitive))

    white = stage.unlit()
    two = [0, 1, 2, 2, 1, 3]
    for left, right, order, mode, indices, component in stage.pairs([
            ("triangles", None, TRIANGLES, two, "u16"), ("no indices", two, TRIANGLES, None, None),
            ("strip", None, STRIP, [0, 1, 2, 3], "u16"), ("strip no index", None, STRIP, None, None),
            ("fan", None, FAN, [1, 3, 2, 0], "u16"), ("fan no index", [1, 3, 2, 0], FAN, None, None),
            ("no mode", None, None, two, "u16"), ("bytes", None, TRIANGLES, two, "u8"),
            ("ints", None, TRIANGLES, two, "u32")]):
        put(left, order, mode, indices, component)
        # Each pair's right side has the same diagonal in plain triangles.
        put(right, None, TRIANGLES, [1, 3, 2, 1, 2, 0] if mode == FAN else two)
    put([250, 200, 300, 236], None, POINTS, None)
    put([250, 200, 300, 236], None, LINES, [0, 3, 1, 2])
    stage.expect([240, 190, 310, 238], (44, 46, 52), 4)


@model("MeshQuantization")
def mesh_quantization(stage):
    """Positions, normals, tangents and coordinates may be bytes and shorts, normalized or not; nodes and texture
    transforms undo their scales. The tiles on the left are so, those on the right are floats."""
    file = stage.file
    file.required.add("KHR_mesh_quantization")
    texture = file.texture(chart())
    for left, right, component, largest, normalized in stage.pairs([
            ("byte", "i8", 127, False), ("byte norm", "i8", 127, True), ("short", "i16", 32767, False),
            ("short norm", "i16", 32767, True), ("ubyte", "u8", 255, False), ("ushort norm", "u16", 65535, True)]):
        signed = component[0] == "i"
        low = -largest if signed else 0
        x0, y0, x1, y1 = stage.corners(left)
        integers = [(low, largest, 0), (low, low, 0), (largest, low, 0), (largest, largest, 0)]
        unit = 1 if normalized else largest
        scale = [(x1 - x0) / (2 if signed else 1) / unit, (y1 - y0) / (2 if signed else 1) / unit, 1]
        middle = [(x0 + x1) / 2, (y0 + y1) / 2, 0] if signed else [x0, y0, 0]
        uvs = [(0, 0), (0, 255), (255, 255), (255, 0)]
        info, uv_kind = {"index": texture}, (uvs, "u8", True)
        if not normalized:
            info = {"index": texture, "extensions": {"KHR_texture_transform": {"scale": [1 / 255, 1 / 255]}}}
            file.required.add("KHR_texture_transform")
            uv_kind = (uvs, "u8", False)
        primitive = file.primitive({"POSITION": (integers, component, normalized),
                                    "NORMAL": ([(0, 0, 127)] * 4, "i8", True),
                                    "TANGENT": ([(127, 0, 0, 127)] * 4, "i8", True),
                                    "TEXCOORD_0": uv_kind}, [0, 1, 2, 0, 2, 3], stage.surface(
                                        (1, 1, 1), base={"baseColorTexture": info}))
        file.node(mesh=file.mesh(primitive), translation=middle, scale=scale)
        stage.tile(right, stage.surface((1, 1, 1), base={"baseColorTexture": {"index": texture}}))
    stage.sun()
