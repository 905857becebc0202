# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as arrays."""
import numpy

from .surface import Points, TooManyTriangles

KINDS = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


class Part:
    """The triangles of a mesh with one material: what Scene.add_mesh() takes. `points`: those of textures in space, whose
    second texture coordinates they are; None without such, False if there are too many triangles for them."""

    def __init__(self, slot, points=None, **arrays):
        self.slot = slot
        self.points = points
        self.arrays = arrays


def _read(collection, attribute, columns, kind):
    array = numpy.empty(len(collection) * columns, kind)
    collection.foreach_get(attribute, array)
    return array.reshape(-1, columns) if columns > 1 else array


def _uvs(mesh, name):
    layer = mesh.uv_layers.get(name)
    return None if layer is None else _read(layer.uv, "vector", 2, numpy.float32)


def _colors(mesh):
    """(corners, 4): linear colours of the attribute that is rendered; None without one."""
    index = mesh.color_attributes.render_color_index
    if not 0 <= index < len(mesh.color_attributes):
        return None
    attribute = mesh.color_attributes[index]
    colors = numpy.clip(_read(attribute.data, "color", 4, numpy.float32), 0.0, 1.0)
    return colors if attribute.domain == "CORNER" else colors[_read(mesh.loops, "vertex_index", 1, numpy.int32)]


def uv_of_render(mesh):
    """The name of the texture coordinates that are used where no other are named; None without any."""
    for layer in mesh.uv_layers:
        if layer.active_render:
            return layer.name
    return mesh.uv_layers[0].name if mesh.uv_layers else None


def _points(mesh, loops, positions, arrays, texels):
    """Those of triangles, by the loops of their corners; False of too many."""
    def uvs(name):
        layer = _uvs(mesh, name)
        return None if layer is None else layer[loops]

    colors = arrays["colors"]
    try:
        return Points(texels, positions[loops], arrays["normals"][loops], None if colors is None else colors[loops], uvs,
                      uv_of_render(mesh), numpy.array(mesh.texspace_location), numpy.array(mesh.texspace_size))
    except TooManyTriangles:
        return False


def parts_of(mesh, second_uv=None, in_space=lambda slot: False, texels=1024):
    """A part for each material slot that the mesh uses. second_uv: the name of further texture coordinates; in_space: whether
    the material of a slot has textures in space, whose images have at least so many texels along an edge."""
    mesh.calc_loop_triangles()
    if not mesh.loop_triangles:
        return []
    corners = _read(mesh.loop_triangles, "loops", 3, numpy.int32)
    slots = _read(mesh.loop_triangles, "material_index", 1, numpy.int32)
    vertices = _read(mesh.vertices, "co", 3, numpy.float32)[_read(mesh.loops, "vertex_index", 1, numpy.int32)]
    arrays = {"normals": _read(mesh.corner_normals, "vector", 3, numpy.float32), "colors": _colors(mesh)}
    first = uv_of_render(mesh)
    points = {slot: _points(mesh, corners[slots == slot], vertices, arrays, texels)
              for slot in numpy.unique(slots) if in_space(slot)}
    if first is not None:
        arrays["uvs"] = _uvs(mesh, first)
        if second_uv is not None and second_uv != first:
            arrays["uvs1"] = _uvs(mesh, second_uv)
    arrays = {key: array for key, array in arrays.items() if array is not None}
    parts = []
    for slot in numpy.unique(slots):
        faces = corners[slots == slot]
        at = points.get(slot)
        if at:  # No two triangles share a corner.
            used, faces = faces.reshape(-1), numpy.arange(faces.size)
        else:
            used, faces = numpy.unique(faces, return_inverse=True)  # The corners of this part alone.
        own = {key: array[used] for key, array in arrays.items()}
        if at:
            own["uvs1"] = at.uvs.reshape(-1, 2)
            own.setdefault("uvs", own["uvs1"])
        parts.append(Part(int(slot), at, vertices=vertices[used], faces=faces.reshape(-1, 3).astype(numpy.int32), **own))
    return parts
